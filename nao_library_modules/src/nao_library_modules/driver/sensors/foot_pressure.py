"""Force sensors under the feet. No ROS."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.limits import ANSWER_LIMIT

from ...nao.body_devices import SIDES, sensor_key, weight_keys

MEMORY = "ALMemory"
GRAVITY = 9.81
"""The robot tells forces in kg."""
CENTER = "{}Foot/FSR/CenterOfPressure/{}"
CONTACT = "{}FootContact"
LIGHTEST = 0.5
"""N: below it a foot has no centre of pressure."""


@dataclass(frozen=True)
class FootPressure:
    """One foot."""

    forces: tuple[float, ...]  # front left, front right, rear left, rear right, N
    total: float  # N
    center: tuple[float, float]  # of pressure, x, y in the frame of the sole, m; NaN without load
    contact: bool  # whether it touches the ground


def keys_of(side: str) -> list[str]:
    """Keys of one foot, in the order of `read_foot`."""
    center = [sensor_key(CENTER.format(side[0].upper(), axis)) for axis in "XY"]
    return [*weight_keys(side), *center, CONTACT.format(side)]


def read_foot(values: Sequence[Any]) -> FootPressure:
    """A foot from the values of its keys; missing ones are NaN."""
    numbers = [float(each) if isinstance(each, (bool, int, float)) else math.nan for each in values]
    forces = tuple(GRAVITY * each for each in numbers[:4])
    total = GRAVITY * numbers[4]
    loaded = total >= LIGHTEST
    center = (numbers[5], numbers[6]) if loaded else (math.nan, math.nan)
    return FootPressure(forces, total, center, numbers[7] > 0.5)


def read_feet(robot: Any) -> dict[str, FootPressure]:
    """Both feet, by side, in one call; raises NaoError if the robot cannot be asked."""
    keys = [key for side in SIDES for key in keys_of(side)]
    values = robot.proxy(MEMORY).call_async("getListData", keys).result(timeout=ANSWER_LIMIT)
    count = len(keys) // len(SIDES)
    return {side: read_foot(values[place * count : (place + 1) * count]) for place, side in enumerate(SIDES)}
