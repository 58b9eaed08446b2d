"""Readings of joints, inertial unit and odometry, and the kinematics and arithmetic on them. No ROS.

Lengths and axes of the legs: published kinematics of the NAO, the same in V3 to V6; the footprint is that of REP 120
and nao_description.
"""

from __future__ import annotations

import json
import math
import threading
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Tuple

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...core.files import config_file
from ...core.geometry import ORIGIN, Place, Quaternion, Vector, about, from_roll_pitch_yaw, inverse, rotate
from ...core.nao_facts import MOTION
from ...core.robot import ask

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
        values = ask(self._robot, MEMORY, "getListData", self._stiffness_keys)
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


HIP_Y, HIP_Z = 0.05, 0.085
THIGH, TIBIA, FOOT = 0.1, 0.1029, 0.04519
"""m: hip in the torso frame, lengths of thigh and tibia, height of the ankle above the sole."""
X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
_TILTED = math.sqrt(0.5)
LEG = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
LEG_JOINTS = {side: tuple(side + joint for joint in LEG) for side in ("L", "R")}

Pose = Tuple[Vector, Quaternion]


def sole(side: str, angles: Sequence[float]) -> Vector:
    """Place of a sole in the torso frame, m, from the angles of a leg (L or R), hip first, rad."""
    outwards = 1.0 if side == "L" else -1.0
    place: Vector = (0.0, 0.0, -FOOT)
    # From the ankle up: each joint turns all that hangs on it.
    axes = ((0.0, _TILTED, -_TILTED * outwards), X, Y, Y, Y, X)
    lengths = (0.0, 0.0, 0.0, THIGH, TIBIA, 0.0)
    for axis, angle, length in reversed(list(zip(axes, angles, lengths))):
        x, y, z = rotate(about(axis, angle), place)
        place = (x, y, z - length)
    return (place[0], place[1] + HIP_Y * outwards, place[2] - HIP_Z)


def footprint(angles: Mapping[str, float], roll: float, pitch: float) -> Pose:
    """The frame base_footprint in the torso frame: between the soles, level, at the lower one, heading as the torso.

    Joint angles are those measured, roll and pitch those of the torso, all in rad.

    Raises KeyError if a joint of the legs is missing, as on a robot without legs.
    """
    tilt = from_roll_pitch_yaw(roll, pitch, 0.0)
    feet = [sole(side, [angles[joint] for joint in joints]) for side, joints in LEG_JOINTS.items()]
    left, right = (rotate(tilt, place) for place in feet)
    middle = ((left[0] + right[0]) / 2, (left[1] + right[1]) / 2, min(left[2], right[2]))
    back = inverse(tilt)
    return rotate(back, middle), back


class OdometryOffset:
    """The offset of the published odometry from the robot's own: a place on the floor and a heading.

    Height, roll and pitch of the torso stay those of the robot, so that the frame of odometry keeps level with the
    floor. Every change raises NaoError before the first reading.

    Threads: one corrects readings, others (services) change the offset; the lock guards all of it.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._offset = ORIGIN
        self._raw: Place | None = None
        self._paused_at: Place | None = None
        self._jumps = 0

    def correct(self, torso: Sequence[float]) -> tuple[tuple[float, ...], int]:
        """The torso's x, y, z (m) and roll, pitch, yaw (rad) in the published odometry, from those in the robot's own.

        Also how often the published odometry has jumped: speeds taken across a jump would be wrong.
        """
        x, y, z, roll, pitch, yaw = torso
        with self._lock:
            self._raw = Place(x, y, yaw)
            if self._paused_at is not None:  # whatever the robot thinks it does does not count
                self._offset = self._paused_at.then(self._raw.inverse())
            place, jumps = self._offset.then(self._raw), self._jumps
        return (place.x, place.y, z, roll, pitch, place.yaw), jumps

    def pause(self) -> None:
        """Let the published odometry stand still, for a robot that is carried or slips."""
        with self._lock:
            if self._paused_at is None:
                self._paused_at = self._published()

    def resume(self) -> None:
        with self._lock:
            self._paused_at = None

    def move_by(self, way: Place) -> None:
        """Move the torso in the published odometry; the way is in its frame there, seen from above."""
        with self._lock:
            self._jump_to(self._published().then(way))

    def set(self, place: Place) -> None:
        with self._lock:
            self._published()
            self._jump_to(place)

    def _published(self) -> Place:
        if self._raw is None:
            raise NaoError("no odometry of the robot was read yet")
        return self._offset.then(self._raw)

    def _jump_to(self, place: Place) -> None:
        self._offset = place.then(self._raw.inverse())
        if self._paused_at is not None:
            self._paused_at = place
        self._jumps += 1


SAMPLES = 5
GAP = 0.5
"""s without a sample after which older ones say nothing about the present."""


class SlopeEstimator:
    """Slopes of straight lines through the last few samples of several values.

    The robot measures in cycles of its own, so of two samples 20 ms apart one may hold one cycle's motion and the next
    three; a line through several of them is not upset by that. The slope is that of the middle of the window.
    """

    def __init__(self) -> None:
        self._samples: deque[tuple[float, Sequence[float]]] = deque(maxlen=SAMPLES)

    def add(self, time: float, values: Sequence[float]) -> list[float]:
        """Take a sample and return the change of each value per s; zeros with less than two samples.

        A `time` (s) that goes back, or far ahead, restarts the estimator.
        """
        if self._samples and not 0.0 <= time - self._samples[-1][0] <= GAP:
            self._samples.clear()
        if self._samples and time == self._samples[-1][0]:
            self._samples.pop()
        self._samples.append((time, values))
        count = len(self._samples)
        mean = sum(t for t, _ in self._samples) / count
        offsets = [t - mean for t, _ in self._samples]
        spread = sum(offset * offset for offset in offsets)
        if spread == 0.0:
            return [0.0] * len(values)
        weights = [offset / spread for offset in offsets]
        return [sum(w * v for w, v in zip(weights, column)) for column in zip(*(row for _, row in self._samples))]
