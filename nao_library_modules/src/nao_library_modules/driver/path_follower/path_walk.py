"""Leads a robot along a course, round by round, by the topics and services of nao_walker, until it is there."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Any

import rospy
from geometry_msgs.msg import Pose2D, Twist, Vector3
from std_srvs.srv import Empty

from naoqi.errors import NaoError, RobotError
from naoqi.limits import STOP_LIMIT

from ...core.geometry import Place, wrapped
from ...core.nao_facts import MOTION, MOVE_FAILED, ask_for_stiff_legs, top_speeds
from ...core.process_owners import SERVICE
from ...core.robot import ask, run_task
from ...core.waiting import CancellationToken, WallClock
from ...ros.node_interface import NodeInterface
from ..base.driver_node import LazyTopic
from ..base.polling import Rate
from ..joints.joint_sensors import MEMORY
from .path_courses import Aim, FollowerSettings, reached

FACE_DISTANCE = 0.4
"""m: to what is further away the robot turns its face; it walks ahead faster than sideways."""
PROGRESS = 0.02
"""m that count as progress."""
LONGEST_ROUND = 1.0
"""s that a round counts at most: in a longer one the robot was silent, or this program stopped."""


def velocity(way: Place, settings: FollowerSettings) -> tuple[float, float, float]:
    """Shares -1..1 of the top speeds ahead, to the left and turning left, for a way in the robot's frame.

    None is so large that the robot would be past its target in the next round, at the step frequency of the settings.
    """
    far = way.distance > FACE_DISTANCE
    turn = math.atan2(way.y, way.x) if far else way.yaw
    top, top_turn = (speed / settings.controller_frequency for speed in top_speeds(settings.step_freq))
    yaw = settings.max_vel_yaw * max(-1.0, min(1.0, wrapped(turn) / settings.threshold_damp_yaw))
    yaw = math.copysign(min(abs(yaw), abs(wrapped(turn)) / top_turn), yaw)
    if way.distance < 1e-6:
        return 0.0, 0.0, yaw
    share = min(1.0, way.distance / settings.threshold_damp_xy)
    if far:
        share *= max(0.0, math.cos(turn))  # first turn, then go
    # Along an ellipse, so that it keeps its direction where it is slower sideways than ahead.
    ahead, aside = way.x / way.distance, way.y / way.distance
    share = min(share / math.hypot(ahead / settings.max_vel_x, aside / settings.max_vel_y), way.distance / top)
    return share * ahead, share * aside, yaw


class StuckWatch:
    """Notices that a robot gets no nearer for `limit` s (0: never): it pushes against a wall, or walks on the spot."""

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._best = math.inf
        self._waited, self._checked = 0.0, 0.0

    def check(self, now: float, rest: float) -> None:
        """Note at `now` s that `rest` m of the way are left. Raises NaoError if it has not become less for too long."""
        round_time, self._checked = min(max(0.0, now - self._checked), LONGEST_ROUND), now
        if rest < self._best - PROGRESS or math.isinf(self._best):
            self._best, self._waited = rest, 0.0
            return
        self._waited += round_time
        if self._limit > 0.0 and self._waited > self._limit:
            raise NaoError(
                f"no progress for {self._limit:g} s, with {rest:.2f} m still to go: something is in the way, "
                "or the robot does not walk"
            )


LISTENER_LIMIT = 5.0
"""s to wait for a subscriber to the commands."""
ON_ITS_WAY, LOOK_PERIOD = 1.0, 0.02
"""s of real time that a command may take to reach nao_walker on a busy computer, and between two looks at the robot."""
STOP, INHIBIT, LET_GO = "stop_walk_srv", "inhibit_walk", "uninhibit_walk"


class WalkTopics:
    """Publishes walk commands; asks the robot itself whether it can walk and does. For one thread at a time.

    All methods raise NaoError if the robot cannot be asked or stopped.

    ROS API (relative names):
        Publishes `cmd_pose` (geometry_msgs/Pose2D), `cmd_vel` (geometry_msgs/Twist).
        Calls `stop_walk_srv`, `inhibit_walk`, `uninhibit_walk` (std_srvs/Empty), where they are offered.
    """

    def __init__(self, robot: Any, node: NodeInterface, use_velocities: bool) -> None:
        self._robot = robot
        self._node = node
        self._heard = threading.Event()
        self._topic = "cmd_vel" if use_velocities else "cmd_pose"
        kind = Twist if use_velocities else Pose2D
        self._commands = node.publisher(self._topic, kind, tcp_nodelay=True, queue_size=1)
        LazyTopic(lambda listened: self._heard.set() if listened else None, self._commands)
        self._stop = node.caller(STOP, Empty)
        self._inhibit = node.caller(INHIBIT, Empty)
        self._failed_before: list = []
        self._last_pose = -math.inf  # when it was published, by time.monotonic
        self._let_go = node.caller(LET_GO, Empty)

    def prepare(self, interrupt: CancellationToken) -> None:
        """Get ready to walk: the robot takes the pose for it, if it does not walk already.

        Raises NaoError if it cannot, or no node passes commands on to it; Preempted, or whatever reason the interrupt
        has.
        """
        if not self._commands.get_num_connections():
            self._heard.wait(LISTENER_LIMIT)
        if not self._commands.get_num_connections():
            raise NaoError(f"no subscriber to {self._node.resolve(self._topic)}: does nao_walker run?")
        self._failed_before = self._last_failure()
        if not self.walking():
            ask_for_stiff_legs(self._robot)
            run_task(self._robot.proxy(MOTION).call_async("moveInit"), interrupt, self._stop_robot)

    def go_to(self, way: Place) -> None:
        """Walk to where a way leads, in the robot's frame; replaces the command before."""
        self._own_walk()
        self._last_pose = time.monotonic()
        self._commands.publish(Pose2D(way.x, way.y, way.yaw))

    def go_at(self, x: float, y: float, yaw: float) -> None:
        """Walk with shares -1..1 of the top speeds."""
        self._own_walk()
        self._commands.publish(Twist(Vector3(x, y, 0.0), Vector3(0.0, 0.0, yaw)))

    def walking(self) -> bool:
        return bool(ask(self._robot, MOTION, "moveIsActive"))

    def why_stopped(self) -> str:
        """Cause of the robot's event MoveFailed since `prepare`, an obstacle for example; empty without one."""
        failure = self._last_failure()
        return str(failure[0]) if failure and failure != self._failed_before else ""

    def stop(self) -> None:
        """Stand, on both feet; returns then."""
        if self._topic == "cmd_vel":
            self._commands.publish(Twist())  # arrives after all velocities before it
        self._stop_now()
        # A pose that arrives after the stop restarts the walk.
        while time.monotonic() - self._last_pose < ON_ITS_WAY:
            if self.walking():
                self._stop_now()
            time.sleep(LOOK_PERIOD)
        self._robot.owners.let_go(self)

    def _stop_now(self) -> None:
        try:
            self._stop()
        except (rospy.ServiceException, rospy.ROSException):  # not offered, or failed: ask the robot itself
            self._stop_robot()
        standing = self._robot.proxy(MOTION).call_async("waitUntilMoveIsFinished")
        standing.result(timeout=STOP_LIMIT)

    def reserve(self) -> None:
        """Keep others, a joystick for example, from walking."""
        # Held before: a node that is killed in between must not leave it behind.
        self._robot.owners.hold(INHIBIT, "hold on walking", [SERVICE, self._let_go.resolved_name, rospy.get_name()])
        self._call_if_there(self._inhibit)

    def release(self) -> None:
        self._call_if_there(self._let_go)
        self._robot.owners.let_go(INHIBIT)

    def _own_walk(self) -> None:
        """Own the walk of this node: nao_walker, which begins it, continues when this node dies."""
        self._robot.owners.hold(self, "walk", [MOTION, "stopMove", []])

    def _last_failure(self) -> list:
        """Value of the event: cause, whether the walk had begun, place of an obstacle. Empty before the first one."""
        try:
            value = ask(self._robot, MEMORY, "getData", MOVE_FAILED)
        except RobotError:
            return []  # nothing has failed yet, or the robot has no such event
        return list(value) if isinstance(value, (list, tuple)) else []

    def _stop_robot(self) -> None:
        ask(self._robot, MOTION, "stopMove", limit=STOP_LIMIT)

    @staticmethod
    def _call_if_there(service: rospy.ServiceProxy) -> None:
        try:
            service()
        except (rospy.ServiceException, rospy.ROSException) as error:
            rospy.logdebug("%s: %s", service.resolved_name, error)


