"""What is going on when a node is killed, and what a node does that works."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Twist
from goal_functions import audio_in, audio_out, behavior, led, motion, tactile, vision
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Empty, Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import (
    BlinkAction,
    BlinkGoal,
    BodyPoseWithSpeedAction,
    BodyPoseWithSpeedGoal,
    ExecFootstepsAction,
    ExecFootstepsGoal,
    JointTrajectoryAction,
    JointTrajectoryGoal,
    PerformDesignatorAction,
    PerformDesignatorGoal,
    RunBehaviorAction,
    RunBehaviorGoal,
    SpeechWithFeedbackAction,
    SpeechWithFeedbackGoal,
)
from nao_library_modules.core.server_types import server_type
from nao_library_modules.driver.nao_driver import PARTS
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_library_msgs.msg import StepTarget
from nao_library_msgs.srv import (
    GetAudioMasterVolume,
    GetInstalledBehaviors,
    StepTargetService,
    VisionMotionSensitivity,
    WatchMemory,
)
from nao_sim_bridge.testing import wait_until

PATIENCE = 60.0
ANSWER = 2.0
"""s that a node may take for something quick."""
WALK, SPEECH = "Head", "speech"
MICROPHONE = "nao_robot/microphone/naoqi_microphone"
PICTURES = ("cameras", "diagnostics")
"""Parts of the driver that nao_driver.launch has in a process of their own."""
CHARGE = "Device/SubDeviceList/Battery/Charge/Sensor/Value"
SPEECH_WORKER, PICTURE_WORKER = "nao_sim_bridge.speech.worker", "nao_sim_bridge.render.worker"
"""Processes of the simulator, by what they run."""


# --- what goes on -----------------------------------------------------------------------------------------------------


class Nothing:
    """Nothing goes on; the others are like it."""

    def active(self) -> bool:
        """Whether it has begun."""
        return True

    def over(self) -> bool:
        """Whether it has ended, for whoever began it."""
        return True

    def stop(self) -> None:
        """Its user takes it back."""

    def again(self) -> bool:
        """Whether it goes on with a node that was started again."""
        return True


class Goal(Nothing):
    """A goal of actionlib's client, as a program of a user's has it."""

    def __init__(self, name: str, action: type, goal: Any) -> None:
        self.client = _client(name, action)
        if not self.client.wait_for_server(rospy.Duration.from_sec(PATIENCE)):
            raise TimeoutError(f"there is no server {name}")
        self.client.send_goal(goal)

    def active(self) -> bool:
        """Whether the server has taken it up."""
        if self.over():
            raise RuntimeError(f"the goal is over before the kill: {self.client.get_goal_status_text()}")
        return self.client.get_state() == GoalStatus.ACTIVE

    def over(self) -> bool:
        """Whether its end has come."""
        return self.client.simple_state == actionlib.SimpleGoalState.DONE

    def stop(self) -> None:
        """Cancel it."""
        if not self.over():
            self.client.cancel_goal()


class Steered(Nothing):
    """A walk that somebody steers until its node is killed."""

    def __init__(self) -> None:
        self._topic = _topic("cmd_vel", Twist)
        self._ended = threading.Event()
        threading.Thread(target=self._steer, daemon=True).start()

    def _steer(self) -> None:
        command = Twist()
        command.linear.x = 0.7
        while not self._ended.wait(0.1):
            self._topic.publish(command)

    def stop(self) -> None:
        """Send nothing more."""
        self._ended.set()


def process_of(node):
    """Full name of the node that a node, or a part of the driver, is in."""
    words = {name: word for word, (name, _) in PARTS.items()}
    if node not in words:
        return f"/{node}"
    return "/nao_driver_pictures" if words[node] in PICTURES else "/nao_driver"


class Heard(Nothing):
    """A topic that somebody listens to."""

    def __init__(self, node: str, topic: str) -> None:
        self._node = process_of(node)
        self._came = threading.Event()
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._on_message)

    def _on_message(self, message: rospy.AnyMsg) -> None:
        if message._connection_header["callerid"] == self._node:
            self._came.set()

    def active(self) -> bool:
        """Whether something came."""
        return self._came.is_set()

    def again(self) -> bool:
        """Whether something comes now."""
        self._came.clear()
        return self._came.wait(ANSWER)

    def stop(self) -> None:
        """Listen no more."""
        self._subscriber.unregister()


@lru_cache(maxsize=None)
def _client(name: str, action: type) -> SimpleActionClient:
    return SimpleActionClient(name, action)


@lru_cache(maxsize=None)
def _topic(name: str, kind: type) -> rospy.Publisher:
    return rospy.Publisher(name, kind, queue_size=1)


def chain(server: str, function: Any) -> Goal:
    """A function of an action server."""
    types = server_type(server)
    return Goal(server, types.action, types.goal([function]))


def trajectory(seconds: float, angle: float) -> Goal:
    """The head turns."""
    points = [JointTrajectoryPoint(positions=[angle], time_from_start=rospy.Duration.from_sec(seconds))]
    goal = JointTrajectoryGoal(trajectory=JointTrajectory(joint_names=["HeadYaw"], points=points))
    return Goal("joint_trajectory", JointTrajectoryAction, goal)


def place_ahead(way: float) -> PoseStamped:
    """A place before the robot."""
    place = PoseStamped()
    place.header.frame_id = "base_footprint"
    place.pose.position.x, place.pose.orientation.w = way, 1.0
    return place


def walk_target(way: float) -> Goal:
    """A walk ahead by the driver."""
    return Goal("walk_target", MoveBaseAction, MoveBaseGoal(place_ahead(way)))


def rviz_goal() -> Nothing:
    """A walk ahead as RViz asks for it, which tells of no end."""
    topic = _topic("move_base_simple/goal", PoseStamped)
    wait_until(lambda: topic.get_num_connections() > 0, PATIENCE, "naoqi_moveto")
    topic.publish(place_ahead(1.5))
    return Nothing()


def step(leg: int, x: float) -> StepTarget:
    """One step."""
    target = StepTarget(leg=leg)
    target.pose.x, target.pose.y = x, 0.1 if leg == StepTarget.left else -0.1
    return target


def footsteps() -> Goal:
    """Many steps."""
    steps = [step((StepTarget.left, StepTarget.right)[i % 2], 0.04) for i in range(20)]
    return Goal("footsteps_execution", ExecFootstepsAction, ExecFootstepsGoal(steps, 10.0))


def behaviour() -> Goal:
    """A behaviour that walks."""
    text = "help: A walk.\ndo:\n  - NaoMotion.walkTo: {values: [1.5, 0, 0]}\n"
    return chain("NaoBehavior", behavior("runBehavior", text=text))


def new_sentences(count: int = 3) -> str:
    """Sentences whose sound the simulator does not have yet."""
    return " ".join(f"Sentence {next(NUMBERS)}." for _ in range(count))


def say(text: str) -> Goal:
    """Speech by the driver."""
    return Goal("speech_action", SpeechWithFeedbackAction, SpeechWithFeedbackGoal(say=text))


def perform(text: str) -> Goal:
    """A designator."""
    return Goal("perform_designator", PerformDesignatorAction, PerformDesignatorGoal(text, "", []))


def blinks() -> Goal:
    """The eyes blink."""
    red, blue = ColorRGBA(1.0, 0.0, 0.0, 1.0), ColorRGBA(0.0, 0.0, 1.0, 1.0)
    goal = BlinkGoal(colors=[red], bg_color=blue, blink_duration=rospy.Duration.from_sec(0.3), blink_rate_mean=0.2)
    return Goal("blink", BlinkAction, goal)


def posture(name: str, speed: float) -> Goal:
    """A posture of the robot's."""
    return Goal("body_pose_naoqi", BodyPoseWithSpeedAction, BodyPoseWithSpeedGoal(name, speed))


