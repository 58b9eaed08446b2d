"""From the electric current of a motor to the torque at its joint."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from ...base.paths import config_file

FIELDS = {"_source", "voltage_v", "gear_efficiency", "motors"}
MOTOR_FIELDS = {"model", "no_load_rpm", "gear_ratios"}


def read_motors(path: Path) -> Mapping[str, float]:
    """Torque per current, in N m / A, by the kind of joint ("HeadYaw", "KneePitch": without L and R).

    A motor's torque constant is the supply voltage over its speed without load.

    Raises:
        ValueError: If the file has fields that nobody reads, or lacks some.
    """
    table = json.loads(path.read_text())
    if set(table) != FIELDS or any(set(motor) != MOTOR_FIELDS for motor in table["motors"]):
        raise ValueError(f"{path}: the fields are {sorted(FIELDS)}, of a motor {sorted(MOTOR_FIELDS)}")
    return {
        kind: table["voltage_v"] / (motor["no_load_rpm"] * math.pi / 30.0) * ratio * table["gear_efficiency"]
        for motor in table["motors"]
        for kind, ratio in motor["gear_ratios"].items()
    }


@lru_cache(maxsize=None)
def _motors() -> Mapping[str, float]:
    return read_motors(config_file("motors.json"))


def torque_per_ampere(joint: str) -> float:
    """Torque at a joint for each ampere of its motor, in N m / A; not a number for an unknown joint."""
    kind = joint[1:] if joint[:1] in ("L", "R") else joint
    return _motors().get(kind, math.nan)
