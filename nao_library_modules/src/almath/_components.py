"""The base of all values of this package: named numbers that are read, compared, listed and printed alike."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Sequence
from numbers import Real
from typing import Any, ClassVar, TypeVar

import numpy as np

from almath import _matrix


class AlmathError(ValueError):
    """A value that no position, rotation or function of this package can be made from.

    It stands apart from the errors of the `naoqi` package because `almath` must be importable on a machine
    without libqi; every message names the class or function, the value it was given and what it takes.
    """

    __module__ = "almath"  # from where it is imported, and what a trace shows


_Value = TypeVar("_Value", bound="Components")
_Vector = TypeVar("_Vector", bound="Scalable")
_Turn = TypeVar("_Turn", bound="Turning")


def as_number(value: object, what: str) -> float:
    """Return `value` as a float; AlmathError, which calls it `what`, if it is not a number."""
    if not isinstance(value, Real):
        raise AlmathError(f"{what} must be a number, got {value!r}")
    return float(value)


def as_numbers(values: object, what: str) -> list[float]:
    """Return a flat sequence of numbers as a list of floats; AlmathError, which calls it `what`, if it is none."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise AlmathError(f"{what} must be a sequence of numbers, got {values!r}")
    return [as_number(value, f"{what}[{index}]") for index, value in enumerate(values)]


def require(value: object, kind: type, where: str) -> None:
    """Check that an argument of `where`, a function or class, is of a class; AlmathError if it is not."""
    if not isinstance(value, kind):
        raise AlmathError(f"{where} takes a {kind.__name__}, got {value!r}")


class Components:
    """A mutable value made of named numbers.

    The names are those that a subclass annotates, in the order of `toVector`; `_defaults` has the values of a fresh
    object, zeros if it is not given. It can be made from nothing, from all its numbers, from one sequence of them
    (list, tuple, array) or from another object of its class, which is copied.
    """

    # numpy would otherwise take `numpy.float64(2) * pose` apart before our __rmul__ is asked.
    __array_ufunc__ = None

    _names: ClassVar[tuple[str, ...]] = ()
    _defaults: ClassVar[tuple[float, ...]] = ()
    _one_number_fills_all: ClassVar[bool] = False

    def __init_subclass__(cls) -> None:
        named = tuple(cls.__dict__.get("__annotations__", ()))
        if named:
            cls._names = named
            cls._defaults = cls.__dict__.get("_defaults", (0.0,) * len(named))

    def __init__(self, *numbers: object) -> None:
        self._assign(self._read(numbers))

    @classmethod
    def _read(cls, arguments: tuple[object, ...]) -> Iterable[float]:
        """Turn the arguments of the constructor into one number for each name."""
        if not arguments:
            return cls._defaults
        if len(arguments) == 1 and not isinstance(arguments[0], Real):
            if isinstance(arguments[0], cls):
                return arguments[0]._values()
            return cls._checked(as_numbers(arguments[0], cls.__name__))
        numbers = as_numbers(arguments, cls.__name__)
        if len(numbers) == 1 and cls._one_number_fills_all:
            return numbers * len(cls._names)
        return cls._checked(numbers)

    @classmethod
    def _checked(cls, numbers: list[float]) -> list[float]:
        """Return `numbers` if there is one for each name."""
        if len(numbers) != len(cls._names):
            names = ", ".join(cls._names)
            raise AlmathError(
                f"{cls.__name__} takes {len(cls._names)} numbers ({names}), got {len(numbers)}: {numbers}"
            )
        return numbers

    @classmethod
    def _make(cls: type[_Value], numbers: Iterable[float]) -> _Value:
        """Build an object from trusted numbers, past the constructor a subclass may have changed."""
        value = cls.__new__(cls)
        value._assign(numbers)
        return value

    def _assign(self, numbers: Iterable[float]) -> None:
        """Overwrite all components, in the order of `_names`."""
        vars(self).update(zip(self._names, map(float, numbers)))

    def _values(self) -> list[float]:
        """List the components in the order of `_names`."""
        return [getattr(self, name) for name in self._names]

    def _require_same(self, other: object, method: str) -> None:
        if not self._same_kind(other):
            name = type(self).__name__
            raise AlmathError(f"{name}.{method} takes a {name}, got {other!r}")

    def _same_kind(self, other: object) -> bool:
        return isinstance(other, type(self)) or (isinstance(other, Components) and isinstance(self, type(other)))

    def __setattr__(self, name: str, value: object) -> None:
        """Set a component, which must be a number, or any other attribute."""
        if name in self._names:
            value = as_number(value, f"{type(self).__name__}.{name}")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        if not self._same_kind(other):
            return NotImplemented
        return self._values() == other._values()

    # Mutable values compared by content cannot be keys.
    __hash__ = None

    def isNear(self: _Value, other: _Value, epsilon: float = 0.0001) -> bool:
        """Tell whether no component differs by more than `epsilon`."""
        self._require_same(other, "isNear")
        return all(abs(mine - theirs) <= epsilon for mine, theirs in zip(self._values(), other._values()))

    def toVector(self, out: list[float] | None = None) -> list[float] | None:
        """List the components, or write them to `out`."""
        if out is None:
            return self._values()
        out[:] = self._values()
        return None

    def __repr__(self) -> str:
        pairs = (f"{name}={value:g}" for name, value in zip(self._names, self._values()))
        return f"{type(self).__name__}({', '.join(pairs)})"