RESEND_DISTANCE, RESEND_TURN = 0.02, math.radians(4.0)
"""m and rad that the aim moves before the robot gets it: it plans all its steps again each time."""
GRACE, WALL_GRACE = 1.0, 0.25
"""s from a command until the robot must be seen to walk; simulated time may be fast, so of real time as well."""
SETTLE = 3.0
"""s that a robot which is near enough may continue, to get nearer, before it is stopped."""
FASTEST_ROUND = 0.008
"""s of real time from one round to the next at least, however fast simulated time runs."""


def _check_stop(legs: WalkTopics) -> None:
    """Give up a walk that a protection of the robot has ended: each new try would get nearer to what is in the way."""
    cause = legs.why_stopped()
    if cause:
        raise NaoError(f"the robot stopped: {cause}")


class _Mode:
    """A way to lead; `round` does what is to be done now, and returns whether the robot has arrived and stands."""

    def __init__(
        self, legs: WalkTopics, settings: FollowerSettings, now: Callable[[], float], interrupt: CancellationToken
    ) -> None:
        self._legs = legs
        self._interrupt = interrupt
        self._settings = settings
        self._now = now
        self._wall = WallClock()


class _Poses(_Mode):
    """Leads by poses: the robot plans its steps to each aim, and gets a new one when the aim has moved."""

    def __init__(self, *shared: Any) -> None:
        super().__init__(*shared)
        self._sent: Aim | None = None
        self._sent_at = (-math.inf, -math.inf)
        self._near_since: float | None = None

    def round(self, robot: Place, aim: Aim) -> bool:
        way = aim.place.seen_from(robot)
        near = aim.final and reached(way, self._settings)
        walking = self._legs.walking()
        now = self._now()
        if near:
            self._near_since = now if self._near_since is None else self._near_since
            if walking and now - self._near_since > SETTLE:
                self._legs.stop()
                return True
            if not walking and not self._just_sent(now):
                return True
        else:
            self._near_since = None
            if not walking:
                _check_stop(self._legs)
        if self._moved(aim):
            self._send(way, aim, now)
        elif not (near or walking or self._just_sent(now)):
            self._legs.prepare(self._interrupt)  # says why it does not walk, if it knows
            self._send(way, aim, now)
        return False

    def _send(self, way: Place, aim: Aim, now: float) -> None:
        self._legs.go_to(way)
        self._sent, self._sent_at = aim, (now, self._wall.now())

    def _moved(self, aim: Aim) -> bool:
        if self._sent is None or aim.final != self._sent.final:
            return True
        change = aim.place.seen_from(self._sent.place)
        return change.distance > RESEND_DISTANCE or abs(change.yaw) > RESEND_TURN

    def _just_sent(self, now: float) -> bool:
        return now - self._sent_at[0] < GRACE or self._wall.now() - self._sent_at[1] < WALL_GRACE


