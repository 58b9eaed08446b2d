"""NaoBasic, and what the action servers share."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, MutableMapping, Sequence
from functools import wraps
from typing import Any, ClassVar

from genpy import Duration, Time
from roslib.message import get_message_class

from nao_library_msgs.msg import FunctionResult
from nao_library_msgs.srv import CheckGoals
from naoqi.errors import NaoError
from naoqi.limits import START_PATIENCE, Timing

from .core.chain import ChainStep, FunctionTable, Part, bound, copied, joined, require_callable
from .core.describe import CHECK, CheckService, Choices, DescribeService, Description
from .core.errors import FunctionFailed, Preempted, RobotLost, cut
from .core.goal_checks import GoalCheck, check_goals
from .core.health import BodyReporter, GoalCounter, Report, connection_report, launch_report
from .core.memory_functions import MEMORY, MemoryFunctions, Outcome, values_of
from .core.processes import LaunchPath, Supervisor, close_all, launch_supervisor
from .core.robot import FunctionRunner, Robot, StartupGrace
from .core.robot_events import EventRelay, RobotClock
from .core.server_types import names_of, require_fields

log = logging.getLogger(__name__)

SHUTDOWN_LIMIT = 3.0
"""s that the end of the node waits for the running function to be interrupted and cleaned up."""


class NaoBasic(FunctionRunner):
    """Base of the modules: carries out goals that are chains of function messages.

    A module fills `function_table` and has an action server: it ends its constructor with `self.serve(...)`, or makes
    one itself and keeps it in `server`. `execute_cb` may be overridden; it runs functions through `run`. A library
    function takes the message fields it needs by name, or all in their order as `*args`, calls long robot methods
    through `self.call` (preemption ends them), and leaves what must be undone with `self.after_wait`.

    Threads: goals run in the thread of the action server. Preemption, the connection's listener and the end
    of the node come from others; they touch nothing but `interrupt`.

    Attributes:
        ip: Address of the robot.
        port: Port of its NAOqi.
        function_table: NAOqi function name -> callable. It may be declared in the class, with functions of the class
            as values, and changed or replaced at any time; the functions of the robot's memory are always in it.
        robot: Proxies and connection.
        clock: Time for waits.
        robot_clock: Turns times of the robot into ROS time.
        happened: ROS times, s, at which what the running function waits for or does in the world began and ended (a
            word, a touch, a sound); 0: not known. A function may set it; its result tells it.
        interrupt: Ends whatever the module waits for.
        server: The action server, None before there is one.

    ROS API:
        Action as named in `serve`, and beside it the services NAME/describe (nao_library_msgs/DescribeFunctions) and
        NAME/check (nao_library_msgs/CheckGoals).
        Publishes `memory_events` (nao_library_msgs/MemoryEvent) and `/diagnostics`.
    """

    typed_answers: frozenset[str] = frozenset()
    """Functions whose answers have fields of their own in the result, so that they stay out of memList."""
    without_robot: frozenset[str] = frozenset()
    """Functions that do not need the robot: a goal of nothing else never waits for it."""
    left_by_goals: frozenset[str] = frozenset()
    """Attributes that checks look at and goals change: what is stored, loaded, running."""
    functions: ClassVar[Mapping[str, Callable[..., Any]]] = {}
    """NAOqi function name -> function of the class: the table that it declares."""
    part_types: ClassVar[tuple[type[Part], ...]] = ()
    """Classes of the parts that have functions; the constructor gives one of each to `add_parts`."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Take over the table that a class declares."""
        super().__init_subclass__(**options)
        table = cls.__dict__.get("function_table")
        if isinstance(table, Mapping):
            cls.functions = table
            del cls.function_table  # the property is in its place again

    @classmethod
    def own_functions(cls) -> dict[str, Callable[..., Any]]:
        """The functions that the class declares, and those that it inherits from before NaoBasic."""
        own: dict[str, Callable[..., Any]] = {}
        for kind in cls.__mro__:
            for name, function in vars(kind).get("functions", {}).items():
                own.setdefault(name, function)
        return own

    @classmethod
    def declared_functions(cls) -> dict[str, Callable[..., Any]]:
        """The functions of the class, of its parts, and of classes above it; without those of the robot's memory."""
        own = cls.own_functions()
        here = {name: own[name] for name in vars(cls).get("functions", ())}
        return {**here, **joined(cls.part_types), **own}

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        robot: Any = None,
        node: Any = None,
        start_patience: float = START_PATIENCE,
        kept: Any = None,
        patience: float | None = None,
    ) -> None:
        """Connect in the background; the robot need not be there yet.

        Raises BadLaunchPath if the launch file is to be started and is not there.

        Args:
            ip: Address of the robot.
            port: Port of its NAOqi.
            autostart: Whether to start the launch file at once.
            launchpath: `(package, launchfile)` that belongs to the module; the attribute may be set at any time.
            robot: Proxies and connection, where not those of ip and port.
            node: ROS side, where not that of this process's node.
            start_patience: s from now on for which goals wait for a robot that has never been reached.
            kept: Where what goals set up is kept beyond the death of the node, where not in the file of the node.
            patience: s that the robot may be silent before it is lost; None: as it is, 20 at first.
        """
        if not isinstance(autostart, bool):
            raise NaoError(f"autostart is {autostart!r}: True or False")
        if node is None:
            from .ros.server_node import ServerNode

            node = ServerNode()
        self.ip = ip
        self.port = port
        self.launchpath = launchpath
        self.robot = robot or Robot(ip, port)
        if patience is not None:
            self.robot.connection.timing = Timing(patience=patience)
        self.server: Any = None
        self._served: Any = None  # the server that `serve` made
        self._heeded: Any = None  # the server of the module's own whose preemption ends waits
        super().__init__(self.function_table, node.clock)
        self.robot_clock = RobotClock(self.robot, node.clock)
        self.happened = (0.0, 0.0)
        self._remarks: list[str] = []
        self.events = EventRelay(lambda: self.robot.proxy(MEMORY), node.event_sink())
        self.parts: tuple[Part, ...] = ()
        memory = MemoryFunctions(lambda: self.robot.proxy(MEMORY), self.call, self.events)
        self.function_table.maps[1].update(bound(memory, memory.functions))
        self._failures: list[Outcome] = []
        self._node = node
        self.kept = kept or node.kept()
        self._goals = GoalCounter()
        self._startup_grace = StartupGrace(self.robot, start_patience)
        self._progress = (0, "", 0)  # index of the function that began last, its name, how many the chain has
        self._running: tuple[tuple[str, ...], int] = ((), 0)  # functions of the goal that runs, and the one that does
        self._idle = threading.Event()
        self._idle.set()
        self._ready = threading.Event()
        self._launch: Supervisor | None = None
        self._launched: LaunchPath | None = None
        self._diagnostics: Any = None
        self.own_reports: dict[str, Callable[[], Report]] = {}  # on /diagnostics, by name; filled before `serve`
        self._first_ends: list[Callable[[], Any]] = []
        self._last_ends: list[Callable[[], Any]] = []
        self.robot.connection.add_listener(self._on_connection)
        node.on_shutdown(self.shut_down)
        if autostart:
            self.start_launch()

    # The life of a module

    @property
    def function_table(self) -> MutableMapping[str, Callable[..., Any]]:
        """The module's own functions, over those of the robot's memory."""
        table = self.__dict__.get("_function_table")
        if table is None:
            table = self._function_table = FunctionTable({}, {})
            table.update(bound(self, self.own_functions()))
        return table

    @function_table.setter
    def function_table(self, table: MutableMapping[str, Callable[..., Any]]) -> None:
        if table is not self.function_table:  # as |= gives it back
            for name, function in table.items():
                require_callable(name, function)
            self.function_table.maps[0] = table

    def add_parts(self, *parts: Part) -> None:
        """Take in parts: their functions, and what checks without a goal must copy. Before `serve`.

        `parts`: one of each class in `part_types`, and those without functions that they share.
        """
        self.parts += parts
        for part in parts:
            for name, function in bound(part, part.functions).items():
                self.function_table.maps[0].setdefault(name, function)

    def serve(self, name: str, action: type) -> None:
        """Start the action server, its services and the diagnostics: the last line of a module's constructor.

        `name`: relative name of the action. `action`: its type; the first field of the goal is the array of function
        messages. Raises NaoError if it lacks a field that servers need.
        """
        require_fields(action)
        self.chain.server = name
        self._take_types(action)
        self.server = self._served = self._node.action_server(name, action, self._execute, self.interrupt.trigger)
        self.server.start()
        reports = {
            f"{name} robot": lambda: connection_report(self.robot.address, self.robot.connection),
            f"{name} NAO": BodyReporter(self.robot).report,
            f"{name} goals": self._goals.report,
        }
        reports.update({f"{name} {what}": report for what, report in self.own_reports.items()})
        if self.launchpath is not None:
            reports[f"{name} launch file"] = lambda: launch_report(self._launch)
        self._diagnostics = self._node.publish_diagnostics(self.robot.address, reports)
        choices = Choices(self.robot, self.argument_choices)
        description = DescribeService(
            lambda: Description(self.function_table, type(self), action, choices.of), self.robot, lambda: self._running
        )
        check = CheckService(self, action)
        for each in names_of(name):
            self._node.serve_description(each, description.answer)
            self._node.serve(each + CHECK, CheckGoals, check.answer)
        self._tell_ready()

    def _take_types(self, action: type) -> None:
        spec = action()
        self._feedback_type = type(spec.action_feedback.feedback)
        self.message_type = get_message_class(spec.action_goal.goal._slot_types[0].partition("[")[0])

    def _tell_ready(self) -> None:
        """Say once that goals are carried out from now on: the server is there, and the robot."""
        if self.chain.server and self.robot.connection.state == "connected" and not self._ready.is_set():
            self._ready.set()
            log.info("%s is ready, with the robot at %s", self.chain.server, self.robot.address)

    def start_launch(self) -> None:
        """Start the launch file and keep it running, instead of one that was started for another `launchpath`.

        Raises BadLaunchPath if `launchpath` names no launch file; what runs goes on.
        """
        if self._launch is None or self._launched != self.launchpath:
            new = launch_supervisor(self.launchpath, self.ip, self.port, self._node.namespace)
            self.stop_launch()
            self._launch, self._launched = new, self.launchpath
        self._launch.start()

    def stop_launch(self) -> None:
        """Stop the launch file and everything it started."""
        if self._launch is not None:
            self._launch.stop()

    def at_end(self, *steps: Callable[[], Any], first: bool = False) -> None:
        """Have the end of the node do something more.

        To be called as soon as there is what is to be ended: a node may be ended while its module is being made. A step
        that needs the robot is made `with_robot`. `first`: before the function that runs is interrupted.
        """
        (self._first_ends if first else self._last_ends).extend(steps)

    def shut_down(self) -> None:
        """Run every step of the end, even if one fails."""
        try:
            steps = self.shutdown_steps()
        except Exception:  # of a module of a user's own, which is still being made
            log.exception("%s.shutdown_steps failed: the module ends without what it adds", type(self).__name__)
            steps = NaoBasic.shutdown_steps(self)
        close_all(*steps)

    def shutdown_steps(self) -> list[Callable[[], Any]]:
        """What the end of the node does, in order. Modules add to it by `at_end`."""
        steps = [self.end_function, self.kept.forget, self._stop_listening, self.events.close, self.stop_launch]
        if self._diagnostics is not None:
            steps.append(self._diagnostics.close)
        return [*self._first_ends, *steps, *self._last_ends]

    def with_robot(self, step: Callable[[], Any]) -> Callable[[], Any]:
        """A step of the end that is left out when there is no connection to the robot."""

        @wraps(step)
        def guarded() -> None:
            if self.robot.connection.state == "connected":
                step()

        return guarded

    def _stop_listening(self) -> None:
        self.robot.connection.remove_listener(self._on_connection)

    def end_function(self) -> None:
        """Interrupt the running function, and let it clean up."""
        self.interrupt.stop()
        if not self._idle.wait(SHUTDOWN_LIMIT):
            log.warning("a function did not end within %g s", SHUTDOWN_LIMIT)

    # Goals

    def _execute(self, goal: Any) -> None:
        """What is around `execute_cb`, also around one of the module's own."""
        self._idle.clear()
        try:
            self._heed(self.server)
            self.execute_cb(goal)
        except Preempted:
            self.server.set_preempted(self.server.get_default_result(), "preempted")
        except NaoError as error:
            self.server.set_aborted(self.server.get_default_result(), str(error))
        finally:
            self._running = ((), 0)
            self.interrupt.clear()
            self._idle.set()

    def _heed(self, server: Any) -> None:
        self.interrupt.clear()
        # The request may have come before `clear`, even before this goal was taken up.
        if server.is_preempt_requested():
            self.interrupt.trigger()

    def execute_cb(self, goal: Any) -> None:
        """Carry out a goal: check the whole chain, run its functions, set the end state and the result."""
        self.before_run()
        self._await_robot(goal)
        self.begin_chain()
        outcomes: list[Outcome] = []
        self._failures = []
        self._remarks = []
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

    def before_run(self) -> None:
        """Have preemption of an action server that the module has made itself end what runs."""
        server = self.server
        if server is self._served:
            return
        if self._heeded is not server:
            theirs = server.preempt_callback

            def preempt() -> None:
                self.interrupt.trigger()
                if theirs is not None:
                    theirs()

            server.register_preempt_callback(preempt)
            self._take_types(server.action_server.ActionSpec)
            self._heeded = server
        self._heed(server)

    def begin_chain(self) -> None:
        """Called before a chain is checked. For modules that keep account of what a chain does."""

    def end_chain(self, end: str) -> None:
        """Called when a chain is over, before its result is filled. For what must not outlive a chain that failed.

        `end`: "succeeded", "aborted" or "preempted".
        """

    def begin_check(self, position: int) -> None:
        """Called before the function at a place of the chain, counted from 1, is checked."""

    # Checks without a goal

    @property
    def busy(self) -> bool:
        """Whether a goal runs."""
        return not self._idle.is_set()

    def check(self, *goals: Any) -> GoalCheck:
        """What is wrong with goals, by the checks that come before the first function. Nothing is done; any thread.

        `goals`: in the order in which they would be sent.
        """
        return check_goals(self, goals)

    def view_for_checks(self) -> Any:
        """This module as the checks see it that belong to no goal: what they note does not reach the goal that runs."""
        copies = copied((self, *self.parts))
        for part in self.parts:
            copies[id(part)].prepare_for_checks()
        view = copies[id(self)]
        view.copies = copies
        return view

    def begin_goal_check(self, now: bool) -> None:
        """Called for such a view before the chain of each goal is checked.

        `now`: whether the goal finds the robot as it is at this moment.
        """

    def argument_choices(self, function: str, field: str) -> Sequence[str]:
        """Words that a field of a function may hold, for its description: none.

        For modules that have names of their own, such as stored files. Called from threads of clients.
        """
        return ()

    def steps_to_run(self, goal: Any, steps: Sequence[ChainStep], outcomes: list[Outcome]) -> Sequence[ChainStep]:
        """What of a checked chain is to be run: all of it.

        For modules whose goals can ask for less. `steps`: the whole chain. `outcomes`: where answers go of what is not
        run.
        """
        return steps

    @property
    def running_function(self) -> str:
        """Name of the function that a goal runs; empty while none does."""
        names, index = self._running
        return names[index] if names else ""

    def remark(self, text: str) -> None:
        """Have the text of the goal say something if it succeeds, of the function that runs."""
        names, index = self._running
        self._remarks.append(f"function {index + 1} ({names[index]}): {text}" if len(names) > 1 else text)

    def publish_feedback(self, **fields: Any) -> None:
        """Publish how far the chain is. Any thread.

        `fields`: what else the feedback of the module's action has; `stamp`: ROS time of what it tells, s, if that is
        not now.
        """
        index, function, count = self._progress
        self._send_feedback(index=index, function=function, count=count, **fields)

    def _send_feedback(self, stamp: float | None = None, **fields: Any) -> None:
        feedback = self._feedback_type(**fields)
        if hasattr(feedback, "stamp"):  # an action of a user's own may do without
            feedback.stamp = Time.from_sec(self.clock.now() if stamp is None else stamp)
        self.server.publish_feedback(feedback)

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Fill the result message. Modules with more fields extend it.

        `result`: result with at least the fields `memList` and `results`. `outcomes`: what was done. Raises NaoError if
        the robot cannot be asked; the goal is aborted then.
        """
        told = sorted([*outcomes, *self._failures], key=lambda outcome: outcome.position)
        result.results = [_result_of(outcome) for outcome in told]
        result.memList = [value for o in outcomes if o.function not in self.typed_answers for value in o.values]

    def _await_robot(self, goal: Any) -> None:
        """Wait for a robot that has never been there; a goal that is wrong in any case is not kept waiting."""
        messages = getattr(goal, goal.__slots__[0])
        names = tuple(message.function for message in messages)
        if self.without_robot.issuperset(names) or not self._startup_grace.expected:
            return
        try:
            self.chain.bind(messages)
        except NaoError:
            return  # the chain is read once more, and then it is told
        self._running = (names, 0)
        self._startup_grace.wait(
            self.interrupt, lambda awaited: self._send_feedback(count=len(messages), waiting=awaited)
        )

    def _run_chain(self, goal: Any, outcomes: list[Outcome]) -> tuple[str, str]:
        messages = getattr(goal, goal.__slots__[0])
        position, function = 0, ""
        try:
            self.interrupt.check()
            steps = self.steps_to_run(goal, self.chain.read(messages, self.begin_check), outcomes)
            names = tuple(message.function for message in messages)
            for step in steps:
                position, function = step.position, step.function
                self.interrupt.check()
                self._running = (names, position - 1)
                self._run_step(step, len(steps), outcomes)
        except Preempted:
            return "preempted", f"preempted in function {position} ({function})" if position else "preempted"
        except Exception as error:
            return "aborted", _why(error, position, function)
        return "succeeded", "; ".join(self._remarks)

    def _run_step(self, step: ChainStep, count: int, outcomes: list[Outcome]) -> None:
        """Run one function of a chain, as often as its policy says."""
        for tries_left in range(step.policy.retries, -1, -1):
            self._tell_progress(step.position, step.function, count)
            self.happened = (0.0, 0.0)
            answered, began = len(outcomes), self.clock.now()
            try:
                told = lambda answer, began=began: outcomes.append(self._outcome(step, began, answer))  # noqa: E731
                self.run(step.function, step.args, step.sleep_time, told)
                return
            except Preempted:
                raise
            except Exception as error:
                only_clean_up = len(outcomes) > answered
                try:
                    # What ended the wait of all functions, as a robot that is gone, ends the chain as well.
                    self.interrupt.check()
                except NaoError as end:
                    if not only_clean_up:
                        self._note_failure(step, began, end)
                    raise
                if tries_left and not only_clean_up:
                    log.warning("%s failed and is tried again: %s", step.function, _told(error))
                    continue
                if not only_clean_up:
                    self._note_failure(step, began, error)
                if not step.policy.skip:
                    raise
                log.warning("%s failed, the chain goes on: %s", step.function, _told(error))
                return

    def _note_failure(self, step: ChainStep, began: float, error: Exception) -> None:
        self._failures.append(self._outcome(step, began, None, _told(error)))

    def _outcome(self, step: ChainStep, began: float, answer: Any, error: str = "") -> Outcome:
        elapsed = max(0.0, self.clock.now() - began)
        return Outcome(step.position, step.function, values_of(answer), elapsed, error, began, self.happened)

    def _tell_progress(self, position: int, function: str, count: int) -> None:
        self._progress = (position - 1, function, count)
        self.publish_feedback()

    # The connection

    def connected(self, again: bool) -> None:
        """Called when the robot is there; not before the module has its server, and so is complete.

        In the thread that the connection has for its listeners; they may call the robot. `again`: the connection was
        lost before: what was set up in the robot is gone.
        """

    def _on_connection(self, *_: Any) -> None:
        connection = self.robot.connection
        if connection.state == "connected":
            again = connection.generation > 1
            if again:
                self.events.renew()
            else:
                self._tell_ready()
            if self.server is not None:
                self.connected(again)
        elif connection.state == "lost":
            # A function that only waits would otherwise not notice.
            self.interrupt.trigger(RobotLost(self.robot.address, connection.last_error or "no answer"))


def _result_of(outcome: Outcome) -> FunctionResult:
    begin, end = outcome.began, outcome.began + outcome.elapsed
    times = (Time.from_sec(time) for time in (begin, end, *outcome.happened))
    return FunctionResult(outcome.function, outcome.values, Duration.from_sec(outcome.elapsed), outcome.error, *times)


def _why(error: Exception, position: int, function: str) -> str:
    """Why a chain ended; position 0: before its first function. What is no NaoError goes to the log.

    Not where the error was caught: a frame that keeps an error which has passed through it is kept by that error, and
    the whole goal with them, megabytes perhaps, until Python looks for such rings.
    """
    if position:
        error = FunctionFailed(position, function, error)
    cause = error.cause if isinstance(error, FunctionFailed) else error
    if isinstance(cause, NaoError):
        return str(error)
    log.error("unexpected error: %s", error, exc_info=cause)
    return str(error) if error is not cause else f"unexpected error: {error!r}"


def _told(error: Exception) -> str:
    return cut(str(error) if isinstance(error, NaoError) else f"unexpected error: {error!r}")
