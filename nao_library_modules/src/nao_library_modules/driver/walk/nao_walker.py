"""The node nao_walker: walking, with the names of nao_robot; inhibition, head scan and diagnostics of it."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import rospy
import std_msgs.msg
from geometry_msgs.msg import Pose2D, Twist
from std_msgs.msg import String
from std_srvs.srv import Empty

from nao_library_msgs.msg import StepTarget
from nao_library_msgs.srv import CmdPoseService, CmdVelService, SetArmsEnabled, StepTargetService
from naoqi.errors import NaoError

from ...core.files import Kept
from ...core.health import Level, Report
from ...core.joint_trajectory import KeyFrames
from ...core.nao_facts import MOTION, MOVE_FAILED
from ...core.robot import ask
from ...core.robot_events import EventRelay
from ...core.waiting import CancellationToken
from ...ros.node_interface import AlreadyOffered, NodeInterface
from ...ros.server_node import node_file
from ...ros.time_and_frames import RosClock
from ..base.driver_node import number, whenever
from ..joints.joint_controller import InitialStiffness, JointController
from ..joints.joint_sensors import MEMORY
from .walk_commands import (
    Command,
    Order,
    Stop,
    Superseded,
    Velocity,
    read_gait_config,
    read_step,
    read_target,
    read_velocity,
)
from .walker import Walker

log = logging.getLogger(__name__)


class WalkInhibition:
    """Holds on walking, by the node that put them on. Every method may be called from any thread.

    A node that inhibits walking means the others: one that follows a path keeps a joystick from interfering, and walks
    itself. `kept`: where they are saved for the next process of this node. `own`: name of this node: holds of
    parts that died with it are gone.
    """

    def __init__(self, kept: Kept, own: str = "") -> None:
        self._lock = threading.Lock()
        self._kept = kept
        self._holds: Counter[str] = kept.load(_kept_holds) or Counter()
        self._holds.pop(own, None)

    def inhibit(self, owner: str) -> int:
        """Put a hold on walking; how many there are now."""
        with self._lock:
            self._holds[owner] += 1
            return self._keep()

    def let_go(self, owner: str) -> int:
        """Take a hold off, one of the node's own if it has any, else the first that was put on; how many are left.

        A person who lets go at a command line has another name each time. Without any hold this is no error: clients
        of nao_robot let go to be sure, or once more than they inhibited.
        """
        with self._lock:
            if not self._holds:
                return 0
            held = owner if owner in self._holds else next(iter(self._holds))
            self._holds[held] -= 1
            if not self._holds[held]:
                del self._holds[held]
            return self._keep()

    def drop(self) -> None:
        """Take all holds off."""
        with self._lock:
            self._holds.clear()
            self._keep()

    def _keep(self) -> int:
        self._kept.save(self._holds)
        return sum(self._holds.values())

    @property
    def owners(self) -> list[str]:
        with self._lock:
            return list(self._holds)

    def against(self, node: str) -> list[str]:
        """The other nodes that keep a node from walking."""
        return [owner for owner in self.owners if owner != node]


def _kept_holds(kept: Any) -> Counter[str]:
    if not all(type(count) is int and count > 0 for count in kept.values()):
        raise ValueError(f"{kept!r} does not count holds on walking")
    return Counter(kept)


IS_ACTIVE = "moveIsActive"
"""The method that the report asks: its answer says nothing about commands."""
COMPLAINT_PERIOD = 5.0
"""s of real time from one complaint to the next about the same thing."""


class WalkJournal:
    """Remembers commands and failures. Every method may be called from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._complained: dict[str, float] = {}
        self._command = ""
        self._commanded_at = 0.0
        self._failures = 0
        self._last_failure = ""
        self._failing = ""  # what failed last, and has not succeeded since

    def commanded(self, source: str, now: float) -> None:
        with self._lock:
            self._command, self._commanded_at = source, now

    def succeeded(self, name: str) -> None:
        """The robot carried a command out, or answered: a command clears any failure, IS_ACTIVE its own."""
        with self._lock:
            if name != IS_ACTIVE or self._failing == name:
                self._failing = ""

    def failed(self, name: str, error: BaseException) -> None:
        with self._lock:
            self._failures += 1
            self._failing = name
            self._last_failure = f"{name}: {error}"
        if self._is_due(f"{name} failed"):
            log.error("%s: %s", name, error)

    def warn(self, key: str, text: str) -> None:
        """Log a warning, but not all the time about the same `key`."""
        if self._is_due(key):
            log.warning("%s", text)

    def report(self, now: float, doing: str, active: bool | None, owners: Sequence[str], watchdog_stops: int) -> Report:
        """The line of diagnostics at `now` s of ROS time.

        `doing` is what the node has the robot do, `active` whether the robot answers that it walks (None: not asked).
        """
        with self._lock:
            age = f"{now - self._commanded_at:.1f}" if self._command else ""
            values = {
                "commanded": doing,
                "robot": {None: "unknown", True: "walks", False: "stands"}[active],
                "inhibited by": ", ".join(owners),
                "last command": self._command,
                "last command (s ago)": age,
                "stopped because commands ceased": str(watchdog_stops),
                "commands that failed": str(self._failures),
                "last failure": self._last_failure,
            }
            failing = self._failing
        message = values["robot"] + (f", inhibited by {values['inhibited by']}" if owners else "")
        if failing:
            return Report(Level.WARN, f"{message}; {values['last failure']}", values)
        return Report(Level.OK, message, values)

    def _is_due(self, key: str) -> bool:
        now = time.monotonic()
        with self._lock:
            due = now - self._complained.get(key, now - 2 * COMPLAINT_PERIOD) >= COMPLAINT_PERIOD
            if due:
                self._complained[key] = now
            return due