def _overwriting(symbol: str, operation: Callable[[Any, Any], Any]) -> Callable[[_Value, object], _Value]:
    """The form of an operator that writes its result over the left side."""

    def apply(self: _Value, other: object) -> _Value:
        result = operation(self, other)
        if not self._same_kind(result):
            name = type(self).__name__
            raise AlmathError(f"{name} {symbol} {other!r} would not leave a {name}")
        self._assign(result._values())
        return self

    return apply


for _name, _operation in {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}.items():
    setattr(Components, f"__i{_operation.__name__}__", _overwriting(f"{_name}=", _operation))


class Scalable(Components):
    """Components that can be multiplied and divided by a number."""

    def __mul__(self: _Vector, factor: float) -> _Vector:
        """Multiply each component by a number."""
        if not isinstance(factor, Real):
            return NotImplemented
        return self._make(value * factor for value in self._values())

    def __rmul__(self: _Vector, factor: float) -> _Vector:
        return Scalable.__mul__(self, factor)

    def __truediv__(self: _Vector, divisor: float) -> _Vector:
        if not isinstance(divisor, Real):
            return NotImplemented
        if divisor == 0.0:
            raise AlmathError(f"division of {self!r} by zero")
        return self._make(value / divisor for value in self._values())


class Linear(Scalable):
    """Components that can also be added to and subtracted from each other; one number fills them all."""

    _one_number_fills_all = True

    def __add__(self: _Vector, other: _Vector) -> _Vector:
        if not self._same_kind(other):
            return NotImplemented
        return self._make(mine + theirs for mine, theirs in zip(self._values(), other._values()))

    def __sub__(self: _Vector, other: _Vector) -> _Vector:
        if not self._same_kind(other):
            return NotImplemented
        return self._make(mine - theirs for mine, theirs in zip(self._values(), other._values()))

    def __neg__(self: _Vector) -> _Vector:
        return self._make(-value for value in self._values())

    def __pos__(self: _Vector) -> _Vector:
        return self._make(self._values())


class Vector(Scalable):
    """Components with a length and a direction."""

    def norm(self) -> float:
        """Root of the sum of the squares of all numbers, whatever their units."""
        return math.hypot(*self._values())

    def normalize(self: _Vector) -> _Vector:
        """Divide all numbers by the norm; AlmathError where it is zero."""
        length = self.norm()
        if length == 0.0:
            raise AlmathError(f"{self!r} has no direction: its norm is zero")
        return self / length


class Placed(Components):
    """Components of which some, or all, are a point."""

    def _point(self) -> Sequence[float]:
        return self._values()

    def distanceSquared(self: _Value, other: _Value) -> float:
        """Square of the distance between the two points, in m^2; angles do not count."""
        self._require_same(other, "distanceSquared")
        return sum((mine - theirs) ** 2 for mine, theirs in zip(self._point(), other._point()))

    def distance(self: _Value, other: _Value) -> float:
        """Distance between the two points, in m; angles do not count."""
        return math.sqrt(self.distanceSquared(other))


