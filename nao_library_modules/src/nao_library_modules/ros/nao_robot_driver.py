"""The driver of a robot with nao_robot's interface, for its clients: calls of its actions and services."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Container, Sequence
from concurrent import futures
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D, Twist, Vector3
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import (
    BodyPoseAction,
    BodyPoseGoal,
    BodyPoseWithSpeedAction,
    BodyPoseWithSpeedGoal,
    JointAnglesWithSpeedAction,
    JointAnglesWithSpeedGoal,
    JointTrajectoryAction,
    JointTrajectoryGoal,
)
from nao_library_msgs.srv import CmdPoseService, CmdVelService
from naoqi.errors import NaoError
from naoqi.limits import wait_while_answering

from ..core.errors import ErrorCode, code_in
from ..core.geometry import FOOTPRINT, Place
from ..core.joint_trajectory import KeyFrames
from ..core.poses import built_in
from ..core.process_owners import SERVICE
from .driver_types import spoken
from .goal_client import GoalTracker, server_connection
from .master_api import GONE
from .time_and_frames import pose_of, tf_prefix

log = logging.getLogger(__name__)

CONNECT_LOOK_PERIOD = 0.005
"""s of this computer between two looks whether a server is connected."""


class DriverCall:
    """A call under way; see `naoqi.calls.Call`. Any thread.

    `clock`: by which limits are counted; that of a robot's answers stands still while it is silent.
    """

    def __init__(self) -> None:
        self.clock: Callable[[], float] = time.monotonic
        self._answer: Future = Future()

    def done(self) -> bool:
        return self._answer.done()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for its end, at most so many s; whether it is over."""
        return bool(futures.wait([self._answer], timeout).done)

    def result(self, timeout: float | None = None) -> Any:
        """Wait for its end, and what it answered. Raises NaoError if it failed, or is not over in time."""
        if timeout is None:
            self.wait()
        elif not wait_while_answering(self.wait, self.clock, timeout):
            raise NaoError(f"{self}: no answer within {timeout:g} s")
        return self._answer.result()

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        """Have a function called with this call at its end, at once if it is over."""
        self._answer.add_done_callback(lambda _: callback(self))

    def cancel(self) -> None:
        self.end(error=NaoError(f"{self} was given up"))

    def end(self, value: Any = None, error: NaoError | None = None) -> None:
        """It is over; the first end counts."""
        with suppress(InvalidStateError):
            if error is None:
                self._answer.set_result(value)
            else:
                self._answer.set_exception(error)

    def end_by(self, read: Callable[[], Any]) -> None:
        """It is over: with what a function answers, or with the error that it raises."""
        try:
            value = read()
        except NaoError as error:
            self.end(error=NaoError(f"{self}: {error}"))
        else:
            self.end(value)

    def __str__(self) -> str:
        return "a call of the driver"


class ServiceCall(DriverCall):
    """A service that is called in a thread of its own; it cannot be taken back.

    `read`: what the call answers, of the text of the error, which is empty if there is none; may raise NaoError.
    """

    def __init__(self, name: str, kind: type, read: Callable[[str], Any], *arguments: Any) -> None:
        super().__init__()
        self._name = rospy.resolve_name(name)
        self._read = read
        service = rospy.ServiceProxy(name, kind)
        threading.Thread(target=self._run, args=(service, arguments), name=name, daemon=True).start()

    def _run(self, service: Any, arguments: Sequence[Any]) -> None:
        problem = ""
        try:
            service(*arguments)
        except Exception as error:  # of a connection that breaks as well: the call has to end
            problem = str(error) or repr(error)
        self.end_by(lambda: self._read(problem))

    def __str__(self) -> str:
        return f"the service {self._name}"


class GoalCall(DriverCall):
    """A goal.

    Attributes:
        server: The connection that it went through.

    Args:
        action: Whose goal it is.
        read: What the call answers, of the end state and the text; may raise NaoError.
    """

    def __init__(self, action: DriverAction, read: Callable[[int, str], Any]) -> None:
        super().__init__()
        self.server = server_connection(action.client)
        self._action = action
        self._read = read
        self._watch = GoalTracker()
        self._handle: Any = None

    def send(self, goal: Any) -> None:
        self._handle = self._action.client.send_goal(goal, self._look)

    def cancel(self) -> None:
        """Cancel the goal; the call is over when it has ended."""
        # Not here: the server's acknowledgement is waited for, and whoever cancels cancels many.
        threading.Thread(target=self._watch.cancel, args=(self._handle,), name="cancel", daemon=True).start()

    def lose(self) -> None:
        """The server is gone."""
        self._watch.acknowledged.set()
        self._watch.over.set()
        self.end(error=NaoError(f"{self}: the driver has gone, and the goal with it"))

    def _look(self, handle: Any) -> None:
        self._watch.look(handle)
        if self._watch.over.is_set():
            self.end_by(lambda: self._read(handle.get_terminal_state(), handle.get_goal_status_text()))

    def __str__(self) -> str:
        return f"the action {self._action.name}"