YAW, PITCH = "HeadYaw", "HeadPitch"
DOWN, UP, AFTERWARDS = math.radians(28.0), math.radians(-35.0), math.radians(22.0)
"""HeadPitch at the beginning and the end of the sweep, and after it, rad; those of nao_robot."""
SWEEP_SPEED = math.radians(3.3)
"""rad/s: a laser scanner at 10 Hz then has a line each third of a degree, as in nao_robot."""


class HeadScan:
    """The head of one robot. A scan runs in the thread that asks for it, which may be any.

    `speed` is the fraction of the joints' top speed on the way to the sweep, and from it.
    """

    def __init__(self, controller: JointController, speed: float) -> None:
        self.speed = speed
        self._controller = controller
        self._closed = CancellationToken()
        self._scanning = threading.Lock()

    @property
    def active(self) -> bool:
        return self._scanning.locked()

    def run(self, prepare: Callable[[], None] = lambda: None) -> None:
        """Look down, sweep up, look at the ground before the feet; `prepare` is called first, as a part of it.

        Raises NaoError if a scan is under way, the robot refuses or is lost, or the node ends.
        """
        if not self._scanning.acquire(blocking=False):
            raise NaoError("a head scan is under way")
        try:
            prepare()
            self._look(DOWN)
            sweep = KeyFrames((PITCH,), ((DOWN - UP) / SWEEP_SPEED,), ((UP,),))
            self._require_end(self._controller.follow(sweep, self._closed).preempted)
            self._look(AFTERWARDS)
        finally:
            self._scanning.release()

    def close(self) -> None:
        """End a scan that is under way; the head stops where it is."""
        self._closed.stop()

    def _look(self, pitch: float) -> None:
        reached = self._controller.move((YAW, PITCH), (0.0, pitch), self.speed, False, self._closed)
        self._require_end(reached.preempted)

    @staticmethod
    def _require_end(preempted: bool) -> None:
        if preempted:
            raise NaoError("the head scan was stopped: the node ends")


STEPS_IN_LINE = 50
CLOSE_LIMIT = 5.0
"""s that the end of the node waits until the robot stands."""
CONTACT_PROTECTION = "ENABLE_FOOT_CONTACT_PROTECTION"


