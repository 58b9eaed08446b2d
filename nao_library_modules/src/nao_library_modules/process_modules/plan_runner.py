"""Runs a plan on a robot: process modules, ROS time, the topic of the tree while it runs, and the trace file."""

from __future__ import annotations

import argparse
import sys
import threading
import time
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import rospy
from std_srvs.srv import Empty

from nao_library_msgs.msg import PlanTask, PlanTree

from ..core.files import NoPlaceForFile, require_new, write_whole
from ..core.process_owners import OwnerLine
from ..ros.goal_client import GoalTracker
from ..ros.node import own_goals, robot_address, robot_beside
from ..ros.time_and_frames import RosClock
from .control import Branch, top_level
from .failures import LowLevelFailure, PlanFailure
from .low_level import make_process_modules, this_robot
from .process_module import with_process_modules_running
from .robot_link import RobotLink
from .tasks import Task
from .trace import Record, Trace, trace_of

# --- the tree on a topic ----------------------------------------------------------------------------------------------

TOPIC = "plan_tree"
SHORTEST = 0.1
"""s between two messages: a plan may change much faster than anybody can look."""


class PlanTopic:
    """Publishes the tree of a plan, latched: after changes, ten times a second at most, and at its end.

    Pass it to `top_level` as an observer; `close` it afterwards.
    """

    def __init__(self, topic: str = TOPIC) -> None:
        self._publisher = rospy.Publisher(topic, PlanTree, queue_size=1, latch=True)
        self._root: Task | None = None
        self._changed = threading.Event()
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._publish_changes, name=f"topic {topic}", daemon=True)
        self._thread.start()

    def __call__(self, task: Task) -> None:
        self._root = task.tree.root
        self._changed.set()

    def close(self) -> None:
        """Publish the last state, and end."""
        self._closed.set()
        self._changed.set()
        self._thread.join()

    def _publish_changes(self) -> None:
        while not self._closed.is_set():
            self._changed.wait()
            self._changed.clear()
            self._publish()
            self._closed.wait(SHORTEST)
        self._publish()

    def _publish(self) -> None:
        root = self._root
        if root is None:
            return
        message = PlanTree(plan=root.name, tasks=[_message(record) for record in trace_of(root).records])
        message.header.stamp = rospy.Time.now()
        try:
            self._publisher.publish(message)
        except rospy.ROSException as error:  # the node ends
            rospy.logdebug("%s: %s", TOPIC, error)


def _message(record: Record) -> Any:
    return PlanTask(
        number=record.number,
        parent=-1 if record.parent is None else record.parent,
        name=record.name,
        state=record.state,
        created=record.created,
        began=-1.0 if record.began is None else record.began,
        ended=-1.0 if record.ended is None else record.ended,
        arguments=record.facts.get("arguments", ""),
        result=record.result,
        failure=record.failure,
    )


# --- running a plan ---------------------------------------------------------------------------------------------------

WAKE_UP = "wakeup"
ROBOT_LIMIT = 60.0
"""s to wait for the driver, and until it has reached the robot."""
RETRY = 0.5
"""s between two tries: only the answer of the driver shows that it has reached the robot."""
END_LIMIT = 10.0
"""s that a plan may take to end when its node ends."""


class PlanRun:
    """A plan that runs once on a robot: by default that of this node's namespace. `trace` is there when it is over."""

    def __init__(
        self, robot: RobotLink | None = None, trace_file: Path | None = None, picture_file: Path | None = None
    ) -> None:
        self._robot = robot or this_robot()
        self._trace_file, self._picture_file = trace_file, picture_file
        self._root: Task | None = None
        self._over = threading.Event()
        self.trace: Trace | None = None

    def run(self, body: Branch, name: str = "") -> Any:
        """Run a plan with all process modules; its answer. The end of the node ends it, and stops the robot.

        If the process is killed instead, the servers see to that: those of the robot of `~pip` and `~pport`, by default
        the one of this namespace.
        """
        RosClock.wait_for_start()
        if GoalTracker.owners is None:
            ip, port = robot_address(argparse.Namespace(pip=None, pport=None), robot_beside)
            own_goals(OwnerLine(f"{ip}:{port}"))
        topic = PlanTopic()
        rospy.on_shutdown(self._end)
        try:
            with with_process_modules_running(*make_process_modules(self._robot)):
                return self._run_beside(body, name, topic)
        finally:
            topic.close()
            if self._root is not None:
                self.trace = trace_of(self._root)
                self._keep(self.trace)

    def _run_beside(self, body: Branch, name: str, topic: PlanTopic) -> Any:
        """Run the plan in a thread of its own: signals come to the main one, which then waits for the plan's end."""
        outcome: Future = Future()

        def work() -> None:
            try:
                outcome.set_result(top_level(body, name=name, clock=self._robot.clock, observers=[self._see, topic]))
            except BaseException as error:
                outcome.set_exception(error)
            finally:
                self._over.set()

        thread = threading.Thread(target=work, name="plan", daemon=True)
        thread.start()
        thread.join()
        return outcome.result()

    def _see(self, task: Task) -> None:
        self._root = task.tree.root

    def _end(self) -> None:
        if self._root is not None:
            self._root.evaporate("the node ends")
            # After this, topics are closed, and the end of a goal could not be published.
            self._over.wait(END_LIMIT)

    def _keep(self, trace: Trace) -> None:
        if self._trace_file is not None:
            write_whole(self._trace_file, trace.to_json() + "\n")
        if self._picture_file is not None:
            from .trace import save_picture  # Pillow takes its time

            save_picture(trace, self._picture_file)


def wake_up() -> None:
    """Have the robot stand with its motors on, which walking and moving need. Waits for the driver and the robot.

    Raises LowLevelFailure if the robot cannot be reached, or does not stand up.
    """
    deadline = time.monotonic() + ROBOT_LIMIT
    while True:
        try:
            rospy.wait_for_service(WAKE_UP, ROBOT_LIMIT)
            rospy.ServiceProxy(WAKE_UP, Empty)()
            return
        except rospy.ServiceException as error:  # the driver has not reached the robot yet
            if time.monotonic() > deadline:
                raise LowLevelFailure(f"the robot does not wake up: {error}") from error
        except rospy.ROSException as error:
            raise LowLevelFailure(f"there is no service {rospy.resolve_name(WAKE_UP)}: is a driver running?") from error
        time.sleep(RETRY)


def run_and_tell(plan: Branch, name: str = "", trace: str = "", picture: str = "", overwrite: bool = False) -> int:
    """Run a plan and print its tree; the exit status of a program that does nothing else.

    The plan does not run when a file exists already, unless `overwrite`. `trace`: file for the trace as JSON; empty for
    none. `picture`: file for its picture as PNG; empty for none.
    """
    try:
        trace_file, picture_file = (require_new(file, overwrite) if file else None for file in (trace, picture))
    except NoPlaceForFile as error:
        print(error, file=sys.stderr)
        return 1
    run = PlanRun(trace_file=trace_file, picture_file=picture_file)
    status = 0
    try:
        run.run(plan, name)
    except PlanFailure as failure:
        print(f"the plan failed: {failure}", file=sys.stderr)
        status = 1
    if run.trace is not None:
        print(run.trace)
        for file in filter(None, (trace_file, picture_file)):
            print(f"written: {file}")
    return status
