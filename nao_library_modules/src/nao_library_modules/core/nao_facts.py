"""Facts of the NAO: joints, stiffness, walk speed, devices, touch sensors, cameras, gaze and folders. No ROS."""

from __future__ import annotations

import json
import math
import posixpath
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from naoqi.errors import NaoError, RobotError
from naoqi.limits import ANSWER_LIMIT

from .errors import BadGoal, CannotWalk, did_you_mean
from .files import config_file
from .waiting import OncePerConnection

MOTION = "ALMotion"
MOVE_FAILED = f"{MOTION}/MoveFailed"
"""Event of a walk that ends, or does not begin: cause, 0 not started or 1 stopped on the way, place of an obstacle."""
LEGS = ("LLeg", "RLeg")
CHAINS = (
    "Body",
    "Head",
    "LArm",
    "RArm",
    "LLeg",
    "RLeg",
    "Arms",
    "Legs",
    "Joints",
    "Actuators",
    "JointActuators",
    "BodyJoints",
    "BodyActuators",
)
"""Names that stand for several joints. Not every robot knows all of them."""


class JointNames:
    """Chains of one robot. Any thread may ask; at worst two ask the robot at the same time."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._chains = OncePerConnection(robot, self._ask)

    @property
    def chains(self) -> Mapping[str, tuple[str, ...]]:
        """Chain -> its joints. Raises NaoError if the robot cannot be asked."""
        return self._chains()

    @property
    def body(self) -> tuple[str, ...]:
        """All joints, in the robot's order. Raises NaoError if the robot cannot be asked."""
        return self.chains["Body"]

    def _ask(self) -> dict[str, tuple[str, ...]]:
        motion = self._robot.proxy(MOTION)
        calls = {chain: motion.call_async("getBodyNames", chain) for chain in CHAINS}
        chains = {}
        for chain, call in calls.items():
            try:
                chains[chain] = tuple(call.result(timeout=ANSWER_LIMIT))
            except RobotError:
                continue  # a robot without this chain says so
        if "Body" not in chains:
            raise NaoError(f"the robot at {self._robot.address} does not tell the names of its joints")
        return chains


SOFTEST = 0.6
"""Stiffness of a leg's joint above which NAOqi walks."""


def require_stiff(stiffnesses: Mapping[str, float]) -> None:
    """Check stiffnesses of the legs' joints, 0..1 by name; raises CannotWalk if one is too soft."""
    softest = min(stiffnesses, key=stiffnesses.__getitem__)
    stiffness = stiffnesses[softest]
    if not stiffness > SOFTEST:
        how = f"too soft to walk: {softest} has stiffness {stiffness:.2f}, above {SOFTEST:g} is needed"
        raise CannotWalk("the legs are limp" if stiffness == 0.0 else f"the legs are {how}", "wakeUp first")


def ask_for_stiff_legs(robot: Any) -> None:
    """Ask a robot for the stiffness of its legs. Raises CannotWalk as above; NaoError if it cannot be asked."""
    ask = robot.proxy(MOTION).call_async
    stiffnesses = ask("getStiffnesses", list(LEGS)).result(timeout=ANSWER_LIMIT)
    if min(stiffnesses) > SOFTEST:
        return
    calls = [ask("getBodyNames", leg) for leg in LEGS]
    names = [name for call in calls for name in call.result(timeout=ANSWER_LIMIT)]
    require_stiff(dict(zip(names, stiffnesses)))


SHORTEST_STEP, LONGEST_STEP = 0.42, 0.6
"""s that a step takes at the highest and the lowest frequency."""
STEP_LENGTH, STEP_TURN = 0.04, 0.349
"""m, rad: the longest step ahead and the largest turn of a step, where nobody asks for others."""


def step_period(frequency: float) -> float:
    """Time that a step takes, s. `frequency`: share 0..1 of the range of step frequencies."""
    return LONGEST_STEP + frequency * (SHORTEST_STEP - LONGEST_STEP)


def top_speeds(frequency: float) -> tuple[float, float]:
    """Speed ahead, m/s, and of turning, rad/s, that velocities of 1 mean. `frequency`: as `step_period` takes it."""
    period = step_period(frequency)
    return STEP_LENGTH / period, STEP_TURN / period


PREFIX = "Device/SubDeviceList/"
"""What all keys of devices begin with."""


def sensor_key(device: str, part: str = "Value") -> str:
    """Key of what a device measures; its `Status` is another part."""
    return f"{PREFIX}{device}/Sensor/{part}"


def temperature_key(device: str) -> str:
    """Key of the temperature in degC of a joint's motor, of the `Head` or the `Battery`."""
    return sensor_key(f"{device}/Temperature")


# --- battery ----------------------------------------------------------------------------------------------------------

