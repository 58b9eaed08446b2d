"""Fluents: values that plans wait for. CRAM's, in Python.

    position = Fluent("position", 0.0)
    wait_for(position > 1.5)                   # a network: it is worked out anew when `position` changes
    wait_for(fl_or(grasped, timed_out), timeout=5.0)

A change is never missed between looking and waiting: who waits listens before he looks. What comes and goes before
he looks again is not seen, unless he waits for `pulsed(fluent)`, which remembers.
"""

from __future__ import annotations

import operator
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, Callable

from .failures import PlanError

Listener = Callable[[], None]


class AnyFluent(ABC):
    """What plain fluents, pulses and networks have in common: a value, and listeners.

    Comparing and computing with `<`, `<=`, `>`, `>=`, `+`, `-`, `*`, `/`, `&`, `|` and `~` makes networks. `==` stays
    Python's own (fluents are kept in sets): write `fluent.eq(value)`.

    Attributes:
        name: For people.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    @property
    @abstractmethod
    def value(self) -> Any:
        """The value now; any thread may ask."""

    @property
    @abstractmethod
    def pulses(self) -> int:
        """How often it has pulsed: a number that grows with every change, and with every `pulse`."""

    @abstractmethod
    def listen(self, listener: Listener) -> None:
        """Call something at every pulse, in the thread that makes the change: it has to be quick and may not wait."""

    @abstractmethod
    def unlisten(self, listener: Listener) -> None:
        """Call it no longer."""

    def eq(self, other: Any) -> AnyFluent:
        """True while the values are equal."""
        return fl_funcall(operator.eq, self, other, name=f"{self.name} == {_name(other)}")

    def __lt__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.lt, self, other, name=f"{self.name} < {_name(other)}")

    def __le__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.le, self, other, name=f"{self.name} <= {_name(other)}")

    def __gt__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.gt, self, other, name=f"{self.name} > {_name(other)}")

    def __ge__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.ge, self, other, name=f"{self.name} >= {_name(other)}")

    def __add__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.add, self, other, name=f"({self.name} + {_name(other)})")

    def __radd__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.add, other, self, name=f"({_name(other)} + {self.name})")

    def __sub__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.sub, self, other, name=f"({self.name} - {_name(other)})")

    def __rsub__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.sub, other, self, name=f"({_name(other)} - {self.name})")

    def __mul__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.mul, self, other, name=f"{self.name} * {_name(other)}")

    def __rmul__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.mul, other, self, name=f"{_name(other)} * {self.name}")

    def __truediv__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.truediv, self, other, name=f"{self.name} / {_name(other)}")

    def __rtruediv__(self, other: Any) -> AnyFluent:
        return fl_funcall(operator.truediv, other, self, name=f"{_name(other)} / {self.name}")

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
    """A value that can be set.

    Args:
        name: For people.
        value: The first value.
    """

    def __init__(self, name: str = "fluent", value: Any = None) -> None:
        super().__init__(name)
        self._lock = threading.Lock()
        self._value = value
        self._pulses = 0
        self._listeners: tuple[Listener, ...] = ()

    @property
    def value(self) -> Any:
        """The value; setting another one pulses, setting an equal one does nothing."""
        return self._value

    @value.setter
    def value(self, value: Any) -> None:
        with self._lock:
            same = _equal(self._value, value)
            self._value = value
            if same:
                return
            self._pulses += 1
            listeners = self._listeners
        for listener in listeners:
            listener()

    @property
    def pulses(self) -> int:
        """How often it has pulsed."""
        return self._pulses

    def update(self, change: Callable[[Any], Any]) -> Any:
        """Set the value to what `change` makes of it, without another change in between; the new value."""
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
        """Have all who listen look again, and count as a change, though the value stays."""
        with self._lock:
            self._pulses += 1
            listeners = self._listeners
        for listener in listeners:
            listener()

    def listen(self, listener: Listener) -> None:
        """Call something at every pulse."""
        with self._lock:
            self._listeners = (*self._listeners, listener)

    def unlisten(self, listener: Listener) -> None:
        """Call it no longer."""
        with self._lock:
            kept = list(self._listeners)
            kept.remove(listener)
            self._listeners = tuple(kept)


class Network(AnyFluent):
    """A fluent whose value follows from those of others; it is worked out when somebody asks.

    Args:
        function: Gets the present values of the arguments.
        arguments: Fluents and constants.
        name: For people.
    """

    def __init__(self, function: Callable[..., Any], arguments: Iterable[Any], name: str) -> None:
        super().__init__(name)
        self._function = function
        self._arguments = tuple(arguments)
        self._inputs = tuple(each for each in self._arguments if isinstance(each, AnyFluent))

    @property
    def value(self) -> Any:
        """What follows from the present values."""
        return self._function(*(value_of(each) for each in self._arguments))

    @property
    def pulses(self) -> int:
        """How often its inputs have pulsed."""
        return sum(each.pulses for each in self._inputs)

    def listen(self, listener: Listener) -> None:
        """Call something whenever an input pulses."""
        for each in self._inputs:
            each.listen(listener)

    def unlisten(self, listener: Listener) -> None:
        """Call it no longer."""
        for each in self._inputs:
            each.unlisten(listener)


class Pulsed(AnyFluent):
    """True from the pulse of a fluent until somebody takes it: a pulse is not missed because nobody looked.

    Args:
        fluent: Whose pulses count.
        missed: What `take` does with pulses that came since: "never" forgets them, "once" leaves one of them,
            "always" leaves them all.

    Raises:
        PlanError: `missed` is none of these.
    """

    def __init__(self, fluent: AnyFluent, missed: str = "once") -> None:
        if missed not in ("never", "once", "always"):
            raise PlanError(f"pulsed({fluent.name}): missed is {missed!r}: never, once or always")
        super().__init__(f"pulsed({fluent.name})")
        self._fluent = fluent
        self._missed = missed
        self._lock = threading.Lock()
        self._taken = fluent.pulses

    @property
    def value(self) -> bool:
        """Whether there is a pulse that nobody has taken."""
        return self._fluent.pulses > self._taken

    @property
    def pulses(self) -> int:
        """Those of the fluent."""
        return self._fluent.pulses

    def take(self) -> bool:
        """Take one pulse; whether there was one."""
        with self._lock:
            there = self._fluent.pulses
            if there == self._taken:
                return False
            self._taken = self._taken + 1 if self._missed == "always" else there
            return True

    def forget_missed(self) -> None:
        """What `missed` says of pulses that came while who took the last one was busy."""
        with self._lock:
            if self._missed == "never":
                self._taken = self._fluent.pulses

    def listen(self, listener: Listener) -> None:
        """Call something at every pulse."""
        self._fluent.listen(listener)

    def unlisten(self, listener: Listener) -> None:
        """Call it no longer."""
        self._fluent.unlisten(listener)


# --- networks ---------------------------------------------------------------------------------------------------------


def fl_funcall(function: Callable[..., Any], *arguments: Any, name: str = "") -> AnyFluent:
    """A network of any function of fluents and constants."""
    text = ", ".join(map(_name, arguments))
    return Network(function, arguments, name or f"{getattr(function, '__name__', 'function')}({text})")


def fl_and(*fluents: Any) -> AnyFluent:
    """The first value that is not true, or the last value; as Python's `and`."""
    return Network(_all, fluents, f"({' and '.join(map(_name, fluents))})")