def breathing() -> Goal:
    """A behaviour of the robot's that never ends."""
    return Goal("run_behavior", RunBehaviorAction, RunBehaviorGoal("nao_library/breathe"))


def watched() -> Heard:
    """A key of the robot's memory that somebody has watched."""
    _call("nao_memory/watch", WatchMemory, CHARGE, 10.0, "")
    return Heard("nao_memory", f"nao_memory/{CHARGE}")


# --- what works -------------------------------------------------------------------------------------------------------


def _call(name: str, kind: type, *fields: Any) -> bool:
    rospy.wait_for_service(name, ANSWER)
    rospy.ServiceProxy(name, kind)(*fields)
    return True


def _succeeds(goal: Goal) -> bool:
    ended = goal.client.wait_for_result(rospy.Duration.from_sec(ANSWER))
    return bool(ended and goal.client.get_state() == GoalStatus.SUCCEEDED)


def _is_taken_up(goal: Goal) -> bool:
    """Whether a goal that takes long is begun, and ends when it is cancelled."""
    wait_until(lambda: goal.client.get_state() != GoalStatus.PENDING, PATIENCE, "news of the goal")
    begun = goal.client.get_state() == GoalStatus.ACTIVE
    goal.stop()
    return bool(goal.client.wait_for_result(rospy.Duration.from_sec(ANSWER)) and begun)