CHARGE = sensor_key("Battery/Charge")
"""0..1."""
CURRENT = sensor_key("Battery/Current")
"""A, above 0 while the battery is charged."""
BATTERY_STATUS = sensor_key("Battery/Charge", "Status")
"""A word of bits."""
FULL_BIT, CHARGING_BIT = 6, 7
"""Of the status, counted from 0."""

# Motors are at their limit from the first temperature on, degC, and very hot from the second: the robot itself puts
# their chain to rest then. Source: NAOqi's status of temperatures.
HOT_MOTOR, TOO_HOT_MOTOR = 68.0, 74.0

# --- sonars -----------------------------------------------------------------------------------------------------------

SIDES = ("left", "right")
SONARS = {name: sensor_key(f"US/{name.capitalize()}") for name in SIDES}
"""Side -> key of its echo."""
NEAREST, FARTHEST = 0.25, 2.55
"""m, between which sonars measure."""
SONAR_CONE = 1.05
"""rad, in which a sonar sees something: 60 degrees, as NAO's documentation has it."""


def echo_of(value: Any) -> float:
    """Distance of an echo, m.

    `value`: what the robot's memory says: m to the nearest echo, 0 for a sensor that failed, the farthest or more where
    nothing echoed. Returns infinity where there is nothing, not a number for a sensor that failed.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0.0:
        return math.nan
    return math.inf if value >= FARTHEST else float(value)


# --- feet -------------------------------------------------------------------------------------------------------------

CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
"""Where the force sensors of a foot are."""
FOOT_CONTACT = "footContact"
"""Key that is above 0 while a foot touches the ground."""


def weight_keys(side: str) -> list[str]:
    """Keys of what rests on a foot, kg: on its corners, and in all."""
    return [sensor_key(f"{side[0].upper()}Foot/FSR/{part}") for part in (*CORNERS, "TotalWeight")]


@dataclass(frozen=True)
class Sensor:
    """Something that can be touched."""

    name: str  # its short name
    event: str  # the event of the robot's memory that tells of it
    devices: tuple[str, ...]  # its switches or plates, by their names in the robot's memory
    groups: tuple[str, ...]  # groups that it is in

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of its devices: it is touched while one of them is not 0."""
        return tuple(sensor_key(device) for device in self.devices)


def _hand(side: str, part: str) -> Sensor:
    name, letter = side.lower(), side[0]
    return Sensor(
        f"{name} hand {part.lower()}",
        f"Hand{side}{part}Touched",
        (f"{letter}Hand/Touch/{part}",),
        (f"{name} hand", "hands", "any"),
    )


def _bumper(side: str) -> Sensor:
    foot = f"{side[0]}Foot/Bumper"
    return Sensor(
        f"{side.lower()} bumper", f"{side}BumperPressed", (f"{foot}/Left", f"{foot}/Right"), ("bumpers", "any")
    )


SENSORS = (
    *(
        Sensor(f"{part.lower()} head", f"{part}TactilTouched", (f"Head/Touch/{part}",), ("head", "any"))
        for part in ("Front", "Middle", "Rear")
    ),
    *(_hand(side, part) for side in ("Left", "Right") for part in ("Back", "Left", "Right")),
    *(_bumper(side) for side in ("Left", "Right")),
    Sensor("chest", "ChestButtonPressed", ("ChestBoard/Button",), ("any",)),
)
"""All of them, from head to foot."""

BUMPERS = tuple(sensor for sensor in SENSORS if "bumpers" in sensor.groups)
GROUPS = ("head", "left hand", "right hand", "hands", "bumpers", "any")
BY_EVENT = {sensor.event: sensor for sensor in SENSORS}


def names_of(sensors: Iterable[Sensor]) -> list[str]:
    return [sensor.name for sensor in sensors]


def sensors_of(words: Sequence[str], field: str = "sensors") -> tuple[Sensor, ...]:
    """Sensors behind short names, events, devices and groups; each once, in the order of `SENSORS`.

    `words`: the names; none stands for all sensors. `field`: of the message that holds them. Raises BadGoal if
    something has none of these names.
    """
    if not words:
        return SENSORS
    wanted = [sensor for word in words for sensor in _behind(word, field)]
    return tuple(sensor for sensor in SENSORS if sensor in wanted)


def devices_of(words: Sequence[str]) -> list[str]:
    """Devices behind words as `sensors_of` takes them, each once; a device means itself alone.

    Raises BadGoal if something has none of these names.
    """
    found: dict[str, None] = {}
    for word in words:
        sensors = _behind(word, "sensors")
        devices = [device for sensor in sensors for device in sensor.devices]
        found.update(dict.fromkeys([word] if word in devices else devices))
    return list(found)