def fl_or(*fluents: Any) -> AnyFluent:
    """The first value that is true, or the last value; as Python's `or`."""
    return Network(_any, fluents, f"({' or '.join(map(_name, fluents))})")


def fl_not(fluent: Any) -> AnyFluent:
    """True while a value is not."""
    return Network(operator.not_, [fluent], f"not {_name(fluent)}")


def fl_eq(first: Any, second: Any) -> AnyFluent:
    """True while two values are equal."""
    return Network(operator.eq, [first, second], f"{_name(first)} == {_name(second)}")


def fl_value_changed(fluent: AnyFluent) -> AnyFluent:
    """True as soon as the value is another one than now."""
    before = fluent.value
    return Network(lambda value: not _equal(value, before), [fluent], f"{fluent.name} changed")


def pulsed(fluent: AnyFluent, missed: str = "once") -> Pulsed:
    """A fluent that remembers pulses; see `Pulsed`."""
    return Pulsed(fluent, missed)


def value_of(thing: Any) -> Any:
    """The value of a fluent, or the thing itself."""
    return thing.value if isinstance(thing, AnyFluent) else thing


def _all(*values: Any) -> Any:
    for value in values:
        if not value:
            return value
    return values[-1] if values else True


def _any(*values: Any) -> Any:
    for value in values:
        if value:
            return value
    return values[-1] if values else False


def _equal(first: Any, second: Any) -> bool:
    """Whether a value stays the same; what cannot be compared in one word (arrays) changes whenever it is set."""
    if first is second:
        return True
    try:
        return bool(first == second)
    except Exception:
        return False


def _name(thing: Any) -> str:
    return thing.name if isinstance(thing, AnyFluent) else repr(thing)
