"""Running one library function: its calls to the robot, the wait afterwards, and clean-up."""

from __future__ import annotations

import inspect
import logging
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import CLEAN_UP_LIMIT

from ..base.cancellation import CancellationToken
from ..base.errors import BadGoal
from ..robot.robot import wait_for_calls
from .chain import OF_THE_SERVER, FunctionChain, seconds

log = logging.getLogger(__name__)


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
