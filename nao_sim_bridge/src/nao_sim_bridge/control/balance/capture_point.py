"""How the body moves over its feet, tick by tick: centre of mass, its velocity, and the capture point.

The capture point is where a foot would have to press for the body to come to rest over it: the centre of mass plus its
velocity over the frequency of a pendulum as high as it. What keeps a robot on its feet looks at it: standing now,
walking with the foot that carries as the only one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence, Tuple

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.stance import Stance, stance_reader
from nao_sim_bridge.model.robot_model import RobotModel

Vector2 = Tuple[float, float]
# A lower centre of mass than this, m, is no pendulum over feet any more.
LEAST_HEIGHT = 0.05


@dataclass(frozen=True)
class BodyMotion:
    """The body over its feet and how it moves there, in the level frame.

    Attributes:
        stance: Centre of mass and ankles.
        velocity: Of the centre of mass against the feet, horizontal, m/s.
        frequency: Of the pendulum, rad/s.
    """

    stance: Stance
    velocity: Vector2
    frequency: float

    @property
    def capture_point(self) -> Vector2:
        """In the level frame, m."""
        x, y, _ = self.stance.com
        return (x + self.velocity[0] / self.frequency, y + self.velocity[1] / self.frequency)


class BodyTracker:
    """Follows the body's motion from encoders and inertial unit.

    Args:
        gravity: m/s2.
        smoothing: Share of the old velocity in the new one at each tick, 0..1.
    """

    def __init__(self, model: RobotModel, gravity: float, smoothing: float) -> None:
        self.reader = stance_reader(model)
        self._sole_height = model.sole_height
        self._gravity = gravity
        self._smoothing = smoothing
        self._last: BodyMotion | None = None

    def forget(self) -> None:
        """The next reading has no past: its velocity is zero."""
        self._last = None

    def follow(self, snapshot: Snapshot, left_share: float, dt: float) -> BodyMotion:
        """The motion of now.

        Args:
            left_share: How much of the weight the left foot carries, 0..1: the velocity is against that foot.
            dt: Time since the last call, s.
        """
        roll, pitch, _ = snapshot.imu.angles
        stance = self.reader.read(snapshot.positions, roll, pitch)
        velocity = self._velocity(stance, left_share, dt)
        height = max(stance.com_from_feet[2] + self._sole_height, LEAST_HEIGHT)
        self._last = BodyMotion(stance, velocity, math.sqrt(self._gravity / height))
        return self._last

    def _velocity(self, stance: Stance, left_share: float, dt: float) -> Vector2:
        if self._last is None:
            return (0.0, 0.0)
        before = _com_from(self._last.stance, left_share)
        now = _com_from(stance, left_share)
        keep = self._smoothing
        x, y = self._last.velocity
        return (
            keep * x + (1.0 - keep) * (now[0] - before[0]) / dt,
            keep * y + (1.0 - keep) * (now[1] - before[1]) / dt,
        )


def _com_from(stance: Stance, left_share: float) -> Sequence[float]:
    """Centre of mass as seen from the ankles, weighted."""
    right_share = 1.0 - left_share
    left, right = stance.left_ankle, stance.right_ankle
    return [stance.com[i] - left_share * left[i] - right_share * right[i] for i in (0, 1)]
