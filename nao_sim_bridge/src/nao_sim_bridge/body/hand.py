"""Simulated hands at touch sensors: their way over them, what they look like, and which sensor somebody points at."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, List, Mapping, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.rotations import Quaternion, Vector3, from_roll_pitch_yaw, rotate, vector3
from nao_sim_bridge.model.robot_model import Place, RobotModel
from nao_sim_bridge.model.shapes import Shape, rod
from nao_sim_bridge.model.touch_names import sensor_of
from nao_sim_bridge.world.world import Part, WorldObject

if TYPE_CHECKING:
    from nao_sim_bridge.body.physics import Physics

AWAY = 0.12
"""Where a hand comes from and goes to, m off the sensor."""
DEPTH = 0.006
"""How far inside the surface the tip of the finger aims, m: it presses with its force instead of getting there. Not
much further, or the force, which is limited along each axis, would not draw it on where it is to be."""
MOST_SENSORS = 8
FROM_ABOVE: Vector3 = (0.0, 0.0, -0.45)
TILTS: Mapping[str, Vector3] = {"HeadPitch": (0.6, 0.0, 0.0), "WristYaw": (-0.6, 0.0, 0.0)}
"""How much a hand comes from the side: the arm comes from behind to the head, from beyond the fingers to hands, and
else from above, in the frame of the link; lengths as shares of that of the direction that it presses in."""
POINTED = 0.025
"""A sensor is meant that is at most this far from the line of sight of who points, m."""
HIDDEN = 0.03
"""One that is this much further away than what is seen, m, is behind it."""
FACING = 0.2
"""Cosine to the line of sight from which on a sensor is on the far side."""
TIP_RADIUS = 0.008
MASS = 0.02
SKIN, SLEEVE = (0.87, 0.66, 0.53), (0.25, 0.35, 0.55)
# In a frame at the tip of the forefinger, which points along X; the palm looks along -Z. Ends of fingers, m.
_FOREFINGER = ((-0.068, 0.0, 0.004), (0.0, 0.0, 0.0))
_BENT = tuple(((-0.070, y, 0.002), (-0.052, y, -0.018)) for y in (0.017, 0.034, 0.050))
_THUMB = ((-0.100, -0.016, -0.004), (-0.062, -0.034, -0.012))
_PALM = Shape("box", (0.072, 0.070, 0.024), (-0.105, 0.025, 0.004))
_SLEEVE = ((-0.245, 0.025, 0.004), (-0.155, 0.025, 0.004))


class HandPath:
    """Sensors in a row that a hand strokes over, in the frame of the link that has them; one alone is pressed.

    Attributes:
        sensors: Their names.
        link: Name of the link that has them, as the model calls it.
        lifts: How far what is felt of the robot is over each sensor, m.

    Args:
        names: Of sensors or of their events.

    Raises:
        UnknownName: There is no such sensor.
        BadValue: There are none, too many, or they are on different parts of the robot.
    """

    def __init__(self, model: RobotModel, names: Sequence[str]) -> None:
        if not 1 <= len(names) <= MOST_SENSORS:
            raise BadValue("number of sensors", len(names), f"1 to {MOST_SENSORS}, in the order of the stroke")
        places = [_place(model, sensor_of(name)) for name in names]
        if len({place.parent_link for place in places}) > 1:
            raise BadValue("sensors", list(names), "sensors of one part of the robot, for a stroke")
        self.sensors = tuple(place.name for place in places)
        self.link = places[0].parent_link
        self._tilt = TILTS.get(self.link.lstrip("LR"), FROM_ABOVE)
        self.lifts = [0.0] * len(places)
        self._stops: List[Tuple[Vector3, Vector3]] = [(vector3(p.position), _outward(p)) for p in places]

    def at(self, share: float, off: float) -> Tuple[Vector3, Quaternion]:
        """Where the tip of the finger is, and how the hand is turned.

        Args:
            share: Of the way from the first sensor to the last, 0..1.
            off: Distance from the surface, m; below 0 inside.
        """
        position, normal, lift = self._surface(share)
        off += lift
        x, y, z = (p + off * n for p, n in zip(position, normal))
        return (x, y, z), _pointing(tuple(t - n for t, n in zip(self._tilt, normal)))

    def sensor(self, number: int) -> Tuple[Vector3, Vector3]:
        """Position, m, and unit vector out of the robot of a sensor."""
        return self._stops[number]

    def _surface(self, share: float) -> Tuple[Vector3, Vector3, float]:
        along = min(max(share, 0.0), 1.0) * (len(self._stops) - 1)
        before = min(int(along), max(len(self._stops) - 2, 0))
        if len(self._stops) == 1:
            return (*self._stops[0], self.lifts[0])
        (p, n), (q, m) = self._stops[before : before + 2]
        part = along - before
        low, high = self.lifts[before : before + 2]
        return _between(p, q, part), _unit(_between(n, m, part)), low + part * (high - low)


def _place(model: RobotModel, name: str) -> Place:
    for place in model.touch:
        if place.name == name:
            return place
    raise UnknownName("touch sensor", name, [place.name for place in model.touch])


def _outward(place: Place) -> Vector3:
    """Unit vector out of the robot at a sensor, whose X axis it is."""
    return rotate(from_roll_pitch_yaw(*vector3(place.rpy)), (1.0, 0.0, 0.0))


def _pointing(direction: Vector3) -> Quaternion:
    """The turn of a hand that points in a direction, with its back up."""
    x, y, z = _unit(direction)
    return from_roll_pitch_yaw(0.0, -math.asin(max(-1.0, min(1.0, z))), math.atan2(y, x))


def _between(a: Vector3, b: Vector3, share: float) -> Vector3:
    x, y, z = (p + share * (q - p) for p, q in zip(a, b))
    return x, y, z


def _unit(vector: Vector3) -> Vector3:
    length = math.sqrt(sum(value * value for value in vector))
    x, y, z = (value / length for value in vector)
    return x, y, z


def make_hand(name: str) -> WorldObject:
    """A hand as a thing of the world, whose frame is at the tip of the finger that it points with along X."""
    fingers = [_rod(*ends, TIP_RADIUS) for ends in (_FOREFINGER, *_BENT, _THUMB)]
    parts = [Part(shape, SKIN) for shape in (*fingers, _PALM)]
    parts.append(Part(_rod(*_SLEEVE, 0.034), SLEEVE))
    return WorldObject(
        name=name,
        position=(0.0, 0.0, -1.0),  # out of the way until it is put somewhere
        rpy=(0.0, 0.0, 0.0),
        parts=tuple(parts),
        mass=MASS,
        friction=0.05,
        rolling_friction=0.0,
        restitution=0.0,
        body=(Shape("sphere", (TIP_RADIUS,), (0.0, 0.0, 0.0)),),
        kind="hand",
    )


def _rod(start: tuple, end: tuple, radius: float) -> Shape:
    return rod("capsule", radius, np.array(start), np.array(end))


def pointed_at(model: RobotModel, physics: Physics, eye: Vector3, direction: Vector3) -> frozenset[str]:
    """The sensor that is seen nearest to a line of sight; none when nothing is near.

    Args:
        eye: Where the line begins, m, in world.
        direction: Unit vector, in world.
    """
    seen_at = physics.free_sight(eye, direction)
    best, name = POINTED, ""
    for place in model.touch:
        link = physics.pose_of(model.link(place.parent_link).alt_name)
        offset = rotate(link.orientation, vector3(place.position))
        way = [a + b - c for a, b, c in zip(link.position, offset, eye)]
        along = _dot(way, direction)
        aside = math.sqrt(max(_dot(way, way) - along * along, 0.0))
        if along <= 0.0 or along > seen_at + HIDDEN or aside >= best:
            continue
        if _dot(rotate(link.orientation, _outward(place)), direction) < FACING:
            best, name = aside, place.name
    return frozenset((name,)) if name else frozenset()


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
