"""Fluents: values that plans wait for, and the waiting itself. CRAM's, in Python.

    position = Fluent("position", 0.0)
    wait_for(position > 1.5)                   # a network: computed again when `position` changes
    wait_for(fl_or(grasped, timed_out), timeout=5.0)

No change is missed between check and wait: a waiting task listens before it checks. A value that is gone again before
the next check is not seen, except by `pulsed(fluent)`, which remembers.

Everything in a plan that takes time goes through `wait_until`: a plan can be ended, suspended and woken only there, and
where tasks begin and end. Code that blocks by other means cannot be interrupted. `Flow` is a thread of a plan.
"""

from __future__ import annotations

import operator
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import reduce
from typing import Any, Callable

from ..core.waiting import CancellationToken
from .failures import PlanError

Listener = Callable[[], None]


def _operator(function: Callable[[Any, Any], Any], text: str) -> Callable[[AnyFluent, Any], AnyFluent]:
    """The method for an operator whose left side is a fluent; `text` has its name."""
    return lambda left, right: fl_funcall(function, left, right, name=text.format(_name(left), _name(right)))


def _operators(function: Callable[[Any, Any], Any], text: str) -> tuple[Callable[[AnyFluent, Any], AnyFluent], ...]:
    """The methods for an operator, for fluents on its left and on its right side."""
    direct = _operator(function, text)
    return direct, lambda right, left: direct(left, right)


class AnyFluent(ABC):
    """A value and listeners: the base of plain fluents, pulses and networks.

    Comparing and computing with `<`, `<=`, `>`, `>=`, `+`, `-`, `*`, `/`, `&`, `|` and `~` makes networks. `==` stays
    Python's own (fluents are kept in sets): write `fluent.eq(value)`.

    `inputs`: what it is computed from: it pulses when they do.
    """

    def __init__(self, name: str, inputs: Iterable[AnyFluent] = ()) -> None:
        self.name = name
        self._inputs = tuple(inputs)

    @property
    @abstractmethod
    def value(self) -> Any:
        """The value now; thread-safe."""

    @property
    def pulses(self) -> int:
        """Number of changes and calls of `pulse` so far."""
        return sum(each.pulses for each in self._inputs)

    def listen(self, listener: Listener) -> None:
        """Call something at every pulse, in the thread of the change: it has to be quick and may not block."""
        for each in self._inputs:
            each.listen(listener)

    def unlisten(self, listener: Listener) -> None:
        """Call it no longer."""
        for each in self._inputs:
            each.unlisten(listener)

    def eq(self, other: Any) -> AnyFluent:
        """True while the values are equal."""
        return fl_eq(self, other)

    __lt__, __le__ = _operator(operator.lt, "{} < {}"), _operator(operator.le, "{} <= {}")
    __gt__, __ge__ = _operator(operator.gt, "{} > {}"), _operator(operator.ge, "{} >= {}")
    __add__, __radd__ = _operators(operator.add, "({} + {})")
    __sub__, __rsub__ = _operators(operator.sub, "({} - {})")
    __mul__, __rmul__ = _operators(operator.mul, "{} * {}")
    __truediv__, __rtruediv__ = _operators(operator.truediv, "{} / {}")

    def __and__(self, other: Any) -> AnyFluent:
        return fl_and(self, other)

    def __or__(self, other: Any) -> AnyFluent:
        return fl_or(self, other)

    def __invert__(self) -> AnyFluent:
        return fl_not(self)

    def __bool__(self) -> bool:
        raise PlanError(f"the fluent {self.name} is neither true nor false: ask its value, or wait_for it")

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}: {self.value!r}>"


class Fluent(AnyFluent):
    """A value that can be set."""

    def __init__(self, name: str = "fluent", value: Any = None) -> None:
        super().__init__(name)
        self._lock = threading.Lock()
        self._value = value
        self._pulses = 0
        self._listeners: tuple[Listener, ...] = ()

    @property
    def value(self) -> Any:
        """The value; setting a different one pulses, setting an equal one does nothing."""
        return self._value

    @value.setter
    def value(self, value: Any) -> None:
        self.update(lambda _: value)

    @property
    def pulses(self) -> int:
        return self._pulses

    def update(self, change: Callable[[Any], Any]) -> Any:
        """Set the value to `change(value)`, atomically; the new value."""
        with self._lock:
            old = self._value
            self._value = new = change(old)
            if _equal(old, new):
                return new
            self._pulses += 1
            listeners = self._listeners
        for listener in listeners:
            listener()
        return new

    def pulse(self) -> None:
        """Pulse although the value stays."""
        with self._lock:
            self._pulses += 1
            listeners = self._listeners
        for listener in listeners:
            listener()

    def listen(self, listener: Listener) -> None:
        with self._lock:
            self._listeners = (*self._listeners, listener)

    def unlisten(self, listener: Listener) -> None:
        with self._lock:
            kept = list(self._listeners)
            kept.remove(listener)
            self._listeners = tuple(kept)