SERVERS = {
    "NaoLights": led("setIntensity", 0.0, lights=["FaceLeds"], i_values=[1.0]),
    "NaoMotion": motion("getAngles", names=["HeadYaw"]),
    "nao_audio_out": audio_out("getVolume"),
    "nao_audio_in": audio_in("getLanguage"),
    "NaoVision": vision("getCameras"),
    "NaoTactile": tactile("getTouched"),
    "NaoBehavior": behavior("listBehaviors"),
}
"""Server -> what it can do quickly. All of them do, whoever was killed."""
DOES: dict[str, Callable[[], bool]] = {
    "nao_walker": lambda: _call("stop_walk_srv", Empty),
    "nao_controller": lambda: _succeeds(trajectory(0.2, 0.0)),
    "nao_path_follower": lambda: _succeeds(walk_target(0.0)),
    "nao_footsteps": lambda: _call("footstep_srv", StepTargetService, step(StepTarget.left, 0.0)),
    "nao_speech": lambda: _succeeds(say("one")),
    "pose_manager": lambda: _is_taken_up(posture("Stand", 0.3)),
    "process_modules": lambda: _succeeds(perform("{type: opening, gripper: left}")),
    "nao_leds": lambda: _is_taken_up(blinks()),
    "nao_behaviors": lambda: _call("get_installed_behaviors", GetInstalledBehaviors),
    "nao_audio": lambda: _call("nao_audio/get_master_volume", GetAudioMasterVolume),
    "nao_alife": lambda: _call("basic_awareness/is_enabled", Trigger),
    "nao_vision": lambda: _call("nao_vision/movement_detection_sensitivity", VisionMotionSensitivity),
    SPEECH_WORKER: lambda: _succeeds(chain("nao_audio_out", audio_out("say", new_sentences(1)))),
}
"""What else a node or process does quickly; beside it what goes on again in the scene."""


def works(node: str) -> bool:
    """Whether a node does what it is for, and all servers as well.

    Raises:
        rospy.ROSException: A service is not there, or has failed.
    """
    return all(_succeeds(chain(*server)) for server in SERVERS.items()) and (node not in DOES or DOES[node]())


# --- scenes -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Scene:
    """A kill.

    Attributes:
        node: Which one, or what a process of the simulator runs.
        what: What goes on.
        begin: Begins it.
        moves: What is to be still behind it: joints beside the place of the robot, or its speech. The legs are not when
            it walks: the last step ends on both feet. Empty where nothing moves.
        unwatched: Whether the process that would stop what has lost its owner is killed before, and another has to.
    """

    node: str
    what: str
    begin: Callable[[], Nothing]
    moves: str = WALK
    unwatched: bool = False