class _Velocities(_Mode):
    """Leads by velocities, a new one each round."""

    def __init__(self, *shared: Any) -> None:
        super().__init__(*shared)
        self._seen_at = (self._now(), self._wall.now())

    def round(self, robot: Place, aim: Aim) -> bool:
        way = aim.place.seen_from(robot)
        if aim.final and reached(way, self._settings):
            self._legs.stop()
            return True
        now, wall = self._now(), self._wall.now()
        if self._legs.walking():
            self._seen_at = (now, wall)
        else:
            _check_stop(self._legs)
            if now - self._seen_at[0] > GRACE and wall - self._seen_at[1] > WALL_GRACE:
                self._legs.prepare(self._interrupt)
                self._seen_at = (now, wall)
        self._legs.go_at(*velocity(way, self._settings))
        return False


def lead(
    course: Any,
    legs: WalkTopics,
    locate: Callable[[], Place],
    clock: Any,
    settings: FollowerSettings,
    interrupt: CancellationToken,
    report: Callable[[Place, Aim], None] = lambda robot, aim: None,
) -> None:
    """Walk until the course ends; `report` gets in every round the place of the robot, and its aim.

    `locate` gives the place of the robot in the frame of the course. The legs are not stopped when an error ends the
    walk. Raises NaoError if the robot cannot walk, cannot be located or is stuck; Preempted, or whatever reason the
    interrupt has.
    """
    rate = Rate(clock, 1.0 / settings.controller_frequency, FASTEST_ROUND, interrupt)
    stuck = StuckWatch(settings.stuck_time)
    mode = (_Velocities if settings.use_vel_ctrl else _Poses)(legs, settings, clock.now, interrupt)
    prepared = False
    while rate.wait():
        robot = locate()
        aim = course.aim(robot)
        report(robot, aim)
        there = aim.final and reached(aim.place.seen_from(robot), settings)
        if not prepared:
            if there and not legs.walking():
                return
            legs.prepare(interrupt)
            prepared = True
            continue  # that took a while: look again
        if mode.round(robot, aim):
            return
        if not there:  # else it ends its last steps, which takes a while where time is slow
            stuck.check(clock.now(), aim.rest)
    interrupt.check()
