"""What all modules share: function table, chains of functions, preemption, memory functions, launch file."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from typing import Any

from genpy import Duration

from nao_library_msgs.msg import FunctionResult
from naoqi.errors import NaoError

from .answers import Outcome, values_of
from .errors import FunctionFailed, Preempted, RobotLost
from .event_relay import EventRelay
from .function_chain import Step
from .function_runner import FunctionRunner
from .health import GoalCounter, connection_report, launch_report
from .launcher import LaunchPath, launch_supervisor
from .memory_functions import MEMORY, MemoryFunctions
from .robot import Robot
from .supervisor import Supervisor

log = logging.getLogger(__name__)

SHUTDOWN_LIMIT = 3.0
"""s that the end of the node waits for the running function to be interrupted and cleaned up."""


class NaoBasic(FunctionRunner, MemoryFunctions):
    """Base of the modules: carries out goals that are chains of function messages.

    A module fills `function_table` and ends its constructor with `self.serve(...)`. A library function takes
    the message fields it needs by name, calls long robot methods through `self.call` (preemption ends them),
    and leaves what must be undone with `self.after_wait`.

    Threads: goals run in the thread of the action server. Preemption, the connection's listener and the end
    of the node come from others; they touch nothing but `interrupt`.

    Attributes:
        ip: Address of the robot.
        port: Port of its NAOqi.
        function_table: NAOqi function name -> callable.
        robot: Proxies and connection.
        clock: Time for waits.
        interrupt: Ends whatever the module waits for.
        server: The action server, None before `serve`.

    ROS API:
        Action as named in `serve`. Publishes `memory_events` (nao_library_msgs/MemoryEvent) and
        `/diagnostics`.
    """

    typed_answers: frozenset[str] = frozenset()
    """Functions whose answers have fields of their own in the result, so that they stay out of memList."""

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        robot: Any = None,
        edge: Any = None,
    ) -> None:
        """Connect in the background; the robot need not be there yet.

        Args:
            ip: Address of the robot.
            port: Port of its NAOqi.
            autostart: Whether to start the launch file at once.
            launchpath: `(package, launchfile)` that belongs to the module.
            robot: Proxies and connection, where not those of ip and port.
            edge: ROS side, where not that of this process's node.

        Raises:
            BadLaunchPath: If the launch file is to be started and is not there.
        """
        if edge is None:
            from .ros_edge import RosEdge

            edge = RosEdge()
        self.ip = ip
        self.port = port
        self.launchpath = launchpath
        self.robot = robot or Robot(ip, port)
        self.server: Any = None
        self.function_table: dict[str, Callable[..., Any]] = {}
        super().__init__(self.function_table, edge.clock)
        self.events = EventRelay(lambda: self.robot.proxy(MEMORY), edge.event_sink())
        self.function_table.update(self.memory_functions())
        self._edge = edge
        self._goals = GoalCounter()
        self._idle = threading.Event()
        self._idle.set()
        self._launch: Supervisor | None = None
        self._diagnostics: Any = None
        self.robot.connection.add_listener(self._connection_changed)
        edge.on_shutdown(self.shut_down)
        if autostart:
            self.start_launch()

    # The life of a module

    def serve(self, name: str, action: type) -> None:
        """Start the action server and the diagnostics: the last line of a module's constructor.

        Args:
            name: Relative name of the action.
            action: Its type; the first field of the goal is the array of function messages.
        """
        self._feedback_type = type(action().action_feedback.feedback)
        self.server = self._edge.action_server(name, action, self.execute_cb, self.interrupt.trigger)
        self.server.start()
        reports = {
            f"{name} robot": lambda: connection_report(self.robot.address, self.robot.connection),
            f"{name} goals": self._goals.report,
        }
        if self.launchpath is not None:
            reports[f"{name} launch file"] = lambda: launch_report(self._launch)
        self._diagnostics = self._edge.publish_diagnostics(self.robot.address, reports)

    def start_launch(self) -> None:
        """Start the launch file and keep it running.

        Raises:
            BadLaunchPath: If `launchpath` names no launch file.
        """
        if self._launch is None:
            self._launch = launch_supervisor(self.launchpath, self.ip, self.port, self._edge.namespace)
        self._launch.start()

    def stop_launch(self) -> None:
        """Stop the launch file and everything it started."""
        if self._launch is not None:
            self._launch.stop()

    def shut_down(self) -> None:
        """End: interrupt the running function, let it clean up, unsubscribe, stop the launch file."""
        self.interrupt.stop()
        if not self._idle.wait(SHUTDOWN_LIMIT):
            log.warning("a function did not end within %g s", SHUTDOWN_LIMIT)
        self.robot.connection.remove_listener(self._connection_changed)
        self.events.close()
        self.stop_launch()
        if self._diagnostics is not None:
            self._diagnostics.close()

    # Goals

    def execute_cb(self, goal: Any) -> None:
        """Carry out a goal: check the whole chain, run its functions, set the end state and the result."""
        self._idle.clear()
        try:
            self.interrupt.clear()
            # The request may have come before `clear`, even before this goal was taken up.
            if self.server.is_preempt_requested():
                self.interrupt.trigger()
            self.begin_chain()
            outcomes: list[Outcome] = []
            end, text = self._run_chain(goal, outcomes)
            self.end_chain(end)
            result = self.server.get_default_result()
            try:
                self.fill_result(result, outcomes)
            except NaoError as error:
                if end == "succeeded":
                    end, text = "aborted", f"all functions were done, but the result is incomplete: {error}"
                else:
                    log.debug("the result is incomplete: %s", error)  # the text says what ended the goal
            self._goals.ended(end, text)
            getattr(self.server, f"set_{end}")(result, text)
        finally:
            self.interrupt.clear()
            self._idle.set()

    def begin_chain(self) -> None:
        """Called before a chain is checked. For modules that keep account of what a chain does."""

    def end_chain(self, end: str) -> None:
        """Called when a chain is over, before its result is filled. For what must not outlive a chain that failed.

        Args:
            end: "succeeded", "aborted" or "preempted".
        """

    def begin_check(self, position: int) -> None:
        """Called before the function at a place of the chain, counted from 1, is checked."""

    def steps_to_run(self, goal: Any, steps: Sequence[Step], outcomes: list[Outcome]) -> Sequence[Step]:
        """What of a checked chain is to be run: all of it.

        For modules whose goals can ask for less.

        Args:
            goal: The goal.
            steps: The whole chain.
            outcomes: Where answers go of what is not run.
        """
        return steps

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Fill the result message. Modules with more fields extend it.

        Args:
            result: Result with at least the fields `memList` and `results`.
            outcomes: What was done.

        Raises:
            NaoError: If the robot cannot be asked; the goal is aborted then.
        """
        result.results = [FunctionResult(o.function, o.values, Duration.from_sec(o.elapsed)) for o in outcomes]
        result.memList = [value for o in outcomes if o.function not in self.typed_answers for value in o.values]

    def _run_chain(self, goal: Any, outcomes: list[Outcome]) -> tuple[str, str]:
        messages = getattr(goal, goal.__slots__[0])
        position, function = 0, ""
        try:
            self.interrupt.check()
            steps = self.steps_to_run(goal, self.chain.read(messages, self.begin_check), outcomes)
            for step in steps:
                position, function = step.position, step.function
                self.interrupt.check()
                self._tell_progress(step.position, step.function, len(steps))
                began = self.clock.now()

                def note(answer: Any, step: Any = step, began: float = began) -> None:
                    elapsed = max(0.0, self.clock.now() - began)
                    outcomes.append(Outcome(step.position, step.function, values_of(answer), elapsed))

                self.run(step.function, step.args, step.sleep_time, note)
        except Preempted:
            return "preempted", f"preempted in function {position} ({function})" if position else "preempted"
        except Exception as error:
            if position:
                error = FunctionFailed(position, function, error)
            cause = error.cause if isinstance(error, FunctionFailed) else error
            if isinstance(cause, NaoError):
                return "aborted", str(error)
            log.error("unexpected error: %s", error, exc_info=cause)
            return "aborted", str(error) if error is not cause else f"unexpected error: {error!r}"
        return "succeeded", ""

    def _tell_progress(self, position: int, function: str, count: int) -> None:
        self.server.publish_feedback(self._feedback_type(index=position - 1, function=function, count=count))

    # The connection

    def _connection_changed(self, *_: Any) -> None:
        """Called from the thread that the connection has for its listeners; they may call the robot."""
        connection = self.robot.connection
        if connection.state == "connected":
            if connection.generation > 1:
                self.events.renew()
        elif connection.state == "lost":
            # A function that only waits would otherwise not notice.
            self.interrupt.trigger(RobotLost(self.robot.address, connection.last_error or "no answer"))
