"""The functions under the process modules, by name: one call, one thing that the robot does; and goals that they mean.

They may be called in plans, and outside of them. All take the robot of this node's namespace, unless `use_robot` names
another one. A program that is no node yet becomes one. Each is there in the spelling of the thesis as well: algorithms
5.7 to 5.13.

The goals are what the process modules can achieve. These are the same:

    achieve(opened_gripper("left"))
    achieve(open_gripper, "left")
    achieve(openGripper, "left")

For goals the process modules have to run: `run_and_tell` and `start_process_modules` run them. `openGripper("left")`
alone opens the hand without them.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import rospy

from ..core.geometry import ODOM, Place, wrapped
from ..ros.time_and_frames import RosClock
from .action_rules import a_place, a_point, a_position
from .designators.designator import action, an
from .designators.objects_and_locations import Point3, Position
from .designators.rules import Mismatch, numbers_of_nao, taken
from .nao_modules import Grip, Lights, Manipulation, Navigation, Speech, Vision
from .plans import Goal, achieved_by, declare_goal, def_goal, def_top_level_plan
from .process_module import ProcessModule, perform
from .process_module import start_process_modules as start_modules
from .robot_link import RobotLink

CLIENT = "NaoActionClient"
"""Node that a program becomes here, with a number behind it."""
_lock = threading.Lock()
_robots: list[RobotLink] = []


def use_robot(robot: RobotLink) -> RobotLink:
    """Have the functions here act on a robot."""
    with _lock:
        _robots[:] = [robot]
    return robot


def this_robot() -> RobotLink:
    """The robot of `use_robot`, else that of this node's namespace; a program that is no node yet becomes one."""
    with _lock:
        if not _robots:
            if not rospy.core.is_initialized():
                main = threading.current_thread() is threading.main_thread()
                rospy.init_node(CLIENT, anonymous=True, disable_signals=not main)
                RosClock.wait_for_start()
            _robots.append(RobotLink())
        return _robots[0]


def make_process_modules(robot: RobotLink | None = None) -> tuple[ProcessModule, ...]:
    """The process modules of a NAO: manipulation, navigation, speech, lights, vision. They do not run yet."""
    link = robot or this_robot()
    return Manipulation(link), Navigation(link), Speech(link), Lights(link), Vision(link)


def start_process_modules(robot: RobotLink | None = None) -> tuple[ProcessModule, ...]:
    """Run the process modules of a NAO, each in a thread of its own, until `stop_process_modules`."""
    modules = make_process_modules(robot)
    start_modules(*modules)
    return modules


@def_top_level_plan
def open_gripper(side: str) -> float:
    """Open a hand, left or right; answers how far it is open, 0..1."""
    return Manipulation(this_robot()).open_gripper(side)


@def_top_level_plan
def close_gripper(side: str, grasp: bool = False) -> Grip:
    """Close a hand, left or right, around something or not; with `grasp` there has to be something in it.

    Returns how far it is open, 0..1; `holds` says whether there is something in it.
    """
    return Manipulation(this_robot()).close_gripper(side, grasp)


@def_top_level_plan
def move_head(
    x: float | Position | Sequence[float] | str, y: float | None = None, z: float | None = None
) -> tuple[float, float]:
    """Look at a point: x m ahead and y m to the left of the torso, at the height of the eyes or z m over the torso.

    `x` alone: the point, `Position(2, 3)`, or the word of a direction. Returns HeadYaw and HeadPitch, rad.
    """
    head, words = Manipulation(this_robot()), numbers_of_nao().head
    if y is None and isinstance(x, str) and x in words:
        return head.turn_head(*words[x])
    return head.move_head(taken(a_position(), x if y is None else [x, y] if z is None else [x, y, z]))


@def_top_level_plan
def move_arm(target: Point3 | Sequence[float], side: str) -> Point3:
    """Bring a hand to a point, (x, y, z) in m in the torso frame or with the name of a frame behind it.

    Returns where the hand is then, in the torso frame.
    """
    return Manipulation(this_robot()).move_arm(taken(a_point(), target), side)


@def_top_level_plan
def go_stable() -> Mapping[str, float]:
    """Take the pose from which everything else can begin; answers the angles of the joints, rad by name."""
    return Manipulation(this_robot()).go_stable()


