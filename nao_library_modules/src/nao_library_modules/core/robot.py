"""The robot for a module: proxies, connection, calls that can be interrupted, and running one library function."""

from __future__ import annotations

import inspect
import logging
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import naoqi
from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, CANCELLED_LIMIT, CLEAN_UP_LIMIT, STOPPED_LIMIT

from .chain import OF_THE_SERVER, FunctionChain, seconds
from .errors import BadGoal
from .fields import limit, number_parameter
from .process_owners import OwnerLine
from .waiting import CancellationToken

log = logging.getLogger(__name__)

# Most calls are answered within this time (s). Waiting for the answer alone is quicker than waiting for
# answer or interrupt, which then comes that much later at most.
QUICK_ANSWER = 0.005


class Robot:
    """Proxies of one robot; it connects in the background. Calls fail with a clear error until it is reached.

    Attributes:
        connection: The connection that all proxies share.
        address: `ip:port`, for texts.
        owners: Notes what this process starts on the robot.
    """

    def __init__(self, ip: str, port: int) -> None:
        self.address = f"{ip}:{port}"
        self.connection = naoqi.connection(ip, port, wait=False)
        self.owners = OwnerLine(self.address)
        self.connection.witness = self.owners.sending
        self._ip = ip
        self._port = port
        self._proxies: dict[str, Any] = {}
        self._lock = threading.Lock()

    def proxy(self, name: str) -> Any:
        """Proxy of a NAOqi module, the same object every time."""
        proxy = self._proxies.get(name)
        if proxy is None:
            with self._lock:
                proxy = self._proxies.setdefault(name, naoqi.ALProxy(name, self._ip, self._port, lazy=True))
        return proxy


class _Countdown:
    """Wakes a waiter when all calls are done, one failed, or the interrupt came."""

    def __init__(self, count: int) -> None:
        self._lock = threading.Lock()
        self._left = count
        self.event = threading.Event()

    def call_done(self, call: Any) -> None:
        """Count a call; runs in a thread of libqi."""
        with self._lock:
            self._left -= 1
            last = self._left == 0
        # Asking a finished call for its result does not block.
        if last or _error_of(call) is not None:
            self.event.set()


def _error_of(call: Any) -> NaoError | None:
    try:
        call.result(timeout=0)
    except NaoError as error:
        return error
    return None


def wait_for_calls(calls: Sequence[Any], interrupt: CancellationToken) -> list[Any]:
    """Wait until all calls are done, one fails, or an interrupt comes; then cancel those still running.

    Returns the results, in order. Raises NaoError of the first call that failed; Preempted, or whatever reason the
    interrupt has.
    """
    if not calls:
        return []
    if len(calls) == 1 and calls[0].wait(QUICK_ANSWER):
        return [calls[0].result(timeout=0)]
    countdown = _Countdown(len(calls))
    for call in calls:
        call.add_done_callback(countdown.call_done)
    with interrupt.waking(countdown.event.set):
        countdown.event.wait()  # no limit: the proxy layer fails calls to a lost robot
    running = [call for call in calls if not call.done()]
    if running:
        _cancel(running)
        interrupt.check()
        raise next(error for call in calls if call not in running for error in [_error_of(call)] if error)
    return [call.result(timeout=0) for call in calls]


def _cancel(calls: Iterable[Any]) -> None:
    """Cancel calls and see them end, so that they change nothing any more when clean-up begins."""
    calls = list(calls)
    ended = [threading.Event() for _ in calls]
    for call, event in zip(calls, ended):
        call.add_done_callback(lambda _, event=event: event.set())
        call.cancel()
    for event in ended:
        event.wait(STOPPED_LIMIT)


def ask(robot: Any, module: str, method: str, *arguments: Any, limit: float = ANSWER_LIMIT) -> Any:
    """Call a method of a NAOqi module and return its answer.

    `robot`: its proxies. `limit`: s that it may take. Raises NaoError if the robot refuses, cannot be
    asked, or takes longer.
    """
    return robot.proxy(module).call_async(method, *arguments).result(timeout=limit)


def run_task(call: Any, interrupt: CancellationToken, stop: Callable[[], None]) -> Any:
    """Wait for a call; an interrupt cancels it, and stops what it started if that is not enough.

    `stop` stops by other means what the call started, for robots whose calls cannot be cancelled; it may raise
    NaoError. The result of a call that has ended by the time of the interrupt counts. Raises NaoError if the call
    failed; Preempted, or whatever reason the interrupt has.
    """
    if not call.wait(QUICK_ANSWER):  # quicker than to set up the wait for both
        wait_for_call(call, interrupt)
    if not call.done():
        end_call(call, stop)
        interrupt.check()
    return call.result(timeout=0)