class DriverAction(rospy.SubscribeListener):
    """An action of the driver.

    Attributes:
        name: Full name.
        client: actionlib's.

    Args:
        name: Relative name.
        action: Its type.
    """

    def __init__(self, name: str, action: type) -> None:
        super().__init__()
        self.name = rospy.resolve_name(name)
        self.client = actionlib.ActionClient(name, spoken(action))
        self._lock = threading.Lock()
        self._running: list[GoalCall] = []
        self.client.pub_goal.impl.add_subscriber_listener(self)

    @property
    def running(self) -> list[GoalCall]:
        with self._lock:
            self._running = [call for call in self._running if not call.done()]
            return list(self._running)

    def there(self) -> bool:
        """Whether there is a server, goals get to it, and all that it says comes back."""
        client = self.client
        ways = (client.pub_cancel, client.status_sub, client.result_sub, client.feedback_sub)
        return server_connection(client) is not None and all(way.get_num_connections() > 0 for way in ways)

    def wait(self, limit: float) -> bool:
        """Wait for the server, s of this computer; whether it is there."""
        deadline = time.monotonic() + limit
        while not self.there():
            if time.monotonic() > deadline:
                return False
            time.sleep(CONNECT_LOOK_PERIOD)  # nothing tells of connections that come
        return True

    def send(self, goal: Any, read: Callable[[int, str], Any]) -> GoalCall:
        """Send a goal; see `GoalCall`."""
        call = GoalCall(self, read)
        with self._lock:
            self._running = [*(other for other in self._running if not other.done()), call]
        call.send(goal)
        return call

    def peer_unsubscribe(self, _topic_name: str, _num_peers: int) -> None:
        """Somebody takes goals no more; called by rospy."""
        left = self.client.pub_goal.impl.connections
        for call in self.running:
            if call.server not in left:  # it was the server: nothing would ever come
                call.lose()


ACTIONS = {
    "joint_trajectory": JointTrajectoryAction,
    "joint_angles_action": JointAnglesWithSpeedAction,
    "joint_stiffness_trajectory": JointTrajectoryAction,
    "body_pose": BodyPoseAction,
    "body_pose_naoqi": BodyPoseWithSpeedAction,
    "walk_target": MoveBaseAction,
}
SIGN_OF_LIFE = "wakeup"
"""A service that every such driver offers."""
LOOK_PERIOD = 1.0
"""s of this computer between two looks for a driver that is not there."""
CONNECT_LIMIT = 2.0
"""s of this computer that the server of an action may take to be connected, once."""


