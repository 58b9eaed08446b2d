"""The functions under the process modules, by name: one call, one thing that the robot does.

They may be called in plans, and outside of them. All take the robot of this node's namespace, unless `use_robot` names
another one. A program that is no node yet becomes one. Each is there in the spelling of the thesis as well: algorithms
5.7 to 5.13.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence

import rospy

from ..base.places import Place
from ..ros.ros_clock import RosClock
from .action_rules.values import a_place, a_point, a_position
from .core.process_module import ProcessModule
from .core.registry import start_process_modules as start_modules
from .designators.patterns import taken
from .language.plans import def_top_level_plan
from .language.settings import numbers_of_nao
from .language.space import Point3, Position
from .modules.lights import Lights
from .modules.manipulation import Grip, Manipulation
from .modules.navigation import Navigation
from .modules.speech import Speech
from .modules.vision import Vision
from .robot.robot_link import RobotLink

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