class Turning(Components):
    """Components that are the rows of a rotation matrix, each perhaps with a number of a translation behind it."""

    @classmethod
    def _from_rows(cls: type[_Turn], rows: np.ndarray) -> _Turn:
        return cls._make(rows.ravel().tolist())

    def _with_rows(self: _Turn, rows: np.ndarray) -> _Turn:
        """Return the same with another rotation."""
        return self._from_rows(rows)

    def _array(self) -> np.ndarray:
        """The numbers as a (3, 3) or (3, 4) array."""
        return np.array(self._values()).reshape(3, -1)

    def _rows(self) -> np.ndarray:
        """The rotation as a (3, 3) array."""
        return self._array()[:, :3]

    # These two have a name of their own in each class.

    def _is_rotation(self, epsilon: float) -> bool:
        return _matrix.is_rotation(self._rows(), epsilon)

    def _normalize(self) -> None:
        rows = _matrix.orthonormalised(self._rows())
        if rows is None:
            raise AlmathError(f"no rotation near {self!r}: its second and third column do not span a plane")
        self._assign(self._with_rows(rows)._values())

    def determinant(self) -> float:
        """Determinant of the rotation: 1."""
        return float(np.linalg.det(self._rows()))

    @classmethod
    def fromRotX(cls: type[_Turn], angle: float) -> _Turn:
        """Rotation about X by `angle`, in rad."""
        return cls._from_rows(_matrix.about(0, angle))

    @classmethod
    def fromRotY(cls: type[_Turn], angle: float) -> _Turn:
        """Rotation about Y by `angle`, in rad."""
        return cls._from_rows(_matrix.about(1, angle))

    @classmethod
    def fromRotZ(cls: type[_Turn], angle: float) -> _Turn:
        """Rotation about Z by `angle`, in rad."""
        return cls._from_rows(_matrix.about(2, angle))

    @classmethod
    def from3DRotation(cls: type[_Turn], wx: float, wy: float, wz: float) -> _Turn:
        """Rz(wz) Ry(wy) Rx(wx), angles in rad, without translation."""
        return cls._from_rows(_matrix.from_angles(wx, wy, wz))

    def __str__(self) -> str:
        """Write the rows, one a line."""
        return "[" + "\n ".join(f"[{row}]" for row in self._texts()) + "]"

    def __repr__(self) -> str:
        opening = f"{type(self).__name__}(["
        return opening + (",\n" + " " * len(opening)).join(self._texts()) + "])"

    def _texts(self) -> list[str]:
        return [", ".join(f"{number:g}" for number in row) for row in self._array()]


def fill(out: _Value, value: _Value, where: str) -> None:
    """Write a result of the function `where` over the object that the caller passed for it."""
    require(out, type(value), where)
    out._assign(value._values())


def asking(method: str, kinds: tuple[type, ...], text: str, name: str = "") -> Callable[..., Any]:
    """A function that has a method of its first argument answer, which has to be of one of some classes.

    `kinds`: the classes. `text`: docstring of the function. `name`: its name, if that is another one.
    """
    name = name or method

    def ask(value: Any, *arguments: Any) -> Any:
        if not isinstance(value, kinds):
            one_of = "a " if len(kinds) == 1 else "one of "
            raise AlmathError(f"{name} takes {one_of}{', '.join(kind.__name__ for kind in kinds)}, got {value!r}")
        return getattr(value, method)(*arguments)

    ask.__name__ = ask.__qualname__ = name
    ask.__doc__ = text
    return ask


def in_place(function: Callable[..., Components]) -> Callable[..., None]:
    """The form of a function, under its name with InPlace, that writes its result over a last argument."""
    name = f"{function.__name__}InPlace"

    def write(*arguments: object) -> None:
        if not arguments:
            raise AlmathError(f"{name} takes what to overwrite as its last argument, got nothing")
        fill(arguments[-1], function(*arguments[:-1]), name)

    write.__name__ = write.__qualname__ = name
    write.__doc__ = f"Write to the last argument what `{function.__name__}` makes of the ones before it."
    return write


def answer(value: _Value, out: _Value | None, where: str) -> _Value | None:
    """Return a result of the function `where`, or write it to `out` if that is given, as the SDK's functions do."""
    if out is None:
        return value
    fill(out, value, where)
    return None
