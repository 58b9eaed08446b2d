"""The way of a simulated hand over touch sensors, in the frame of the link that has them. Arithmetic only."""

from __future__ import annotations

import math
from typing import List, Mapping, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.rotations import Quaternion, Vector3, from_roll_pitch_yaw, rotate
from nao_sim_bridge.model.robot_model import Place, RobotModel
from nao_sim_bridge.model.touch_names import sensor_of

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


class HandPath:
    """Sensors in a row that a hand strokes over; one alone is pressed.

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
        self._stops: List[Tuple[Vector3, Vector3]] = [(_vector(p.position), _outward(p)) for p in places]

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
    return rotate(from_roll_pitch_yaw(*(float(angle) for angle in place.rpy)), (1.0, 0.0, 0.0))


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


def _vector(values: Sequence[float]) -> Vector3:
    x, y, z = (float(value) for value in values)
    return x, y, z
