"""Notices falls before they end, and makes them gentle: arms out of the way of harm, then no stiffness.

What counts is where the capture point is: a body whose capture point has left the soles cannot be stopped by pressing
the feet on the ground. Only a robot that has stood on stiff legs can fall: one that lies, is limp or is getting up
cannot.
"""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass
from typing import Mapping, Tuple

from nao_sim_bridge.base.config import check_keys, config_file, read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.capture_point import BodyMotion
from nao_sim_bridge.control.balance.posture_recognition import lean_of
from nao_sim_bridge.control.balance.stance import StanceReader
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.model.body_mass import Point, convex_hull, outside
from nao_sim_bridge.model.robot_model import RobotModel

FILE = "fall_manager.json"
# A capture point between the ankles and no more than this behind or ahead of either, m, is over the soles or between
# them: no need to work out their outlines.
BEHIND, AHEAD = 0.03, 0.06
INSIDE = (-1.0, (0.0, 0.0))
PROTECTED = ("front", "back", "side")


class FallState(enum.Enum):
    """What the fall manager is at."""

    RESTING = "not on stiff legs: nothing to watch"
    WATCHING = "on its feet"
    FALLING = "a fall has been noticed and goes on"
    FALLEN = "a fall is over, and the robot has not stood since"


@dataclass(frozen=True)
class FallSettings:
    """All of `fall_manager.json`; see its notes."""

    outside: float
    confirm_time: float
    near_ground: float
    armed_after: float
    let_go_lean: float
    let_go_time: float
    lying_turn: float
    lying_time: float
    lying_latest: float
    walking_off: float
    walking_lean: float
    arm_speed: float
    protect: Mapping[str, Mapping[str, float]]


def load_fall_settings(model: RobotModel) -> FallSettings:
    """The settings for a robot.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown or missing.
    """
    numbers = ["outside_m", "confirm_s", "near_ground_m", "armed_after_s", "arm_speed_rad_s"]
    groups = ["walking", "let_go", "lying", "protect"]
    content = check_keys(read_json(config_file(FILE)), FILE, [*numbers, *groups], ["_meta"])
    walking = check_keys(content["walking"], f"{FILE}: walking", ["off_m", "lean_rad"])
    let_go = check_keys(content["let_go"], f"{FILE}: let_go", ["lean_rad", "time_s"])
    lying = check_keys(content["lying"], f"{FILE}: lying", ["turn_rad_s", "time_s", "latest_s"])
    protect = check_keys(content["protect"], f"{FILE}: protect", PROTECTED)
    for where, pose in protect.items():
        for joint in pose:
            if joint not in model.joint_index:
                raise ConfigError(f"{FILE}: protect.{where}", f"no joint {joint!r}")
    return FallSettings(
        outside=content["outside_m"],
        confirm_time=content["confirm_s"],
        near_ground=content["near_ground_m"],
        armed_after=content["armed_after_s"],
        let_go_lean=let_go["lean_rad"],
        let_go_time=let_go["time_s"],
        lying_turn=lying["turn_rad_s"],
        lying_time=lying["time_s"],
        lying_latest=lying["latest_s"],
        walking_off=walking["off_m"],
        walking_lean=walking["lean_rad"],
        arm_speed=content["arm_speed_rad_s"],
        protect=protect,
    )