def _behind(word: str, field: str) -> list[Sensor]:
    plain = " ".join(word.replace("_", " ").split())
    lower = plain.lower()
    words = sorted(lower.split())  # in any order: head front, front head
    found = [
        s
        for s in SENSORS
        if any(words == sorted(name.split()) for name in (s.name, *s.groups)) or word.strip() in (s.event, *s.devices)
    ]
    if not found:
        known = [*GROUPS, *names_of(SENSORS)]
        events = ", ".join(sensor.event for sensor in SENSORS)
        devices = [device for sensor in SENSORS for device in sensor.devices]
        hint = did_you_mean(lower, known) or did_you_mean(word, devices)
        problem = f"{word!r} is nothing that can be touched{hint}"
        raise BadGoal(field, word, f"one of {', '.join(known)}, or an event: {events}", problem=problem)
    return found


TOP, BOTTOM = 0, 1
CAMERAS = {TOP: "top", BOTTOM: "bottom"}
"""NAOqi's number of a camera -> its name in topics, parameters and goals."""
CAMERA_NAMES = {TOP: "CameraTop", BOTTOM: "CameraBottom"}
"""NAOqi's number of a camera -> its name in NAOqi and, with an ending, in /tf."""

RESOLUTIONS = {
    "QQQQVGA": (8, 40, 30),
    "QQQVGA": (7, 80, 60),
    "QQVGA": (0, 160, 120),
    "QVGA": (1, 320, 240),
    "VGA": (2, 640, 480),
    "4VGA": (3, 1280, 960),
    "16VGA": (4, 2560, 1920),
}
"""Name of a resolution -> NAOqi's number, width and height in pixels."""
SIZES = {number: (width, height) for number, width, height in RESOLUTIONS.values()}
"""NAOqi's number of a resolution -> width and height in pixels."""


def camera_number(value: Any) -> int | None:
    """NAOqi's number of a camera that an event tells by number or by name; None if there is no such camera."""
    if isinstance(value, str):
        return next((number for number, name in CAMERA_NAMES.items() if name == value), None)
    return int(value) if value in CAMERA_NAMES else None


FILE = "head.json"


@dataclass(frozen=True)
class CameraMount:
    """A camera on the head."""

    ahead: float  # of the head's pitch axis, m, the head level
    above: float  # that axis, m
    down: float  # angle below the head's X axis that it looks at, rad


@dataclass(frozen=True)
class Head:
    height: float  # of the pitch axis above the torso's origin, m
    cameras: dict[str, CameraMount]


@lru_cache(maxsize=None)
def load_head() -> Head:
    content = json.loads(config_file(FILE).read_text(encoding="utf-8"))
    cameras = {name: CameraMount(**mount) for name, mount in content["cameras"].items()}
    return Head(content["height"], cameras)


def look_at(head: Head, camera: CameraMount, point: tuple[float, float, float]) -> tuple[float, float]:
    """Head angles that bring a point into the middle of a camera's picture.

    `point`: in the torso frame, m. Returns HeadYaw and HeadPitch, rad. Raises ValueError if the point is in the head.
    """
    x, y, z = point
    ahead, above = math.hypot(x, y), z - head.height
    distance = math.hypot(ahead, above)
    # How far the line of sight passes above the pitch axis, whatever the pitch.
    offset = camera.above * math.cos(camera.down) + camera.ahead * math.sin(camera.down)
    if distance <= abs(offset):
        raise ValueError(f"{distance:.3f} m from the neck is inside the head")
    yaw = math.atan2(y, x) if ahead > 0.0 else 0.0
    return yaw, math.asin(offset / distance) - math.atan2(above, ahead) - camera.down


HOME = "/home/nao"
"""Home of the robot's user, where relative names begin. The simulator keeps it in its `record_dir`."""
WRITTEN = (HOME, "/tmp")
"""Where programs leave files."""
READ = (*WRITTEN, "/usr/share/naoqi", "/opt/aldebaran/share/naoqi", "/opt/naoqi/share/naoqi", "/opt/naoqi/data")
"""Where they find some: the last four have the sounds of the robot, up to V5, on V6 and in the first versions."""
_HOME_SIGN = re.compile(r"\A~(nao)?(?=/|\Z)")
_OTHER_HOME = re.compile(r"\A(/data|/var/persistent)(?=/home/nao(/|\Z))")
"""The partition with the home: on V6 and before."""


def without_sign(name: str) -> str:
    """A path that does not begin with "~": programs of the robot take it for the name of a folder."""
    return _HOME_SIGN.sub(HOME, name)


def full_path(name: str) -> str:
    """A path from the root on, without "~", "." and "..", in the home by the name that is the same on all robots."""
    full = posixpath.normpath(posixpath.join(HOME, without_sign(name)))
    return _OTHER_HOME.sub("", "/" + full.lstrip("/"))


def is_in(name: str, folders: Iterable[str]) -> bool:
    """Whether a path leads into one of the folders, whatever it has of ".."."""
    return any(full_path(name).startswith(f"{folder}/") for folder in folders)
