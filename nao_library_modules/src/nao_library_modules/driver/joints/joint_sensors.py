"""The readings of nao_joint_states, each taken from the robot in one go, and their meaning. No ROS."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...base.paths import config_file
from ...base.rotations import Vector
from ...nao.joint_names import MOTION

MEMORY = "ALMemory"
DEVICE = "Device/SubDeviceList/{}/Value"
SENSOR = "{}/Position/Sensor"
COMMAND = "{}/Position/Actuator"
CURRENT = "{}/ElectricCurrent/Sensor"
STIFFNESS = "{}/Hardness/Actuator"
INERTIAL = tuple(
    f"InertialSensor/{name}/Sensor"
    for name in ("AngleX", "AngleY", *(kind + axis for kind in ("Gyroscope", "Accelerometer") for axis in "XYZ"))
)
# Both hips are turned by one motor, and the robot's memory has it under the name of the left one.
SHARED_MOTORS = {"RHipYawPitch": "LHipYawPitch"}
FRAME_WORLD = 1
MOTORS_FIELDS = {"_source", "voltage_v", "gear_efficiency", "motors"}
MOTOR_FIELDS = {"model", "no_load_rpm", "gear_ratios"}


@dataclass(frozen=True)
class Reading:
    """One reading of the robot.

    Efforts are torques at the joints as the motor currents give them; their sign is that of the way from the measured
    to the commanded angle. They are NaN where the robot gives no current.
    """

    positions: tuple[float, ...]  # rad (hands: 0..1)
    efforts: tuple[float, ...]  # N m
    roll: float  # of the torso by the inertial unit, rad
    pitch: float
    angular_velocity: Vector  # of the torso, in its frame, rad/s
    acceleration: Vector  # felt by the torso, in its frame, m/s^2
    torso: tuple[float, ...] | None  # x, y, z (m), roll, pitch, yaw (rad) in the robot's odometry, if asked for


class JointSensors:
    """Reads joints, inertial unit and odometry of one robot. For one thread.

    Without `use_sensors` commanded angles stand for measured ones; without `use_odometry` the torso is not asked for.
    """

    def __init__(self, robot: Any, joints: Sequence[str], use_sensors: bool = True, use_odometry: bool = True) -> None:
        self._robot = robot
        self.joints = tuple(joints)
        self._use_sensors = use_sensors
        self._use_odometry = use_odometry
        devices = [SHARED_MOTORS.get(joint, joint) for joint in joints]
        self._torque = [torque_per_ampere(joint) for joint in joints]
        keys = [pattern.format(device) for pattern in (SENSOR, COMMAND, CURRENT) for device in devices]
        self._stiffness_keys = [DEVICE.format(STIFFNESS.format(device)) for device in devices]
        self._keys = [DEVICE.format(key) for key in (*keys, *INERTIAL)]

    def read(self) -> Reading:
        """Ask the robot; memory and odometry at the same time.

        Raises NaoError if it cannot be asked, or does not know its joints.
        """
        values = self._robot.proxy(MEMORY).call_async("getListData", self._keys)
        torso = self._ask_torso() if self._use_odometry else None
        return self._reading(
            values.result(timeout=ANSWER_LIMIT), None if torso is None else _six(torso.result(timeout=ANSWER_LIMIT))
        )

    def read_torso(self) -> tuple[float, ...]:
        """Its x, y, z (m), roll, pitch, yaw (rad) in the robot's odometry. Raises NaoError if it cannot be asked."""
        return _six(self._ask_torso().result(timeout=ANSWER_LIMIT))

    def read_stiffnesses(self) -> tuple[float, ...]:
        """Stiffness of each joint, 0 to 1; NaN where the robot gives none. Raises NaoError if it cannot be asked."""
        values = self._robot.proxy(MEMORY).call_async("getListData", self._stiffness_keys).result(timeout=ANSWER_LIMIT)
        return tuple(_number(value) for value in values)

    def _ask_torso(self) -> Any:
        return self._robot.proxy(MOTION).call_async("getPosition", "Torso", FRAME_WORLD, True)

    def _reading(self, values: Sequence[Any], torso: tuple[float, ...] | None) -> Reading:
        count = len(self.joints)
        measured, commanded, currents = (values[i * count : (i + 1) * count] for i in range(3))
        positions = measured if self._use_sensors else commanded
        for joint, position in zip(self.joints, positions):
            if not isinstance(position, (int, float)):
                raise NaoError(f"the robot's memory holds {position!r} as the angle of {joint}")
        efforts = tuple(
            _number(current) * torque * math.copysign(1.0, _number(command) - _number(position))
            for current, torque, command, position in zip(currents, self._torque, commanded, measured)
        )
        roll, pitch, *rest = (_number(value, 0.0) for value in values[3 * count :])
        return Reading(tuple(positions), efforts, roll, pitch, tuple(rest[:3]), tuple(rest[3:6]), torso)


def _six(torso: Sequence[float]) -> tuple[float, ...]:
    if len(torso) != 6 or not all(math.isfinite(value) for value in torso):
        raise NaoError(f"the robot says that its torso is at {torso}: six numbers are a place")
    return tuple(torso)


def _number(value: Any, missing: float = math.nan) -> float:
    """A value of the memory; older robots do not have all of them."""
    return float(value) if isinstance(value, (int, float)) else missing


def read_motors(path: Path) -> Mapping[str, float]:
    """Torque per current, in N m / A, by the kind of joint ("HeadYaw", "KneePitch": without L and R).

    A motor's torque constant is the supply voltage over its speed without load.

    Raises ValueError if the file has unknown fields, or lacks some.
    """
    table = json.loads(path.read_text())
    if set(table) != MOTORS_FIELDS or any(set(motor) != MOTOR_FIELDS for motor in table["motors"]):
        raise ValueError(f"{path}: the fields are {sorted(MOTORS_FIELDS)}, of a motor {sorted(MOTOR_FIELDS)}")
    return {
        kind: table["voltage_v"] / (motor["no_load_rpm"] * math.pi / 30.0) * ratio * table["gear_efficiency"]
        for motor in table["motors"]
        for kind, ratio in motor["gear_ratios"].items()
    }


@lru_cache(maxsize=None)
def _motors() -> Mapping[str, float]:
    return read_motors(config_file("motors.json"))


def torque_per_ampere(joint: str) -> float:
    """Torque at a joint for each ampere of its motor, in N m / A; NaN for an unknown joint."""
    kind = joint[1:] if joint[:1] in ("L", "R") else joint
    return _motors().get(kind, math.nan)