@def_top_level_plan
def walk_to(target: Place | Sequence[float]) -> Place:
    """Walk to a place, (x, y, yaw) in m and rad in odom or with the name of a frame behind it.

    Returns where the robot is then, in odom.
    """
    place, frame = taken(a_place(), target)
    return Navigation(this_robot()).walk_to(place, frame)


@def_top_level_plan
def text_to_speech(sentence: str) -> None:
    """Say a sentence, without waiting for its end."""
    Speech(this_robot()).text_to_speech(sentence)


openGripper, closeGripper = open_gripper, close_gripper  # noqa: N816  names of the thesis, here and below
moveHead, moveArm, goStable = move_head, move_arm, go_stable  # noqa: N816
walkTo, textToSpeech = walk_to, text_to_speech  # noqa: N816


# --- goals ------------------------------------------------------------------------------------------------------------


def _there(reached: bool) -> bool | None:
    """True where nothing is to be done; otherwise None, unknown: what achieves the goal fails by itself."""
    return True if reached else None


def _hand_is(word: str, side: str) -> bool | None:
    robot = this_robot()
    opening = robot.angles().get(f"{str(side)[:1].upper()}Hand", math.inf)
    return _there(abs(opening - robot.settings.gripper[word]) < robot.settings.gripper_tolerance)


@declare_goal
def opened_gripper(side: str) -> bool | None:
    """A hand, left or right, is open."""
    return _hand_is("open", side)


@declare_goal
def closed_gripper(side: str) -> bool | None:
    """A hand is closed, around something or not."""
    return _hand_is("closed", side)


@declare_goal
def gripped(side: str) -> None:
    """There is something in a closed hand."""


@declare_goal
def moved_arm(target: Any, side: str) -> None:
    """A hand is at a point."""


@declare_goal
def looking_at(target: Any, y: float | None = None, z: float | None = None) -> None:
    """The head looks at a position, a thing, or in a direction by its word; or at x, y and z."""


@declare_goal
def stable() -> bool | None:
    """The robot is in the pose from which everything else can begin."""
    robot = this_robot()
    now, tolerance = robot.angles(), robot.settings.head_tolerance
    return _there(
        all(abs(now.get(name, math.inf) - angle) < tolerance for name, angle in robot.settings.stable.items())
    )


@declare_goal
def at_place(target: Any) -> bool | None:
    """The robot is at a place."""
    try:
        place, frame = a_place().take(target)
    except Mismatch:
        return None  # a designator
    robot = this_robot()
    here, (near, turn) = robot.place(frame or ODOM), robot.settings.walk_tolerance
    turned_well = math.isnan(place.yaw) or abs(wrapped(here.yaw - place.yaw)) < turn
    return _there(here.distance_to(place) < near and turned_well)


@declare_goal
def said(sentence: str) -> None:
    """A sentence has been said."""


def _by_action(goal: Goal, kind: str, values: Mapping[str, str]) -> Callable[..., Any]:
    """A plan that performs an action; `values` maps its keys to names of the goal's arguments."""

    def plan(*arguments: Any) -> Any:
        given = dict(zip(goal.parameters, arguments))
        return perform(an(action, type=kind, **{key: given[name] for key, name in values.items()}))

    return plan


for _goal, _kind, _values in (
    (opened_gripper, "opening", {"gripper": "side"}),
    (closed_gripper, "closing", {"gripper": "side"}),
    (gripped, "gripping", {"gripper": "side"}),
    (moved_arm, "reaching", {"side": "side", "target": "target"}),
    (stable, "standing", {}),
    (at_place, "going", {"target": "target"}),
):
    def_goal(_goal)(_by_action(_goal, _kind, _values))


@def_goal(said)
def _say(sentence: str) -> Any:
    return perform(an(action, type="saying", text=sentence, wait=True))


@def_goal(looking_at)
def _look(target: Any, y: float | None, z: float | None) -> Any:
    if y is not None:
        target = [target, y] if z is None else [target, y, z]
    return perform(an(action, type="looking", target=target))


turn_head = turnHead = move_head  # noqa: N816

for _function, _goal in (
    (open_gripper, opened_gripper),
    (close_gripper, closed_gripper),
    (move_arm, moved_arm),
    (move_head, looking_at),
    (go_stable, stable),
    (walk_to, at_place),
    (text_to_speech, said),
):
    achieved_by(_function, _goal)
