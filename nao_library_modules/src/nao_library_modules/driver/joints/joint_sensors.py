"""What nao_joint_states reads from the robot in one go, and what the values mean. No ROS."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ...nao.joint_names import MOTION
from ..base.rotation import Vector
from .motors import torque_per_ampere

MEMORY = "ALMemory"
DEVICE = "Device/SubDeviceList/{}/Value"
SENSOR = "{}/Position/Sensor"
COMMAND = "{}/Position/Actuator"
CURRENT = "{}/ElectricCurrent/Sensor"
STIFFNESS = "{}/Hardness/Actuator"
INERTIAL = tuple(
    f"InertialSensor/{name}/Sensor"
    for name in (
        "AngleX",
        "AngleY",
        "GyroscopeX",
        "GyroscopeY",
        "GyroscopeZ",
        "AccelerometerX",
        "AccelerometerY",
        "AccelerometerZ",
    )
)
# Both hips are turned by one motor, and the robot's memory has it under the name of the left one.
SHARED_MOTORS = {"RHipYawPitch": "LHipYawPitch"}
FRAME_WORLD = 1
LIMIT = 1.0
"""s that the robot may take for one reading."""


@dataclass(frozen=True)
class Reading:
    """One reading of the robot.

    Attributes:
        positions: Angle of each joint, in rad (hands: 0..1).
        efforts: Torque at each joint in N m, as far as the motor's current tells; its sign is that of the way from the
            measured to the commanded angle. Not a number where the robot does not tell.
        roll: Of the torso by the inertial unit, in rad.
        pitch: Likewise.
        angular_velocity: Of the torso, in its frame, rad/s.
        acceleration: That the torso feels, in its frame, m/s^2.
        torso: Its x, y, z (m) and roll, pitch, yaw (rad) in the robot's odometry; None if it was not asked for.
    """

    positions: tuple[float, ...]
    efforts: tuple[float, ...]
    roll: float
    pitch: float
    angular_velocity: Vector
    acceleration: Vector
    torso: tuple[float, ...] | None


class JointSensors:
    """Reads joints, inertial unit and odometry of one robot. For one thread."""

    def __init__(self, robot: Any, joints: Sequence[str], use_sensors: bool = True, use_odometry: bool = True) -> None:
        """Prepare the question; nothing is asked yet.

        Args:
            robot: Its proxies and connection, see `nao_library_modules.robot`.
            joints: Names of the joints.
            use_sensors: False takes commanded angles for measured ones.
            use_odometry: Whether to ask for the place of the torso.
        """
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

        Raises:
            NaoError: If it cannot be asked, or does not know its joints.
        """
        values = self._robot.proxy(MEMORY).call_async("getListData", self._keys)
        torso = None
        if self._use_odometry:
            torso = self._robot.proxy(MOTION).call_async("getPosition", "Torso", FRAME_WORLD, True)
        return self._reading(values.result(timeout=LIMIT), None if torso is None else torso.result(timeout=LIMIT))

    def read_stiffnesses(self) -> tuple[float, ...]:
        """Stiffness of each joint, 0 to 1; not a number where the robot does not tell.

        Raises:
            NaoError: If it cannot be asked.
        """
        values = self._robot.proxy(MEMORY).call_async("getListData", self._stiffness_keys).result(timeout=LIMIT)
        return tuple(_number(value) for value in values)

    def _reading(self, values: Sequence[Any], torso: Sequence[float] | None) -> Reading:
        count = len(self.joints)
        measured, commanded, currents = (values[i * count : (i + 1) * count] for i in range(3))
        positions = measured if self._use_sensors else commanded
        for joint, position in zip(self.joints, positions):
            if not isinstance(position, (int, float)):
                raise NaoError(f"the robot's memory holds {position!r} as the angle of {joint}")
        if torso is not None and (len(torso) != 6 or not all(math.isfinite(value) for value in torso)):
            raise NaoError(f"the robot says that its torso is at {torso}: six numbers are a place")
        efforts = tuple(
            _number(current) * torque * math.copysign(1.0, _number(command) - _number(position))
            for current, torque, command, position in zip(currents, self._torque, commanded, measured)
        )
        roll, pitch, *rest = (_number(value, 0.0) for value in values[3 * count :])
        return Reading(
            tuple(positions),
            efforts,
            roll,
            pitch,
            (rest[0], rest[1], rest[2]),
            (rest[3], rest[4], rest[5]),
            None if torso is None else tuple(torso),
        )


def _number(value: Any, missing: float = math.nan) -> float:
    """A value of the memory; older robots do not have all of them."""
    return float(value) if isinstance(value, (int, float)) else missing