class Network(AnyFluent):
    """A fluent computed from others, on request."""

    def __init__(self, function: Callable[..., Any], arguments: Iterable[Any], name: str) -> None:
        self._function = function
        self._arguments = tuple(arguments)
        super().__init__(name, (each for each in self._arguments if isinstance(each, AnyFluent)))

    @property
    def value(self) -> Any:
        return self._function(*(each.value if isinstance(each, AnyFluent) else each for each in self._arguments))


class Pulsed(AnyFluent):
    """True from the pulse of a fluent until it is taken: no pulse is missed.

    `missed`: pulses before `take`: "never" forgets them, "once" leaves one, "always" leaves all.
    """

    def __init__(self, fluent: AnyFluent, missed: str = "once") -> None:
        if missed not in ("never", "once", "always"):
            raise PlanError(f"pulsed({fluent.name}): missed is {missed!r}: never, once or always")
        super().__init__(f"pulsed({fluent.name})", [fluent])
        self._missed = missed
        self._lock = threading.Lock()
        self._taken = self.pulses

    @property
    def value(self) -> bool:
        return self.pulses > self._taken

    def take(self) -> bool:
        """Take one pulse; whether there was one."""
        with self._lock:
            there = self.pulses
            if there == self._taken:
                return False
            self._taken = self._taken + 1 if self._missed == "always" else there
            return True

    def forget_missed(self) -> None:
        """With "never", drop the pulses that came during the reaction to the last one."""
        with self._lock:
            if self._missed == "never":
                self._taken = self.pulses


# --- networks ---------------------------------------------------------------------------------------------------------


def fl_funcall(function: Callable[..., Any], *arguments: Any, name: str = "") -> AnyFluent:
    """A network of a function of fluents and constants."""
    text = ", ".join(map(_name, arguments))
    return Network(function, arguments, name or f"{getattr(function, '__name__', 'function')}({text})")


def fl_and(*fluents: Any) -> AnyFluent:
    """The first false value, or the last value; as Python's `and`."""
    name = f"({' and '.join(map(_name, fluents))})"
    return Network(lambda *values: reduce(lambda one, other: one and other, values, True), fluents, name)


def fl_or(*fluents: Any) -> AnyFluent:
    """The first true value, or the last value; as Python's `or`."""
    name = f"({' or '.join(map(_name, fluents))})"
    return Network(lambda *values: reduce(lambda one, other: one or other, values, False), fluents, name)


def fl_not(fluent: Any) -> AnyFluent:
    return Network(operator.not_, [fluent], f"not {_name(fluent)}")


def fl_eq(first: Any, second: Any) -> AnyFluent:
    return Network(operator.eq, [first, second], f"{_name(first)} == {_name(second)}")


def fl_value_changed(fluent: AnyFluent) -> AnyFluent:
    """True as soon as the value differs from the value now."""
    before = fluent.value
    return Network(lambda value: not _equal(value, before), [fluent], f"{fluent.name} changed")


def pulsed(fluent: AnyFluent, missed: str = "once") -> Pulsed:
    """A fluent that remembers pulses; see `Pulsed`."""
    return Pulsed(fluent, missed)


def _equal(first: Any, second: Any) -> bool:
    """Whether a value is the same; values without a single truth of equality (arrays) always differ."""
    if first is second:
        return True
    try:
        return bool(first == second)
    except Exception:
        return False


def _name(thing: Any) -> str:
    return thing.name if isinstance(thing, AnyFluent) else repr(thing)


# --- waiting: a thread of a plan --------------------------------------------------------------------------------------


_local = threading.local()


