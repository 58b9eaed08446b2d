"""The process modules of a NAO: manipulation, navigation, speech, lights and vision, as clients of its servers.

Manipulation uses the action `joint_trajectory` of nao_controller; navigation the action `walk_target` of
nao_path_follower; speech the topic `speech` and the action `speech_action` of nao_speech; lights and vision the
actions of NaoLights and NaoVision.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import rospy
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import (
    JointTrajectoryAction,
    JointTrajectoryGoal,
    NaoLedAction,
    NaoLedGoal,
    NaoVisionAction,
    NaoVisionGoal,
    SpeechWithFeedbackAction,
    SpeechWithFeedbackGoal,
)
from nao_library_msgs.msg import LedFunction, VisionFunction

from ..core.errors import of_those
from ..core.geometry import ODOM, Place, wrapped, yaw_of_quaternion
from .designators.objects_and_locations import TORSO, Point3, head_angles
from .designators.rules import Command
from .failures import (
    GripperClosedCompletely,
    GripperGoalNotReached,
    LightsLowLevelFailure,
    LowLevelFailure,
    ManipulationGoalNotReached,
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    NavigationPoseUnreachable,
    PerceptionLowLevelFailure,
    PerceptionObjectNotFound,
    PlanError,
    PtuGoalNotReached,
    PtuGoalUnreachable,
    SpeechLowLevelFailure,
)
from .fluents import Fluent
from .process_module import AsynchronousProcessModule
from .robot_link import Chain, RobotLink


class RobotModule(AsynchronousProcessModule):
    """A module whose commands are functions; one more is one key-value pair in `commands`.

    `methods`: those of its methods that are commands from the beginning.
    """

    methods: tuple[str, ...] = ()

    def __init__(self, robot: RobotLink, name: str = "") -> None:
        super().__init__(name)
        self.robot = robot
        self.clock = robot.clock
        self.commands: dict[str, Callable[..., Any]] = {each: getattr(self, each) for each in self.methods}

    def execute(self, command: Command) -> Any:
        function = self.commands.get(command.name)
        if function is None:
            known = of_those(command.name, sorted(self.commands))
            raise PlanError(f"the process module {self.name} knows no command {command.name!r}{known}")
        try:
            inspect.signature(function).bind(**command.arguments)
        except TypeError as error:
            raise PlanError(f"{command}: {error}") from error
        return function(**command.arguments)

    def resources(self, command: Command) -> frozenset[str]:
        """One command at a time, unless a module knows better."""
        return frozenset({self.name})


# --- manipulation -----------------------------------------------------------------------------------------------------

TRAJECTORY_ACTION = "joint_trajectory"
MOTION_MARGIN = 5.0
"""s that a motion may take longer than it says."""
SIDES = {"left": "L", "right": "R"}
HEAD = ("HeadYaw", "HeadPitch")
JOINT_TOLERANCE = 0.3
"""rad that a joint may be off where it was to go: soles that stick to the ground hold legs by 0.1 rad after a walk."""
LIMP = "a limp robot moves nothing, `wake_up` or NaoMotion's wakeUp stiffens it"
STIRRED = 0.02
"""A hand that has moved by less, of its way from closed to open, has not moved."""


class Grip(float):
    """Opening of a closed hand, 0..1, and whether it holds something."""

    def __new__(cls, opening: float, holds: bool) -> Grip:
        grip = super().__new__(cls, opening)
        grip.holds = holds
        return grip

    holds: bool

    def as_json(self) -> dict[str, float | bool]:
        return {"opening": float(self), "holds": self.holds}

    def __str__(self) -> str:
        return f"{float(self):.2f} open, {'holds something' if self.holds else 'empty'}"


class Manipulation(RobotModule):
    """Moves arms to points, turns the head, opens and closes hands, and takes the stable pose.

    Motions of different limbs run at the same time.
    """

    name = "manipulation"
    methods = (
        "open_gripper",
        "close_gripper",
        "move_gripper",
        "move_head",
        "turn_head",
        "move_arm",
        "point_at",
        "move_joints",
        "go_stable",
    )

    def resources(self, command: Command) -> frozenset[str]:
        """The limbs that a command moves."""
        side = str(command.arguments.get("side", ""))
        arms = {f"{side} arm"} if side else {f"{each} arm" for each in SIDES}
        limbs = {"gripper": {f"{side} hand"}, "head": {"head"}, "arm": arms, "at": arms}
        needed = limbs.get(command.name.rpartition("_")[2])
        everything = {"head", *(f"{each} {limb}" for each in SIDES for limb in ("hand", "arm")), "legs"}
        return frozenset(needed or everything)

    # --- hands --------------------------------------------------------------------------------------------------------

    def open_gripper(self, side: str) -> float:
        """Open a hand; returns its opening, 0..1. Raises GripperGoalNotReached if it does not open."""
        return self.move_gripper(side, self.robot.settings.gripper["open"])

    def close_gripper(self, side: str, grasp: bool = False) -> Grip:
        """Close a hand, around something or not; returns its opening, 0..1, and whether it holds something.

        Raises GripperClosedCompletely with `grasp`: there is nothing in it; GripperGoalNotReached: it does not move.
        """
        settings = self.robot.settings
        closed, tolerance = settings.gripper["closed"], settings.gripper_tolerance
        before = self.robot.angles()[f"{_letter(side)}Hand"]
        opening = self._gripper(side, closed)
        holds = abs(opening - closed) >= tolerance
        if grasp and not holds:
            raise GripperClosedCompletely(f"the {side} hand closed, and there is nothing in it", side=side)
        held = self.robot.held.get(side)
        if holds and abs(before - opening) < STIRRED and (held is None or abs(held - opening) >= tolerance):
            raise self._not_reached(side, opening, closed)  # a hand without power
        self.robot.held[side] = opening if holds else closed
        return Grip(opening, holds)

    def move_gripper(self, side: str, opening: float) -> float:
        """Move a hand to an opening, 0..1; returns the opening that it reached.

        Raises GripperGoalNotReached if it does not get there.
        """
        reached = self._gripper(side, opening)
        if abs(reached - opening) >= self.robot.settings.gripper_tolerance:
            raise self._not_reached(side, reached, opening)
        return reached

    def gripper_goal(self, side: str, word: str) -> JointTrajectoryGoal:
        """What the controller gets to open a hand or to close it. `word`: "open" or "closed"."""
        settings = self.robot.settings
        return _trajectory_goal({f"{_letter(side)}Hand": settings.gripper[word]}, settings.gripper_time)

    def _gripper(self, side: str, opening: float) -> float:
        joint = f"{_letter(side)}Hand"
        if opening != self.robot.settings.gripper["closed"]:
            self.robot.held.pop(side, None)
        return self._move({joint: float(opening)}, self.robot.settings.gripper_time, GripperGoalNotReached)[joint]

    @staticmethod
    def _not_reached(side: str, reached: float, wanted: float) -> GripperGoalNotReached:
        text = f"the {side} hand is {reached:.2f} open instead of {wanted:.2f}: {LIMP}"
        return GripperGoalNotReached(text, side=side, reached=reached, wanted=wanted)

    # --- head ---------------------------------------------------------------------------------------------------------

    def move_head(self, target: Point3) -> tuple[float, float]:
        """Look at a point with the top camera; returns HeadYaw and HeadPitch, rad.

        Raises:
            PtuGoalUnreachable: The head does not turn that far; `nearest` has the closest angles.
            PtuGoalNotReached: It did not get there.
        """
        return self.turn_head(*self._gaze(target))

    def head_goal(self, target: Point3) -> JointTrajectoryGoal:
        """What the controller gets to look at a point. Raises PtuGoalUnreachable as `move_head`."""
        angles = self._head(*self._gaze(target))
        return _trajectory_goal(angles, self._time(angles, self.robot.settings.head_speed))

    def turn_head(self, yaw: float, pitch: float) -> tuple[float, float]:
        """Turn the head to two angles, rad; returns the angles that it reached. Raises as `move_head`."""
        settings, goal = self.robot.settings, self._head(yaw, pitch)
        nearest = tuple(goal.values())
        reached = self._move(goal, self._time(goal, settings.head_speed), PtuGoalNotReached)
        got = (reached[HEAD[0]], reached[HEAD[1]])
        if max(abs(a - b) for a, b in zip(got, nearest)) > settings.head_tolerance:
            text = f"the head is at {_angles(got)} instead of {_angles(nearest)}: {LIMP}"
            raise PtuGoalNotReached(text, wanted=nearest, reached=got)
        return got

    def _gaze(self, target: Point3) -> tuple[float, float]:
        point = self.robot.point_in(target, TORSO)
        camera = [self.robot.settings.camera[key] for key in ("forward", "up", "neck", "tilt")]
        return head_angles(*point[:3], camera)

    def _head(self, yaw: float, pitch: float) -> dict[str, float]:
        chain, wanted = self.robot.chain(TORSO, "Head"), (float(yaw), float(pitch))
        nearest = tuple(min(max(each, low), high) for each, low, high in zip(wanted, chain.lower, chain.upper))
        if max(abs(a - b) for a, b in zip(wanted, nearest)) > self.robot.settings.head_tolerance:
            text = f"the head cannot turn to yaw {yaw:.2f}, pitch {pitch:.2f} rad: the nearest is {_angles(nearest)}"
            raise PtuGoalUnreachable(text, wanted=wanted, nearest=nearest)
        return dict(zip(HEAD, map(float, nearest)))

    # --- arms ---------------------------------------------------------------------------------------------------------

    def move_arm(self, target: Point3, side: str) -> Point3:
        """Bring a hand to a point; returns where it is then, in the torso frame.

        Raises:
            ManipulationPoseUnreachable: The arm is too short; `nearest` is the point that it can reach, in the frame
                of the target.
            ManipulationGoalNotReached: It did not get there.
        """
        settings, now = self.robot.settings, self.robot.angles()
        point, angles = self.robot.point_in(target, TORSO), self._arm(target, side)
        reached = self._move(angles, self._time(angles, settings.arm_speed), ManipulationGoalNotReached)
        x, y, z = map(float, self._arm_chain(side).tip({**now, **reached})[:3, 3])
        hand = Point3(x, y, z, TORSO)
        if hand.distance_to(point) > settings.arm_tolerance:
            text = f"the {side} hand is at {hand} instead of {point}: {LIMP}"
            raise ManipulationGoalNotReached(text, target=target, reached=hand, side=side)
        return hand

    def arm_goal(self, target: Point3, side: str) -> JointTrajectoryGoal:
        """What the controller gets to bring a hand to a point. Raises ManipulationPoseUnreachable as `move_arm`."""
        angles = self._arm(target, side)
        return _trajectory_goal(angles, self._time(angles, self.robot.settings.arm_speed))

    def _arm_chain(self, side: str) -> Chain:
        return self.robot.chain(TORSO, f"{_letter(side).lower()}_gripper")

    def _arm(self, target: Point3, side: str) -> dict[str, float]:
        found = self._arm_chain(side).reach(self.robot.point_in(target, TORSO)[:3], self.robot.angles())
        if found.distance > self.robot.settings.arm_tolerance / 2.0:
            nearest = self.robot.point_in(Point3(*found.point, TORSO), target.frame)
            raise ManipulationPoseUnreachable(
                f"the {side} hand cannot get to {target}: the nearest point is {nearest}, {found.distance:.3f} m away",
                target=target,
                nearest=nearest,
                distance=found.distance,
                side=side,
            )
        return found.angles

    def point_at(self, target: Point3, side: str = "") -> Point3:
        """Point at something with the nearer arm, or that of a side; returns where the hand is then."""
        point = self.robot.point_in(target, TORSO)
        side = side or ("left" if point.y >= 0.0 else "right")
        _, y, z = self.robot.settings.shoulder
        shoulder = Point3(0.0, y if _letter(side) == "L" else -y, z, TORSO)
        away = max(shoulder.distance_to(point), 1e-6)
        share = self.robot.settings.pointing_reach / away
        hand = Point3(*(a + share * (b - a) for a, b in zip(shoulder[:3], point[:3])), TORSO)
        return self.move_arm(hand, side)

    # --- joints -------------------------------------------------------------------------------------------------------

    def move_joints(self, angles: Mapping[str, float], time: float = 0.0) -> Mapping[str, float]:
        """Move joints to angles, rad by name, in `time` s (0: by the arms' speed); returns the reached angles.

        Raises ManipulationGoalNotReached if they did not get there.
        """
        wanted = {name: float(angle) for name, angle in angles.items()}
        return self._move_all(wanted, time or self._time(wanted, self.robot.settings.arm_speed))

    def go_stable(self) -> Mapping[str, float]:
        """Take the pose from which everything else can begin; returns the angles, rad by name.

        Raises ManipulationGoalNotReached if the joints did not get there.
        """
        settings = self.robot.settings
        return self._move_all(dict(settings.stable), settings.stable_time)

    def _move_all(self, wanted: Mapping[str, float], time: float) -> Mapping[str, float]:
        reached = self._move(wanted, time, ManipulationGoalNotReached)
        # A hand stays open as far as there is something in it.
        off = {
            name: f"{name} is at {reached[name]:.2f} instead of {angle:.2f} rad"
            for name, angle in wanted.items()
            if not name.endswith("Hand") and abs(reached[name] - angle) > JOINT_TOLERANCE
        }
        if off:
            text = f"{', '.join(list(off.values())[:3])}{' and more' if len(off) > 3 else ''}: {LIMP}"
            raise ManipulationGoalNotReached(text, wanted=wanted, reached=reached)
        return reached

    def stable_goal(self) -> JointTrajectoryGoal:
        """What the controller gets to take that pose."""
        return _trajectory_goal(dict(self.robot.settings.stable), self.robot.settings.stable_time)

    def _time(self, goal: Mapping[str, float], speed: float) -> float:
        now = self.robot.angles()
        unknown = [name for name in goal if name not in now]
        if unknown:
            raise PlanError(f"no joint {', '.join(unknown)}{of_those(unknown[0], now)}")
        way = max(abs(angle - now[name]) for name, angle in goal.items())
        return max(way / speed, self.robot.settings.shortest_motion)

    def _move(self, angles: Mapping[str, float], time: float, failure: type[LowLevelFailure]) -> dict[str, float]:
        end = self.robot.action(TRAJECTORY_ACTION, JointTrajectoryAction).call(
            _trajectory_goal(angles, time), time + MOTION_MARGIN
        )
        if not end.succeeded:
            raise failure(f"{', '.join(angles) if len(angles) < 7 else 'the body'}: {end}", status=end.status)
        state = end.result.goal_position
        self.robot.learn(state)
        return dict(zip(state.name, state.position))


def _trajectory_goal(angles: Mapping[str, float], time: float) -> JointTrajectoryGoal:
    point = JointTrajectoryPoint(positions=list(angles.values()), time_from_start=rospy.Duration.from_sec(time))
    return JointTrajectoryGoal(trajectory=JointTrajectory(joint_names=list(angles), points=[point]))


def _letter(side: str) -> str:
    if side not in SIDES:
        raise PlanError(f"side is {side!r}: left or right")
    return SIDES[side]


def _angles(pair: Sequence[float]) -> str:
    return f"yaw {pair[0]:.2f}, pitch {pair[1]:.2f} rad"


# --- navigation -------------------------------------------------------------------------------------------------------

WALK_ACTION = "walk_target"
WALK_MARGIN = 20.0
"""s that a walk may take longer than the slowest one."""


class Navigation(RobotModule):
    """Walks to places; `position` is a fluent with the (Place, frame) of the last feedback of a walk."""

    name = "navigation"
    methods = ("walk_to",)

    def __init__(self, robot: RobotLink, name: str = "") -> None:
        super().__init__(robot, name)
        self.position = Fluent("position on the way", None)

    def walk_to(self, target: Place, frame: str = ODOM) -> Place:
        """Walk to a place; returns where the robot is then, in odom. A heading of nan stands for that of the way there.

        Raises:
            NavigationPoseUnreachable: The goal was refused.
            NavigationGoalNotReached: The robot did not get there; `reached` is where it is, `wanted` where it was to
                be, in odom.
        """
        settings = self.robot.settings
        here, target = self.robot.place(frame), self._with_heading(target, frame)
        # The robot's own frames move along: what counts at the end is where the target was at the beginning.
        wanted = self.robot.place(ODOM).then(target.seen_from(here))
        way = target.seen_from(here)
        slowest = way.distance / settings.walk_speed[0] + math.pi / settings.walk_speed[1]
        goal = self.walk_goal(target, frame)
        end = self.robot.action(WALK_ACTION, MoveBaseAction).call(goal, slowest + WALK_MARGIN, self._on_feedback)
        reached = self.robot.place(ODOM)
        if end.status == GoalStatus.REJECTED:
            raise NavigationPoseUnreachable(f"{_shown(target, frame)}: {end}", target=target, frame=frame)
        off, turn = reached.distance_to(wanted), abs(wrapped(reached.yaw - wanted.yaw))
        if not end.succeeded or off > 2.0 * settings.walk_tolerance[0] or turn > 2.0 * settings.walk_tolerance[1]:
            why = str(end) if not end.succeeded else f"it is {off:.3f} m and {turn:.2f} rad off"
            text = f"the robot did not get to {_shown(target, frame)}: {why}"
            raise NavigationGoalNotReached(text, target=target, frame=frame, reached=reached, wanted=wanted)
        return reached

    def walk_goal(self, target: Place, frame: str = ODOM) -> MoveBaseGoal:
        """What the path follower gets to walk to a place, as `walk_to` takes it."""
        target, goal = self._with_heading(target, frame), MoveBaseGoal()
        goal.target_pose.header.frame_id = frame
        goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = target.x, target.y
        goal.target_pose.pose.orientation.z = math.sin(target.yaw / 2.0)
        goal.target_pose.pose.orientation.w = math.cos(target.yaw / 2.0)
        return goal

    def _with_heading(self, target: Place, frame: str) -> Place:
        if not math.isnan(target.yaw):
            return target
        here = self.robot.place(frame)
        far = here.distance_to(target) > self.robot.settings.walk_tolerance[0]  # a robot that is there need not turn
        return target._replace(yaw=math.atan2(target.y - here.y, target.x - here.x) if far else here.yaw)

    def _on_feedback(self, feedback: Any) -> None:
        stamped = feedback.base_position
        turn = stamped.pose.orientation
        yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w) or 0.0
        place = Place(stamped.pose.position.x, stamped.pose.position.y, yaw)
        self.position.value = (place, stamped.header.frame_id)


def _shown(place: Place, frame: str) -> str:
    return f"x {place.x:.2f} m, y {place.y:.2f} m, {place.yaw:.2f} rad in {frame}"


# --- speech -----------------------------------------------------------------------------------------------------------

SPEECH_TOPIC = "speech"
SPEECH_ACTION = "speech_action"
LISTENER_LIMIT = 10.0
"""s to wait for a node that speaks."""
LONGEST_SPEECH = 120.0
"""s that a text may take."""


class Speech(RobotModule):
    """Says texts."""

    name = "speech"
    methods = ("say", "text_to_speech")

    def text_to_speech(self, text: str) -> None:
        """Say a text without waiting for its end; SpeechLowLevelFailure if there is no subscriber."""
        if not self.robot.topic(SPEECH_TOPIC, String).tell(String(text), LISTENER_LIMIT):
            where = rospy.resolve_name(SPEECH_TOPIC)
            raise SpeechLowLevelFailure(f"nobody speaks what comes on {where}: is nao_speech running?")

    def say(self, text: str) -> None:
        """Say a text and wait for its end; a cancel silences it."""
        end = self.robot.action(SPEECH_ACTION, SpeechWithFeedbackAction).call(
            SpeechWithFeedbackGoal(say=text), LONGEST_SPEECH
        )
        if not end.succeeded:
            raise SpeechLowLevelFailure(f"{text!r} was not said: {end}", text=text)


# --- lights -----------------------------------------------------------------------------------------------------------

LIGHTS_ACTION = "NaoLights"
LONGEST_LIGHTS = 60.0
FACE = "FaceLeds"


class Lights(RobotModule):
    """Changes the colour and the brightness of lights."""

    name = "lights"
    methods = ("set_color", "set_intensity")

    def set_color(self, color: str, lights: Sequence[str] = (FACE,), time: float = 0.0, revert: bool = False) -> None:
        """Give lights a colour, by name or #RRGGBB; wait `time` s, then restore the former one with `revert`.

        Raises LightsLowLevelFailure if there is no such light or colour, or it failed.
        """
        self._run(LedFunction(function="setColor", lights=list(lights), str_param=color, revert=revert), time)

    def set_intensity(
        self, intensity: float, lights: Sequence[str] = (FACE,), time: float = 0.0, revert: bool = False
    ) -> None:
        """Give lights a brightness, 0..1; the rest as for `set_color`."""
        self._run(LedFunction(function="setIntensity", lights=list(lights), i_values=[intensity], revert=revert), time)

    def _run(self, function: LedFunction, time: float) -> None:
        function.time = rospy.Duration.from_sec(time)
        end = self.robot.action(LIGHTS_ACTION, NaoLedAction).call(NaoLedGoal([function]), time + LONGEST_LIGHTS)
        if not end.succeeded:
            raise LightsLowLevelFailure(f"{function.function}: {end}")


# --- vision -----------------------------------------------------------------------------------------------------------

VISION_ACTION = "NaoVision"
VISION_MARGIN = 10.0
"""s that the server may take beyond what it was given to look."""
NOT_CHOSEN = ("", "bottom")
"""Cameras to look with, one after the other, where none is named; empty: the active one."""
DETECTORS = {
    "ball": "detectBall",
    "face": "detectFaces",
    "person": "detectFaces",
    "landmark": "detectLandmarks",
    "code": "readBarcodes",
}
"""What is detected, by the type of an object."""


@dataclass(frozen=True)
class SeenThing:
    """Something that was seen."""

    type: str
    name: str  # of a face, a landmark's number, a code's text; empty if unknown
    position: Point3 | None  # in odom; None if only the direction is known
    time: float  # s of ROS time
    confidence: float
    alpha: float  # rad, positive to the left of the camera's axis
    beta: float  # rad, positive below it


class Vision(RobotModule):
    """Looks for things."""

    name = "vision"
    methods = ("detect",)

    def detect(
        self, type: str, name: str = "", timeout: float = 2.0, search: bool = False, camera: str = "", size: float = 0.0
    ) -> list[SeenThing]:
        """Look for things of a type in `DETECTORS` for `timeout` s; returns those seen.

        Raises PerceptionObjectNotFound: nothing was seen in time; PerceptionLowLevelFailure: looking failed.

        Args:
            name: Only that one: a face's name, a landmark's number, a code's text.
            search: Whether the head turns to find them.
            camera: top or bottom; empty: the active one (top at first), and then the bottom one, as long again: a robot
                that has walked looks straight ahead, and what lies before it is in the picture of that one alone.
            size: Of the real thing, m; 0 for what is usual.
        """
        if type not in DETECTORS:
            raise PerceptionLowLevelFailure(f"there is no detector for {type!r}{of_those(type, DETECTORS)}")
        kind = "face" if type == "person" else type
        function, wanted = ("lookFor", f"{kind} {name}".strip()) if search else (DETECTORS[type], name)
        cameras = (camera,) if camera else NOT_CHOSEN
        for each in cameras:
            look = VisionFunction(function=function, str_param=wanted, camera=each, size=size, timeout=timeout)
            end = self.robot.action(VISION_ACTION, NaoVisionAction).call(NaoVisionGoal([look]), timeout + VISION_MARGIN)
            if not end.succeeded:
                raise PerceptionLowLevelFailure(f"{function}: {end}")
            if end.result.objects:
                return [self._seen(thing) for thing in end.result.objects]
        looked = ", nor ".join(f"in {timeout:g} s by the {each or 'active'} camera" for each in cameras)
        hint = "" if search else "; with `search` the head turns"
        text = f"no {f'{type} {name}'.strip()} was seen {looked}{hint}"
        raise PerceptionObjectNotFound(text, type=type, name=name)

    def _seen(self, found: Any) -> SeenThing:
        """In odom: the robot's own frame moves."""
        where = found.position
        position = None
        if found.located:
            position = self.robot.point_in(Point3(where.x, where.y, where.z, found.base_frame), ODOM)
        time = found.header.stamp.to_sec()
        return SeenThing(found.kind, found.name, position, time, found.confidence, found.alpha, found.beta)