def end_call(call: Any, stop: Callable[[], None]) -> None:
    """Cancel a call and see it end, so that it changes nothing any more."""
    call.cancel()
    if call.wait(CANCELLED_LIMIT):
        return
    try:
        stop()
    except NaoError as error:
        log.warning("what was interrupted may go on: %s", error)
        return
    if not call.wait(STOPPED_LIMIT):
        log.warning("what was interrupted goes on: the robot did not end it within %g s", STOPPED_LIMIT)


def wait_for_call(call: Any, interrupt: CancellationToken, limit: float | None = None) -> bool:
    """Wait until a call is over, which it returns, or an interrupt comes; the call goes on in any case.

    `limit` is in s; without one it waits as long as it takes: the proxy layer fails calls to a lost robot.
    """
    news = threading.Event()
    call.add_done_callback(lambda _: news.set())
    with interrupt.waking(news.set):
        news.wait(limit)
    return call.done()


class FunctionRunner:
    """What library functions build on.

    Attributes:
        clock: Time for waits.
        interrupt: Ends whatever is waited for. Any thread may trigger it.
        chain: Reads chains for the function table.
        message_type: Type of the function messages, None where it is not known.
    """

    message_type: type | None = None

    def __init__(self, function_table: Mapping[str, Callable[..., Any]], clock: Any) -> None:
        """Keep table and clock.

        `function_table`: NAOqi function name -> callable; it may change later. `clock`: WallClock or RosClock.
        """
        self.clock = clock
        self.interrupt = CancellationToken()
        self.chain = FunctionChain(function_table)
        # Of each thread its own, so that functions may also be run outside of a goal.
        self._clean_up = threading.local()
        self._asking = threading.local()

    @contextmanager
    def asking(self) -> Iterator[None]:
        """In this thread, let calls to the robot go on whatever becomes of the goal that runs: they ask for facts."""
        self._asking.interrupt = CancellationToken()
        try:
            yield
        finally:
            del self._asking.interrupt

    def call(self, proxy: Any, method: str, *args: Any) -> Any:
        """Call a method of the robot; preemption ends the wait and cancels the method.

        Raises NaoError if the call fails; Preempted if a new goal, a cancel or the end of the node came first.
        """
        interrupt = getattr(self._asking, "interrupt", self.interrupt)
        interrupt.check()
        return wait_for_calls([proxy.call_async(method, *args)], interrupt)[0]

    def call_all(self, proxy: Any, method: str, arguments: Sequence[Sequence[Any]]) -> list[Any]:
        """Call a method several times at once and wait for all, as `call` does for one.

        Returns the results, in the order of the arguments.
        """
        interrupt = getattr(self._asking, "interrupt", self.interrupt)
        interrupt.check()
        return wait_for_calls([proxy.call_async(method, *args) for args in arguments], interrupt)

    def call_now(self, proxy: Any, method: str, *args: Any) -> Any:
        """Call a quick method that preemption must not end, as clean-up needs it.

        Raises NaoError if the call fails or takes longer than two seconds.
        """
        return proxy.call_async(method, *args).result(timeout=CLEAN_UP_LIMIT)

    def after_wait(self, action: Callable[[], None]) -> None:
        """Have something done when the running function and the wait after it are over, however they end.

        The last one left is done first. Raises RuntimeError if no function runs.
        """
        actions = getattr(self._clean_up, "actions", None)
        if actions is None:
            raise RuntimeError("after_wait is for functions that run() runs")
        actions.append(action)

    def args_of(self, message: Any) -> list[Any]:
        """Arguments for `run`: the fields of a function message that its function takes, checked.

        Raises UnknownFunction if there is no such function, BadGoal if a field will not do.
        """
        binding, context = self.chain.bind_one(message), {}
        args = binding.arguments(message, context)
        binding.run_check(message, context)
        return list(args)

    def before_run(self) -> None:
        """Called before each function."""

    def _args_of_fields(self, name: str, args: Sequence[Any], error: TypeError) -> list[Any]:
        """What a function takes of all the fields of its message but `function` and `time`, given in their order.

        `error`: the reason why it does not take `args` themselves. Raises BadGoal if they are not all fields, or one
        will not do.
        """
        fields = [] if self.message_type is None else self.message_type.__slots__
        for left_out in (("function", "time"), OF_THE_SERVER):  # on_error may be among them
            names = [field for field in fields if field not in left_out]
            if names and len(names) == len(args):
                return self.args_of(self.message_type(function=name, **dict(zip(names, args))))
        taken = f"{inspect.signature(self.chain.look_up(name))}: `args_of(message)` gives what it takes of a message"
        if names:
            taken += f"; or all fields: {', '.join(names)}"
        raise BadGoal("args", list(args), taken, problem=str(error)) from None

    def run(
        self,
        function: str,
        args: Sequence[Any],
        sleep_time: Any,
        on_answer: Callable[[Any], None] | None = None,
    ) -> Any:
        """Run one function, wait, and clean up.

        Returns what the function answers. Raises UnknownFunction if there is no such function; BadGoal if it takes
        other arguments; Preempted if a new goal, a cancel or the end of the node interrupts it.

        Args:
            function: Name in the function table.
            args: Arguments, in the order of its parameters; or all fields of a function message but `function` and
                `time`, in their order, of which it gets what it takes.
            sleep_time: Wait afterwards, in s or as a ROS duration.
            on_answer: Told the answer as soon as it is there, before the wait.
        """
        self.before_run()
        callable_ = self.chain.look_up(function)
        outer = getattr(self._clean_up, "actions", None)  # a function may run another one
        actions: list[Callable[[], None]] = []
        self._clean_up.actions = actions
        try:
            try:
                answer = callable_(*args)
            except TypeError:
                problem = _misfit(callable_, args)
                if problem is None:
                    raise
                answer = callable_(*self._args_of_fields(function, args, problem))
            if on_answer is not None:
                on_answer(answer)
            self.wait(seconds(sleep_time))
        except BaseException:
            self._undo(actions, quietly=True)
            raise
        else:
            self._undo(actions, quietly=False)
        finally:
            self._clean_up.actions = outer
        return answer

    def wait(self, duration: float) -> None:
        """Wait on ROS time. `duration`: s. Raises Preempted if it is interrupted."""
        if duration > 0.0 and not self.clock.wait(duration, self.interrupt):
            self.interrupt.check()

    def _undo(self, actions: list[Callable[[], None]], quietly: bool) -> None:
        while actions:
            action = actions.pop()
            try:
                action()
            except NaoError as error:
                # The error that ended the function is the one to tell; this one would hide it.
                if not quietly:
                    raise
                log.warning("clean-up failed: %s", error)


