"""The two sonars of the chest: the nearest echo within a cone, at their own rate."""

from __future__ import annotations

import math
from typing import Callable, Sequence

from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import Vector3, from_roll_pitch_yaw, rotate

PERIOD = 0.1
HALF_CONE = math.radians(30.0)
# What the robot reports when nothing echoes, in m.
NO_ECHO = 5.0
NEAREST = 0.01
RINGS = ((0.0, 1), (0.5, 6), (1.0, 8))

NearestHits = Callable[[Vector3, Sequence[Vector3]], Sequence[float]]


class Sonars:
    """Left and right sonar.

    Args:
        model: The robot.
    """

    def __init__(self, model: RobotModel) -> None:
        self._places = [(tuple(s.position), from_roll_pitch_yaw(*s.rpy)) for s in model.sonars]
        self._rays = [
            _direction(ring * HALF_CONE, 2 * math.pi * k / count) for ring, count in RINGS for k in range(count)
        ]
        self._next = 0.0
        self._last: tuple[float, ...] = (NO_ECHO,) * len(self._places)

    def reset(self) -> None:
        """Measure at the next reading: the robot was put somewhere else."""
        self._next = 0.0

    def read(self, now: float, torso: Pose, nearest_hits: NearestHits) -> tuple[float, ...]:
        """Distances in m, measured anew every 0.1 s of simulated time."""
        if now < self._next - 1e-9:  # float rounding must not cost a tick
            return self._last
        self._next = now + PERIOD
        self._last = tuple(self._measure(place, torso, nearest_hits) for place in self._places)
        return self._last

    def _measure(self, place: tuple, torso: Pose, nearest_hits: NearestHits) -> float:
        position, turn = place
        start = _add(torso.position, rotate(torso.orientation, position))
        ends = [
            _add(start, rotate(torso.orientation, rotate(turn, [NO_ECHO * d for d in direction])))
            for direction in self._rays
        ]
        return max(min(nearest_hits(start, ends)) * NO_ECHO, NEAREST)


def _direction(angle: float, around: float) -> Vector3:
    """Unit vector `angle` rad off the X axis, turned `around` it."""
    side = math.sin(angle)
    return (math.cos(angle), side * math.cos(around), side * math.sin(around))


def _add(a: Sequence[float], b: Sequence[float]) -> Vector3:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