def _sends(node: str, topic: str) -> Scene:
    return Scene(node, topic, lambda: Heard(node, topic), moves="")


TEXT = "one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen"
NUMBERS = itertools.count(1)
WALK = {"values": [1.5, 0.0, 0.0]}
TURN = {"names": ["HeadYaw"], "angles": [1.0], "times": [9.0]}
EYES = {"lights": ["FaceLeds"], "i_values": [1.0]}
SCENES = [
    Scene("NaoMotion", "walkTo", lambda: chain("NaoMotion", motion("walkTo", **WALK))),
    Scene("nao_walker", "cmd_vel", Steered),
    Scene("nao_controller", "joint_trajectory", lambda: trajectory(9.0, 1.0), moves="Body"),
    Scene("nao_audio_out", "say", lambda: chain("nao_audio_out", audio_out("say", TEXT)), moves=SPEECH),
    Scene("nao_path_follower", "walk_target", lambda: walk_target(1.5)),
    Scene("process_modules", "a walk", lambda: perform("{type: going, target: [2, 0]}")),
    Scene("NaoBehavior", "a walk of a behaviour", behaviour),
    Scene("nao_speech", "speech_action", lambda: say(TEXT), moves=SPEECH),
    Scene("pose_manager", "body_pose_naoqi", lambda: posture("Crouch", 0.2), moves="Body"),
    Scene("nao_footsteps", "footsteps_execution", footsteps),
    Scene("naoqi_moveto", "move_base_simple/goal", rviz_goal),
    Scene("nao_behaviors", "run_behavior", breathing, moves="Body"),
    Scene(
        "NaoMotion",
        "moveToward",
        lambda: chain("NaoMotion", motion("moveToward", 9.0, values=[1.0, 0.0, 0.0])),
        unwatched=True,
    ),
    Scene(SPEECH_WORKER, "say", lambda: chain("nao_audio_out", audio_out("say", new_sentences())), moves=""),
    Scene("nao_memory", "a key that is watched", watched, moves=""),
    _sends("nao_camera", "nao_robot/camera/top/image_raw"),
    Scene("nao_leds", "blink", blinks, moves=""),
    Scene("NaoTactile", "waitForTouch", lambda: chain("NaoTactile", tactile("waitForTouch", timeout=30.0)), moves=""),
    # Those above are the short form.
    Scene(
        "NaoMotion",
        "angleInterpolation",
        lambda: chain("NaoMotion", motion("angleInterpolation", **TURN)),
        moves="Body",
    ),
    Scene("nao_walker", "walkTo of NaoMotion", lambda: chain("NaoMotion", motion("walkTo", **WALK))),
    Scene("NaoLights", "a wait", lambda: chain("NaoLights", led("setIntensity", 9.0, **EYES)), moves=""),
    Scene(
        "nao_audio_in",
        "record",
        lambda: chain("nao_audio_in", audio_in("record", str_param="killed.wav", duration=9.0, overwrite=True)),
        moves="",
    ),
    Scene("NaoVision", "a wait", lambda: chain("NaoVision", vision("getCameras", 9.0)), moves=""),
    _sends("nao_joint_states", "joint_states"),
    _sends(MICROPHONE, f"{MICROPHONE}/audio_raw"),
    _sends("nao_diagnostic_updater", "diagnostics"),
    _sends("nao_tactile", "nao_robot/fsr/left"),
    _sends("nao_sonar", "nao_robot/sonar/left"),
    _sends("nao_alife", "nao_alife/state"),
    _sends("robot_state_publisher", "tf"),
    _sends("teleop_nao_joy", "diagnostics"),
    Scene("nao_audio", "nothing", Nothing, moves=""),
    Scene("nao_vision", "nothing", Nothing, moves=""),
    Scene(PICTURE_WORKER, "pictures", lambda: Heard("nao_camera", "nao_robot/camera/top/image_raw"), moves=""),
]