def _misfit(function: Callable[..., Any], args: Sequence[Any]) -> TypeError | None:
    """Why a function does not take these arguments; None if it does."""
    try:
        inspect.signature(function).bind(*args)
    except TypeError as error:
        return error
    return None


def require_start_patience(value: Any) -> float:
    return number_parameter("~start_patience", value, limit("wait"))


class StartupGrace:
    """Waits for a robot that has never been reached; for one that went away nobody waits.

    Any thread may wait. Time is that of the computer, for simulated time may not have begun. `patience`: s from now on
    for which goals wait.
    """

    def __init__(self, robot: Any, patience: float) -> None:
        self._robot = robot
        self._deadline = time.monotonic() + patience

    @property
    def expected(self) -> bool:
        """Whether the robot may still come for the first time."""
        connection = self._robot.connection
        never = connection.generation == 0 and connection.state == "connecting"
        return never and time.monotonic() < self._deadline

    def wait(self, interrupt: CancellationToken, tell: Callable[[str], None]) -> None:
        """Wait until the robot is there, the time is over, or something interrupts.

        `interrupt`: ends the wait. `tell`: gets what is waited for, "the robot at ...", if that takes any time.
        """
        if not self.expected or interrupt.is_set():
            return
        awaited = f"the robot at {self._robot.address}"
        limit = self._deadline - time.monotonic()
        log.info("a goal waits for %s, which was not reached yet: up to %.0f s more", awaited, limit)
        tell(awaited)
        changed = threading.Event()
        listener = lambda *_: changed.set()  # noqa: E731
        self._robot.connection.add_listener(listener)
        try:
            if self.expected:  # it may have come before the listener
                with interrupt.waking(changed.set):
                    changed.wait(limit)
        finally:
            self._robot.connection.remove_listener(listener)