class Evaporated(BaseException):  # a signal that ends tasks, not an error
    """Ends a task from inside; `task` is the outermost one of this thread that has to end.

    Plans do not catch it; their clean-up belongs into `finally`.
    """

    def __init__(self, task: Any) -> None:
        super().__init__(task.path)
        self.task = task


class Interrupted(BaseException):  # a signal, as above
    """A suspension reached `retry_after_suspension`: its body ends, and begins again when the task is woken."""


class Flow:
    """A thread of a plan.

    Attributes:
        tasks: The tasks that it runs, the outermost first.
        deaf: Depth of `uninterrupted` blocks.
        restarting: Depth of `retry_after_suspension` blocks.
    """

    def __init__(self, clock: Any) -> None:
        self.clock = clock
        self.tasks: list[Any] = []
        self.deaf = 0
        self.restarting = 0
        self._signal = CancellationToken()

    def wake(self) -> None:
        """Re-evaluate the condition it waits for; any thread may call this."""
        self._signal.trigger()

    def check(self) -> None:
        """End here if the task is to end; pause here while it is suspended.

        Raises Evaporated if a task of this thread is to end; Interrupted if it is suspended, and inside of
        `retry_after_suspension`.
        """
        self._wait(lambda: True, None, waits=False)

    def wait(self, condition: Callable[[], Any], fluents: Iterable[AnyFluent], timeout: float | None) -> bool:
        fluents = tuple(fluents)
        for fluent in fluents:
            fluent.listen(self.wake)
        try:
            return self._wait(condition, timeout)
        finally:
            for fluent in fluents:
                fluent.unlisten(self.wake)

    def _wait(self, condition: Callable[[], Any], timeout: float | None, waits: bool = True) -> bool:
        while True:
            # Cleared before the look: what changes after it is seen in the next round.
            self._signal.clear()
            try:
                paused = not self.deaf and self._pauses()
            except Interrupted:
                if waits and condition():
                    return True  # it is done: nothing to begin again, and the task pauses when it goes on
                raise
            if paused:
                self._signal.wait(None)  # type: ignore[arg-type]
                continue
            if condition():
                return True
            if timeout is None:
                self._signal.wait(None)  # type: ignore[arg-type]
                continue
            if timeout <= 0.0:
                return False
            began = self.clock.now()
            self.clock.wait(timeout, self._signal)
            timeout -= max(self.clock.now() - began, 0.0)

    def _pauses(self) -> bool:
        """Whether it has to pause; raises if it has to end."""
        for task in self.tasks:
            if task.evaporating:
                raise Evaporated(task)
        paused = bool(self.tasks) and self.tasks[-1].suspended
        if paused and self.restarting:
            raise Interrupted
        return paused


def here() -> Flow | None:
    """The flow of this thread; None outside of plans."""
    return getattr(_local, "flow", None)


def set_here(flow: Flow | None) -> None:
    _local.flow = flow


def wait_until(condition: Callable[[], Any], fluents: Iterable[AnyFluent] = (), timeout: float | None = None) -> bool:
    """Wait for a condition, in a plan; whether it came true.

    `condition`: evaluated now, and at every pulse of a fluent. `timeout`: s of the plan's clock, without suspensions;
    None for no limit.
    """
    return _flow().wait(condition, fluents, timeout)


def checkpoint() -> None:
    """Let a plan that computes for long be ended and suspended here."""
    _flow().check()


def sleep(duration: float) -> None:
    """Wait, s of the plan's clock."""
    _flow().wait(lambda: False, (), duration)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Neither end nor suspend the task in this block: for clean-up in `finally`. Limit its waits."""
    flow = _flow()
    flow.deaf += 1
    try:
        yield
    finally:
        flow.deaf -= 1


def retry_after_suspension(body: Callable[[], Any]) -> Any:
    """Run a body that cannot pause: a suspension ends it, and it begins again when the task is woken.

    Its `finally` blocks run in between: a goal on the robot is cancelled and sent again.
    """
    flow = _flow()
    while True:
        flow.restarting += 1
        try:
            return body()
        except Interrupted:
            if flow.restarting > 1:
                raise  # the outermost body is the one that begins again
        finally:
            flow.restarting -= 1
        flow.check()


def _flow() -> Flow:
    flow = here()
    if flow is None:
        raise PlanError("this waits outside of a plan: begin it with top_level, or run_and_tell")
    return flow
