"""The two sonars of the chest: where echoes come from, how strong they are, and what is heard of them.

Sound of 40 kHz, whose waves are 9 mm long, meets walls, floors and furniture as light meets a mirror: what comes back
to the sensor comes from where a surface faces it. For every convex shape that is its nearest point, be it on a face, on
an edge or on a round side. A floor in front of a standing robot throws the sound on, away from it, and is not heard; a
wall is heard where it is perpendicular to the line of sight, if that is within the beam.
"""

from __future__ import annotations

import math
from typing import Iterator, List, NamedTuple, Protocol, Sequence, Tuple

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Vector3, from_roll_pitch_yaw, plus, rotate, vector3
from nao_sim_bridge.model.robot_model import RobotModel

PERIOD = 0.1
FORWARD: Vector3 = (1.0, 0.0, 0.0)
HALF_CONE = math.radians(30.0)
"""Half of the effective cone that the maker states."""
NO_ECHO = 5.0
"""What the robot reports when nothing echoes, m."""
NEAREST, FARTHEST = 0.01, 2.55
"""Echoes are told from and up to this distance, m. Source: sonars of NAO V4."""
WIDEST = math.cos(math.radians(60.0))
"""Cosine of the angle to the axis from which on nothing is ever heard."""
WAVE = 343.0 / 40e3
"""Length of the waves, m."""
BEAM_LOSS = 0.018 * math.degrees(1.0) ** 2
"""dB/rad2, there and back: 16 dB at the edge of the cone, 8 each way."""
ABSORPTION = 2.6
"""dB/m of air, there and back, at 40 kHz."""
BUDGET = 22.0
"""An echo is heard when it is at most this much weaker than that of a wall 1 m ahead, dB: with it, a wall across the
robot's way, 22.5 degrees off the axes, is heard from as far away as the maker states."""
MOST_ECHOES = 8
"""Of each sonar, before those that are one are merged."""
MERGED = 0.03
"""Echoes that follow each other within this distance, m, are one: that is how long a pulse is."""

Echoes = Tuple[float, ...]


class Surface(NamedTuple):
    """The point of a shape that is nearest to the sonars.

    Attributes:
        point: In world, m.
        body: Whose it is.
        link: Of which of its links.
    """

    point: Vector3
    body: int
    link: int = -1


class Surroundings(Protocol):
    """What the sonars ask about the world."""

    def surfaces(self, place: Vector3, ahead: Vector3, reach: float) -> Sequence[Surface]:
        """Surfaces within `reach` m of a place, ahead of it."""

    def extents(self, surface: Surface, sight: Vector3) -> Tuple[float, float]:
        """How large that is to which a surface belongs, m, across a line of sight."""

    def visible(self, places: Sequence[Vector3], surfaces: Sequence[Surface]) -> Sequence[bool]:
        """Whether nothing else is between a place and a surface, for pairs of them."""


class Sonars:
    """Left and right sonar.

    Attributes:
        echoes: Of each sonar, distances in m, nearest first; a new tuple with each measurement.
    """

    def __init__(self, model: RobotModel, surroundings: Surroundings) -> None:
        self._places = [(vector3(s.position), rotate(from_roll_pitch_yaw(*s.rpy), FORWARD)) for s in model.sonars]
        # Both are so near to each other that one search for surfaces does for them.
        self._middle = vector3(sum(s.position for s in model.sonars) / len(model.sonars))
        self._surroundings = surroundings
        self._next = 0.0
        self._last: tuple[float, ...] = (NO_ECHO,) * len(self._places)
        self.echoes: tuple[Echoes, ...] = ((),) * len(self._places)

    def reset(self) -> None:
        """Measure at the next reading: the robot was put somewhere else."""
        self._next = 0.0

    def read(self, now: float, torso: Pose) -> tuple[float, ...]:
        """Distances of the first echoes in m, measured anew every 0.1 s of simulated time."""
        if now < self._next - 1e-9:  # float rounding must not cost a tick
            return self._last
        self._next = now + PERIOD
        self.echoes = self._measure(torso)
        self._last = tuple(echoes[0] if echoes else NO_ECHO for echoes in self.echoes)
        return self._last

    def _measure(self, torso: Pose) -> tuple[Echoes, ...]:
        def to_world(point: Vector3) -> Vector3:
            return plus(torso.position, rotate(torso.orientation, point))

        ahead = rotate(torso.orientation, FORWARD)
        surfaces = self._surroundings.surfaces(to_world(self._middle), ahead, FARTHEST)
        heard: list[tuple[int, float, Vector3, Surface]] = []
        for side, (position, axis) in enumerate(self._places):
            place = to_world(position)
            for distance, surface in self._heard(place, rotate(torso.orientation, axis), surfaces):
                heard.append((side, distance, place, surface))
        if not heard:
            return ((),) * len(self._places)
        visible = self._surroundings.visible([entry[2] for entry in heard], [entry[3] for entry in heard])
        found: list[list[float]] = [[] for _ in self._places]
        for (side, distance, _, _), free in zip(heard, visible):
            if free:
                found[side].append(distance)
        return tuple(map(_merged, found))

    def _heard(self, place: Vector3, axis: Vector3, surfaces: Sequence[Surface]) -> list[tuple[float, Surface]]:
        """The nearest surfaces that a sonar hears, with their distances, m."""
        heard: list[tuple[float, Surface]] = []
        for distance, loss, surface in sorted(_within_beam(place, axis, surfaces), key=lambda found: found[0]):
            sight = tuple(b - a for a, b in zip(place, surface.point))
            if loss + smallness(distance, self._surroundings.extents(surface, sight)) <= BUDGET:
                heard.append((distance, surface))
                if len(heard) == MOST_ECHOES:
                    break
        return heard


def _within_beam(place: Vector3, axis: Vector3, surfaces: Sequence[Surface]) -> Iterator[tuple[float, float, Surface]]:
    """Surfaces that would be heard if they were large: distance, m, loss, dB, and surface of each."""
    (x, y, z), (ax, ay, az) = place, axis
    for surface in surfaces:
        px, py, pz = surface.point
        dx, dy, dz = px - x, py - y, pz - z
        distance = math.sqrt(dx * dx + dy * dy + dz * dz)
        if distance > FARTHEST:
            continue
        if distance < NEAREST:
            yield NEAREST, -math.inf, surface
            continue
        cosine = (dx * ax + dy * ay + dz * az) / distance
        if cosine >= WIDEST:
            loss = spread(distance, math.acos(min(cosine, 1.0)))
            if loss <= BUDGET:
                yield distance, loss, surface


def spread(distance: float, angle: float) -> float:
    """How much weaker the echo of a wall is than that of one 1 m ahead, dB.

    Args:
        distance: Of the wall, m.
        angle: Between the axis of the sonar and the way to it, rad.
    """
    return 20.0 * math.log10(distance) + ABSORPTION * (distance - 1.0) + BEAM_LOSS * angle * angle


def smallness(distance: float, extents: Tuple[float, float]) -> float:
    """How much weaker than that of a wall the echo is of something small, dB.

    Args:
        distance: Of the thing, m.
        extents: Its width and height, m; a wall echoes in phase from a zone, and what is smaller sends back less.
    """
    zone = math.sqrt(2.0 * WAVE * distance)
    area = min(extents[0] / zone, 1.0) * min(extents[1] / zone, 1.0)
    return -20.0 * math.log10(max(area, 1e-6))


def _merged(distances: Sequence[float]) -> Echoes:
    kept: List[float] = []
    for distance in sorted(distances):
        if not kept or distance - kept[-1] > MERGED:
            kept.append(distance)
    return tuple(kept)