class FallManager:
    """Watches one robot, whose motion ends when it falls but for its arms; see the module.

    Attributes:
        state: What it is at.
        direction: Unit vector of the last fall in the level frame (X where the torso heads).
    """

    def __init__(self, model: RobotModel, settings: FallSettings, reader: StanceReader, motion: MotionEngine) -> None:
        self.state = FallState.RESTING
        self.direction: Point = (0.0, 0.0)
        self._model = model
        self._settings = settings
        self._reader = reader
        self._motion = motion
        self._enabled = True
        self._on_feet_since: float | None = None
        self._outside_since: float | None = None
        self._noticed = 0.0
        self._turning_until = 0.0
        self._let_go = False

    @property
    def enabled(self) -> bool:
        """Whether it watches at all; one that is switched off drops the fall it is at."""
        return self._enabled

    @enabled.setter
    def enabled(self, value: bool) -> None:
        self._enabled = value
        if not value:
            self.state = FallState.RESTING
        self._on_feet_since = None

    @property
    def falling(self) -> bool:
        return self.state is FallState.FALLING

    def rest(self) -> None:
        """The robot is limp, lies or gets up: no fall can begin."""
        self._on_feet_since = self._outside_since = None
        if self.state is FallState.WATCHING:
            self.state = FallState.RESTING

    def end(self) -> None:
        """Somebody takes over: a fall that goes on is over."""
        if self.falling:
            self.state = FallState.FALLEN

    def note_feet(self, on_feet: bool, now: float) -> None:
        """Tell it whether the robot is upright with its weight on its feet; begins to watch when it has been so."""
        if not on_feet or not self._enabled:
            self._on_feet_since = None
        elif self._on_feet_since is None:
            self._on_feet_since = now
        elif not self.falling and now - self._on_feet_since >= self._settings.armed_after:
            self.state = FallState.WATCHING

    def look(self, body: BodyMotion, snapshot: Snapshot, loaded: Tuple[bool, bool]) -> None:
        """Look whether the robot that it watches begins to fall; `loaded`: whether left and right foot carry."""
        if self.state is not FallState.WATCHING:
            return
        distance, way = self._outside(body, snapshot, loaded)
        if distance < self._settings.outside:
            self._outside_since = None
        elif self._outside_since is None:
            self._outside_since = snapshot.age
        elif snapshot.age - self._outside_since >= self._settings.confirm_time:
            self._begin(way, snapshot.age)

    def look_at_walk(self, off: Tuple[float, float], snapshot: Snapshot) -> None:
        """Look whether a robot that walks begins to fall: its feet go where the body goes, up to a point.

        Args:
            off: How far ahead and to the left of where it should be the body is heading, m.
        """
        if self.state is not FallState.WATCHING:
            return
        settings = self._settings
        roll, pitch, _ = snapshot.imu.angles
        if math.hypot(*off) > settings.walking_off:
            size = math.hypot(*off)
            self._begin((off[0] / size, off[1] / size), snapshot.age)
        elif lean_of(roll, pitch) > settings.walking_lean:
            self._begin(_downhill(roll, pitch), snapshot.age)

    def go_on(self, snapshot: Snapshot) -> None:
        """Advance a fall that goes on: let go before the impact, and tell when the robot lies."""
        settings, now = self._settings, snapshot.age
        roll, pitch, _ = snapshot.imu.angles
        lean = lean_of(roll, pitch)
        elapsed = now - self._noticed
        if not self._let_go and (lean >= settings.let_go_lean or elapsed >= settings.let_go_time):
            self._let_go = True
            self._motion.kill_all()
            self._motion.set_stiffness_now(dict.fromkeys(range(len(self._model.joints)), 0.0))
        if math.hypot(*snapshot.imu.gyroscope) > settings.lying_turn or not self._let_go:
            self._turning_until = now
        if now - self._turning_until >= settings.lying_time or elapsed >= settings.lying_latest:
            self.state = FallState.FALLEN
            self._on_feet_since = None

    def _outside(self, body: BodyMotion, snapshot: Snapshot, loaded: Tuple[bool, bool]) -> tuple[float, Point]:
        """How far the capture point is outside the soles that carry or could carry at once, m, and which way."""
        x, y = body.capture_point
        left, right = body.stance.left_ankle, body.stance.right_ankle
        roll, pitch, _ = snapshot.imu.angles
        if not any(loaded):
            if snapshot.contacts and lean_of(roll, pitch) > self._settings.let_go_lean:
                return (math.inf, _downhill(roll, pitch))  # knocked off its feet, it lies already
            return INSIDE  # lifted up: whoever holds it must not let it fall
        if all(loaded) and right[1] < y < left[1]:
            if max(left[0], right[0]) - BEHIND < x < min(left[0], right[0]) + AHEAD:
                return INSIDE
        soles = [self._reader.sole(side, snapshot.positions, roll, pitch) for side in (0, 1)]
        heights = [min(corner[2] for corner in sole) for sole in soles]
        ground = min(height for height, carries in zip(heights, loaded) if carries)
        reach = ground + self._settings.near_ground
        corners = [c[:2] for sole, h, carries in zip(soles, heights, loaded) if carries or h < reach for c in sole]
        return outside(convex_hull(corners), (x, y))

    def _begin(self, way: Point, now: float) -> None:
        self.state = FallState.FALLING
        self.direction = way
        self._noticed = self._turning_until = now
        self._let_go = False
        self._outside_since = self._on_feet_since = None
        self._motion.kill_all()
        pose = self._protective_pose(way)
        self._motion.set_targets(pose, dict.fromkeys(pose, self._settings.arm_speed))

    def _protective_pose(self, way: Point) -> dict[int, float]:
        """Joint index to angle in rad for a fall that way."""
        x, y = way
        if abs(y) > abs(x):
            angles = self._of_side("L" if y > 0.0 else "R", self._settings.protect["side"])
        else:
            pose = self._settings.protect["front" if x > 0.0 else "back"]
            angles = {**self._of_side("L", pose), **self._of_side("R", pose)}
        return {self._model.joint_index[name]: angle for name, angle in angles.items()}

    @staticmethod
    def _of_side(side: str, pose: Mapping[str, float]) -> dict[str, float]:
        """The pose of the left arm, mirrored for the right one; joints of the head stay as they are."""
        if side == "L":
            return dict(pose)
        return {_mirrored(name): angle if name.endswith("Pitch") else -angle for name, angle in pose.items()}


def _downhill(roll: float, pitch: float) -> Point:
    """Where the top of the torso leans to, in the level frame."""
    return (math.sin(pitch), -math.sin(roll))


def _mirrored(name: str) -> str:
    return f"R{name[1:]}" if name.startswith("L") else name
