"""The node naoqi_moveto: walks to goals of RViz and of navigation tools."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rospy
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Empty

from naoqi.errors import NaoError
from naoqi.limits import STOP_LIMIT

from ...core.geometry import FOOTPRINT, ODOM, Place
from ...core.health import Level, Report
from ...core.nao_facts import MOTION, ask_for_stiff_legs
from ...core.robot import ask
from ...ros.node_interface import NodeInterface
from ..base.driver_node import frame_parameter
from ..joints.planar_frames import PlanarFrames, read_place
from .walk_commands import require_way

log = logging.getLogger(__name__)

END_LIMIT = 1.0


@dataclass(frozen=True)
class WalkGoal:
    """A place to walk to; `name` is for the log.

    `way` gives, when the robot sets out, the place in its frame. It may take a moment, and raise NaoError.
    """

    name: str
    way: Callable[[], Place]


class MoveToWalk:
    """The goals of one robot. Any thread may give one; a thread of its own finds the way and starts the walk.

    A robot that walks to an older goal continues to the new one without a stop: NAOqi replaces one moveTo by the next.
    The lock guards what is asked for; the robot is called without it.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._lock = threading.Condition()
        self._asked: WalkGoal | None = None
        self._stop_asked = False
        self._closed = False
        self._state = Report(Level.OK, "no goal yet")
        self._newest: Any = None
        self._thread = threading.Thread(target=self._run, name="move to", daemon=True)
        self._thread.start()

    def go(self, goal: WalkGoal) -> None:
        """Walk to a place; returns at once. Of goals that come faster than the robot takes them the last one counts."""
        with self._lock:
            self._asked, self._stop_asked = goal, False
            self._lock.notify()

    def cancel(self) -> None:
        """Stop, on both feet; returns at once."""
        with self._lock:
            self._asked, self._stop_asked = None, True
            self._lock.notify()

    def report(self) -> Report:
        return self._state

    def close(self) -> None:
        with self._lock:
            self._closed = True
            self._lock.notify()
        self._thread.join(STOP_LIMIT + END_LIMIT)

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            with self._lock:
                self._lock.wait_for(lambda: self._asked or self._stop_asked or self._closed)
                goal, closed = self._asked, self._closed
                self._asked, self._stop_asked = None, False
            try:
                if goal is not None and not closed:
                    self._set_out(goal)
                else:
                    self._stop()
            except NaoError as error:
                self._report(Level.ERROR, f"{goal.name if goal else 'stop'}: {error}")
            except Exception as error:  # a mistake in here must not leave a node that takes goals and does nothing
                log.exception("a goal failed")
                self._state = Report(Level.ERROR, f"unexpected error: {error!r}")
            if closed:
                return

    def _set_out(self, goal: WalkGoal) -> None:
        ask_for_stiff_legs(self._robot)
        way = goal.way()
        call = self._robot.proxy(MOTION).call_async("moveTo", *way)
        self._newest = call
        self._report(Level.OK, f"walks to {goal.name}: {way.x:.2f} m ahead, {way.y:.2f} m left, {way.yaw:.2f} rad")
        call.add_done_callback(lambda done: self._ended(goal, done))

    def _stop(self) -> None:
        call, self._newest = self._newest, None
        if call is None or call.done():
            return
        ask(self._robot, MOTION, "stopMove", limit=STOP_LIMIT)
        self._report(Level.OK, "the robot was stopped")

    def _ended(self, goal: WalkGoal, call: Any) -> None:
        """Report how a walk ended, in a thread of libqi. One that was replaced or stopped is no longer the newest."""
        if call is not self._newest:
            return
        try:
            reached = call.result(timeout=0)
        except NaoError as error:
            self._report(Level.ERROR, f"{goal.name}: {error}")
            return
        if reached is False:
            self._report(Level.WARN, f"{goal.name} was not reached: something stopped the robot on the way")
        else:
            self._report(Level.OK, f"{goal.name} is reached")

    def _report(self, level: Level, text: str) -> None:
        self._state = Report(level, text)
        log.log({Level.OK: logging.INFO, Level.WARN: logging.WARNING, Level.ERROR: logging.ERROR}[level], "%s", text)


class NaoqiMoveTo:
    """Walks to poses, in any frame of /tf, with the robot's own planning of steps. A new goal takes over.

    Clients get no answer: the end is in the log and on /diagnostics. For an answer, use the action `walk_target`.

    ROS API (relative names):
        Subscribes `move_base_simple/goal` (geometry_msgs/PoseStamped), `move_base_simple/cancel` (std_msgs/Empty).
        Parameters `~base_frame_id` (base_footprint), `~odom_frame_id` (odom), `tf_prefix` (searched upwards).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._base = frame_parameter(node, "~base_frame_id", FOOTPRINT)
        self._odom = frame_parameter(node, "~odom_frame_id", ODOM)
        self._frames = PlanarFrames(answering_time=robot.connection.answering_time)
        self._walk = MoveToWalk(robot)
        node.if_it_fails(self._walk.close)
        self._node.subscriber("move_base_simple/goal", PoseStamped, self._on_goal, queue_size=1)
        self._node.subscriber("move_base_simple/cancel", Empty, lambda _: self._walk.cancel(), queue_size=1)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"walk": self._walk.report}

    def close(self) -> None:
        self._walk.close()

    def _on_goal(self, goal: PoseStamped) -> None:
        try:
            place, frame = read_place("goal", goal)
        except NaoError as error:
            rospy.logerr("move_base_simple/goal: %s", error)
            return
        name = f"({place.x:.2f} m, {place.y:.2f} m, {place.yaw:.2f} rad) in {frame}"
        self._walk.go(WalkGoal(name, lambda: self._way(goal)))

    def _way(self, goal: PoseStamped) -> Place:
        """The way from where the robot is now; a goal in its own frame is where it was when the goal came."""
        place = self._frames.place_in(self._odom, goal)
        return require_way("goal", place.seen_from(self._frames.locate(self._base, self._odom)))
