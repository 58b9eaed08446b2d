"""Fluents: values that plans wait for. CRAM's, in Python.

    position = Fluent("position", 0.0)
    wait_for(position > 1.5)                   # a network: computed again when `position` changes
    wait_for(fl_or(grasped, timed_out), timeout=5.0)

No change is missed between check and wait: a waiting task listens before it checks. A value that is gone again before
the next check is not seen, except by `pulsed(fluent)`, which remembers.
"""

from __future__ import annotations

import operator
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable
from functools import reduce
from typing import Any, Callable

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