class NaoWalker:
    """Walking of one robot: the newest command wins, a stop always gets through.

    Velocities on `cmd_vel` have to be renewed: when they cease for `~cmd_vel_timeout`, the robot is stopped.
    Those of `cmd_vel_srv` last until the next command. While a node inhibits walking, commands of all other nodes are
    refused; its own are not, and `stop_walk_srv` never is.

    ROS API (relative names):
        Subscribes `cmd_vel` (geometry_msgs/Twist: linear.x, linear.y, angular.z as fractions -1..1 of the top speed;
        all below 0.001: stand), `cmd_pose` (geometry_msgs/Pose2D: m, rad, in the robot's frame), `cmd_step`
        (nao_library_msgs/StepTarget; steps queue up), `start_scan` (std_msgs/Empty): as `head_scan_srv`.
        Publishes `speech` (std_msgs/String, latched): "Walker online" when the robot is reached, "Starting scan" and
        "Scan complete"; nao_speech says it.
        Services that answer when the walk has ended, with an error when it did not get there: `cmd_pose_srv`
        (nao_library_msgs/CmdPoseService), `cmd_step_srv` (nao_library_msgs/StepTargetService), `stop_walk_srv`,
        `inhibit_walk` (std_srvs/Empty). `head_scan_srv` (std_srvs/Empty) stops the walk, sweeps the head from 28
        degrees below the horizon to 35 above in 19 s, and answers at the end; meanwhile the robot does not walk.
        Where another node, as nao_teleop, offers `inhibit_walk` already, it and `uninhibit_walk` are left to that one.
        Others: `cmd_vel_srv` (nao_library_msgs/CmdVelService), `uninhibit_walk`, `needs_start_walk_pose_srv`,
        `read_foot_gait_config_srv` (std_srvs/Empty), `enable_arms_walking_srv` (nao_library_msgs/SetArmsEnabled).
        Parameters `~cmd_vel_timeout` (0.5 s; 0: none), `~step_frequency` (0.5; 0..1, of velocities), `~use_walk_pose`
        (false; true: the first walk begins with the pose for walking), `~use_foot_gait_config` (false),
        `~foot_gait_config` (pairs of name and value for ALMotion), `~init_stiffness` (0),
        `~enable_foot_contact_protection` (unset: left as it is), `~max_head_speed` (0.2, fraction of the top speed: of
        the head on its way to a scan).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._robot = robot
        timeout = number(node, "~cmd_vel_timeout", 0.5, "timeout")
        joints = JointController(robot)
        self._init_stiffness = InitialStiffness(joints, node.param)
        frequency = number(node, "~step_frequency", 0.5, "share")
        gait = self._gait()
        head_speed = number(node, "~max_head_speed", 0.2, "fraction")
        self._kept = node_file(self._node.name)
        self._inhibition = WalkInhibition(self._kept, rospy.get_name())
        self._journal = WalkJournal()
        self._walker = Walker(robot, RosClock(), timeout)
        # Where another node has the services, it may be walking the robot.
        node.if_it_fails(lambda: self._walker.close(CLOSE_LIMIT, only_own=True))
        self._walker.frequency = frequency
        self._walker.gait = gait
        self._walker.needs_walk_pose = bool(self._node.param("~use_walk_pose", False))
        self._scan = HeadScan(joints, head_speed)
        self._speech = self._node.publisher("speech", String, queue_size=10, latch=True)
        self._online = False
        self._offer_services()
        self._events = EventRelay(lambda: robot.proxy(MEMORY), self._on_failure)
        # After the services: a part that cannot offer them sets nothing on the robot.
        self._stop_setting_up = whenever(robot, node, "connected", self._set_up)
        self._listen("cmd_vel", Twist, partial(self._velocity, "cmd_vel"), watched=True, queue_size=1, tcp_nodelay=True)
        self._listen("cmd_pose", Pose2D, read_target, queue_size=1, tcp_nodelay=True)
        self._listen("cmd_step", StepTarget, read_step, queue_size=STEPS_IN_LINE)
        self._node.subscriber("start_scan", std_msgs.msg.Empty, self._on_scan, queue_size=1)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"walk": self._report}

    def close(self) -> None:
        """Stop the walk and wait until the robot stands; holds on walking end with the node."""
        self._kept.forget()
        self._stop_setting_up()
        self._events.close()
        self._scan.close()
        self._walker.close(CLOSE_LIMIT)

    # --- topics ---------------------------------------------------------------------------------------------------

    def _listen(
        self, topic: str, kind: type, read: Callable[[Any], Command], watched: bool = False, **options: Any
    ) -> None:
        self._node.subscriber(topic, kind, lambda message: self._take(topic, message, read, watched), **options)

    def _on_scan(self, message: std_msgs.msg.Empty) -> None:
        try:
            self._serve_scan(_caller(message))
        except NaoError as error:
            self._journal.failed("start_scan", error)

    def _take(self, topic: str, message: Any, read: Callable[[Any], Command], watched: bool) -> None:
        caller = _caller(message)
        try:
            command = read(message)
            if _is_zero(command) and self._inhibition.against(caller):
                return  # a stick at rest is not worth a refusal
            order = self._order(topic, caller, command, watched=watched)
        except NaoError as error:
            self._journal.failed(topic, error)
            return
        order.answer.add_done_callback(lambda answer: self._note_end(topic, answer))

    def _note_end(self, topic: str, answer: Any) -> None:
        error = answer.exception()
        if isinstance(error, Superseded):
            rospy.logdebug("%s: %s", topic, error)
        elif error is not None:
            self._journal.failed(topic, error)

    def _velocity(self, name: str, twist: Twist) -> Velocity:
        velocity, clamped = read_velocity(twist)
        if clamped:
            self._journal.warn(f"{name} out of range", f"{name}: {clamped}: -1 to 1")
        return velocity

    def _order(self, name: str, caller: str, command: Command, **options: bool) -> Order:
        """Raises NaoError if walking is inhibited, or a head scan is under way."""
        owners = self._inhibition.against(caller)
        if owners:
            raise NaoError(f"refused from {caller}: walking is inhibited by {', '.join(owners)}")
        if self._scan.active and not _is_zero(command):
            raise NaoError(f"refused from {caller}: a head scan is under way")
        source = f"{name} from {caller}"
        self._journal.commanded(source, rospy.get_time())
        order = self._walker.order(command, source, **options)
        order.answer.add_done_callback(lambda answer: answer.exception() or self._journal.succeeded(name))
        return order

    # --- services -------------------------------------------------------------------------------------------------

    def _offer_services(self) -> None:
        def serve(name: str, kind: type, action: Callable[[str, Any], None]) -> None:
            self._node.offer(name, kind, lambda request: action(_caller(request), request))

        def walk(name: str, kind: type, read: Callable[[Any], Command], **options: bool) -> None:
            serve(name, kind, lambda caller, request: _wait(self._order(name, caller, read(request), **options)))

        walk("cmd_vel_srv", CmdVelService, lambda request: self._velocity("cmd_vel_srv", request.twist))
        walk("cmd_pose_srv", CmdPoseService, lambda request: read_target(request.pose))
        walk("cmd_step_srv", StepTargetService, lambda request: read_step(request.step), to_the_end=True)
        serve("stop_walk_srv", Empty, self._serve_stop)
        serve("head_scan_srv", Empty, self._serve_scan)
        try:
            serve("uninhibit_walk", Empty, self._serve_uninhibit)
            serve("inhibit_walk", Empty, self._serve_inhibit)
        except AlreadyOffered as error:
            self._inhibition.drop()  # of a walker before this one: its clients let go at the other node
            rospy.loginfo("inhibit_walk and uninhibit_walk are left to %s, which offers them already", error.node)
        serve("needs_start_walk_pose_srv", Empty, self._serve_walk_pose)
        serve("read_foot_gait_config_srv", Empty, self._serve_gait)
        serve("enable_arms_walking_srv", SetArmsEnabled, self._serve_arms)

    def _serve_stop(self, caller: str, _: Any) -> None:
        _wait(self._walker.order(Stop(), f"stop_walk_srv from {caller}"))

    def _serve_scan(self, caller: str, _: Any = None) -> None:
        def stand() -> None:
            self._serve_stop(caller, None)
            self._speech.publish("Starting scan")

        self._scan.run(stand)
        self._speech.publish("Scan complete")
        self._serve_walk_pose()

    def _serve_inhibit(self, caller: str, _: Any) -> None:
        count = self._inhibition.inhibit(caller)
        rospy.loginfo("walking is inhibited by %s (%d in all)", caller, count)
        if count == 1:
            _wait(self._walker.order(Stop(), f"inhibit_walk from {caller}"))

    def _serve_uninhibit(self, caller: str, _: Any) -> None:
        count = self._inhibition.let_go(caller)
        rospy.loginfo("%s lets walking go: %s", caller, f"still inhibited ({count})" if count else "not inhibited")

    def _serve_walk_pose(self, *_: Any) -> None:
        self._walker.needs_walk_pose = bool(self._node.param("~use_walk_pose", False))

    def _serve_gait(self, *_: Any) -> None:
        self._walker.gait = self._gait()
        rospy.loginfo("gait: %s", self._walker.gait or "the robot's own")

    def _serve_arms(self, _: str, request: Any) -> None:
        arms = request.left_arm, request.right_arm
        ask(self._robot, MOTION, "setMoveArmsEnabled", *arms)

    def _gait(self) -> list[list[Any]]:
        if not self._node.param("~use_foot_gait_config", False):
            return []
        return read_gait_config("~foot_gait_config", self._node.param("~foot_gait_config", []))

    # --- state ----------------------------------------------------------------------------------------------------

    def _set_up(self) -> None:
        """Give the parameters of the walk to a robot that is reached."""
        try:
            protect = self._node.param("~enable_foot_contact_protection", None)
            if protect is not None:
                config = [[CONTACT_PROTECTION, bool(protect)]]
                ask(self._robot, MOTION, "setMotionConfig", config)
            self._init_stiffness.apply()
        except NaoError as error:
            rospy.logerr("the robot does not take the parameters of the walk: %s", error)
        self._events.renew()
        try:
            self._events.subscribe(MOVE_FAILED)
        except NaoError as error:
            rospy.logerr("%s cannot be subscribed: causes of walks that fail are not logged: %s", MOVE_FAILED, error)
        if not self._online:
            self._online = True
            rospy.loginfo("Walker online")
            self._speech.publish("Walker online")

    def _on_failure(self, _: str, value: Any) -> None:
        """Log the cause, which no call to walk at a velocity returns. In a thread of libqi."""
        if value and self._walker.doing is not None:
            self._journal.warn(MOVE_FAILED, f"the robot does not walk on: {value[0]}")

    def _report(self) -> Report:
        active = None
        if self._robot.connection.state == "connected":
            try:
                active = ask(self._robot, MOTION, IS_ACTIVE)
                self._journal.succeeded(IS_ACTIVE)
            except NaoError as error:
                self._journal.failed(IS_ACTIVE, error)
        doing, owners = str(self._walker.doing or "nothing"), self._inhibition.owners
        return self._journal.report(rospy.get_time(), doing, active, owners, self._walker.watchdog_stops)


def _is_zero(command: Command) -> bool:
    return isinstance(command, Velocity) and command.is_zero


def _wait(order: Order) -> None:
    """Raises NaoError if it was not carried out. No limit: the proxy layer ends calls to a lost robot."""
    order.answer.result()


def _caller(message: Any) -> str:
    return getattr(message, "_connection_header", {}).get("callerid", "an unknown node")