class NaoRobotDriver:
    """The driver by the names of nao_robot, relative to the namespace of the node, for `motion/motion_server.py`.

    Clients are made when the first call goes that way.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._actions: dict[str, DriverAction] = {}
        self._looked = -math.inf
        self._deaf = ""  # the address of a driver that the master knows, and that does not answer

    def there(self) -> bool:
        """Whether there is a driver: asked for once in a while, of the ROS master, as long as there is none."""
        with self._lock:
            joints = self._actions.get("joint_trajectory")
            if joints is not None and joints.there():
                return True
            if time.monotonic() - self._looked < LOOK_PERIOD:
                return False
            address = _address_of(SIGN_OF_LIFE)
            # One that has died without a word is in the master's books for ever: it is waited for once.
            found = bool(address) and address != self._deaf and self._action("joint_trajectory").wait(CONNECT_LIMIT)
            self._deaf = "" if found else address
            self._looked = time.monotonic()
            return found

    def follow(self, frames: KeyFrames) -> DriverCall:
        return self._send("joint_trajectory", _trajectory(frames))

    def go(self, joints: Sequence[str], angles: Sequence[float], speed: float) -> DriverCall:
        """Move joints to angles at a fraction of their top speed."""
        return self._send("joint_angles_action", _angles(joints, angles, speed))

    def stiffen(self, frames: KeyFrames) -> DriverCall:
        return self._send("joint_stiffness_trajectory", _trajectory(frames))

    def walk_by(self, place: Place) -> DriverCall | None:
        """Walk to a place seen from the robot by dead reckoning; False if the robot did not get there."""
        return self._ask("cmd_pose_srv", CmdPoseService, arrived, Pose2D(place.x, place.y, place.yaw))

    def walk_to(self, place: Place) -> DriverCall | None:
        """Walk to a place seen from the robot, by who plans walks; False if somebody stopped it."""
        goal = MoveBaseGoal()
        goal.target_pose.header.frame_id = tf_prefix() + FOOTPRINT
        goal.target_pose.pose = pose_of((place.x, place.y, 0.0, 0.0, 0.0, place.yaw))
        return self._send("walk_target", goal, _walked) if self.there() else None

    def walk_at(self, x: float, y: float, theta: float) -> DriverCall | None:
        """Begin to walk at shares -1..1 of the top speed, at the driver's step frequency."""
        twist = Twist(Vector3(x, y, 0.0), Vector3(0.0, 0.0, theta))
        return self._ask("cmd_vel_srv", CmdVelService, _no_answer, twist)

    def leave_walk(self) -> None:
        """Want no walk any more that was begun."""
        with self._lock:
            action = self._actions.get("walk_target")
        for call in action.running if action else ():
            call.cancel()

    def walk_cure(self) -> list[Any]:
        """What stops a walk of this process when it has died."""
        return [SERVICE, rospy.resolve_name("stop_walk_srv"), rospy.get_name()]

    def take_pose(self, name: str) -> DriverCall | None:
        """Take a pose of the pose_manager's tables."""
        return self._send("body_pose", BodyPoseGoal(name))

    def poses(self) -> Container[str]:
        """Names of these poses, as the node's parameters and its package have them; none where nobody takes them."""
        if not (self.there() and self._connected("body_pose")):
            return ()
        try:
            return {*built_in(), *rospy.get_param("pose_manager/poses", {})}
        except GONE:
            return ()

    def take_posture(self, name: str, speed: float) -> DriverCall | None:
        """Take a posture; False if the robot did not get there."""
        return self._send("body_pose_naoqi", BodyPoseWithSpeedGoal(name, speed), posture_reached)

    def _action(self, name: str) -> DriverAction:
        if name not in self._actions:
            self._actions[name] = DriverAction(name, ACTIONS[name])
        return self._actions[name]

    def _connected(self, name: str) -> bool:
        """Whether the server of an action is there; one that was never asked is waited for."""
        with self._lock:
            new = name not in self._actions
            action = self._action(name)
        return action.there() or (new and action.wait(CONNECT_LIMIT))

    def _send(self, name: str, goal: Any, read: Callable[[int, str], Any] | None = None) -> GoalCall | None:
        """Send a goal; None if nobody takes it."""
        return self._actions[name].send(goal, read or _succeeded) if self._connected(name) else None

    @staticmethod
    def _ask(name: str, kind: type, read: Callable[[str], Any], *arguments: Any) -> ServiceCall | None:
        """Call a service; None if there is none."""
        return ServiceCall(name, kind, read, *arguments) if _address_of(name) else None


def _address_of(service: str) -> str:
    """Where the master says that a service is; empty if nowhere, or without a master."""
    try:
        code, _, address = rospy.get_master().lookupService(rospy.resolve_name(service))
    except GONE as error:
        log.debug("no driver is looked for: %s", error)
        return ""
    return address if code == 1 else ""


def _succeeded(state: int, text: str) -> None:
    """Nothing. Raises NaoError if it failed, or somebody else ended it."""
    if state != GoalStatus.SUCCEEDED:
        raise NaoError(text or f"it ended {GoalStatus.to_string(state).lower()}, and the driver does not say why")


def _walked(state: int, text: str) -> bool | None:
    """None; False if somebody else ended it. Raises NaoError if it failed."""
    if state in (GoalStatus.PREEMPTED, GoalStatus.RECALLED):
        return False
    return _succeeded(state, text)


def posture_reached(state: int, text: str) -> bool:
    """Whether it was reached. Raises NaoError if it failed for another reason."""
    if state == GoalStatus.ABORTED and code_in(text) is ErrorCode.POSTURE_MISSED:
        return False
    _succeeded(state, text)
    return True


def _no_answer(error: str) -> None:
    """Nothing. Raises NaoError if there is an error."""
    if error:
        raise NaoError(error)


def arrived(error: str) -> bool | None:
    """None; False if the robot did not get there. Raises NaoError if there is another error."""
    return False if code_in(error) is ErrorCode.WALK_ENDED else _no_answer(error)


def _trajectory(frames: KeyFrames) -> JointTrajectoryGoal:
    goal = JointTrajectoryGoal(relative=int(frames.relative))
    goal.trajectory.joint_names = list(frames.joints)
    velocities = frames.velocities or [()] * len(frames.joints)
    for i, at in enumerate(frames.times):
        point = JointTrajectoryPoint(time_from_start=rospy.Duration.from_sec(at))
        point.positions = [values[i] for values in frames.values]
        point.velocities = [row[i] for row in velocities if row]
        goal.trajectory.points.append(point)
    return goal


def _angles(joints: Sequence[str], angles: Sequence[float], speed: float) -> JointAnglesWithSpeedGoal:
    goal = JointAnglesWithSpeedGoal()
    goal.joint_angles.joint_names = list(joints)
    goal.joint_angles.joint_angles = list(angles)
    goal.joint_angles.speed = speed
    return goal
