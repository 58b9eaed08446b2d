"""Lists of one kind of item, for scripts that name them; plain lists do wherever these are taken."""
# ruff: noqa: N801  class names are those of the SDK

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar

from almath._components import Components, as_number, require
from almath.errors import AlmathError
from almath.pose2d import Pose2D
from almath.positions import Position2D, Position6D


class _TypedList(list):
    """A list with the names of a C++ vector, which copies what it takes and what it gives.

    Made from nothing it is empty; from a sequence it holds its items; from a size, and perhaps an item, it is
    filled.
    """

    _kind: ClassVar[type[Components]]

    def __init__(self, *arguments: object) -> None:
        """Read a sequence, or a size and an item; see the class."""
        if len(arguments) > 2:
            raise AlmathError(f"{type(self).__name__} takes a sequence, or a size and an item, got {arguments!r}")
        if arguments and isinstance(arguments[0], int):
            super().__init__()
            self.resize(*arguments)
        elif len(arguments) == 2:
            raise AlmathError(f"{type(self).__name__} takes a size before an item, got {arguments[0]!r}")
        else:
            super().__init__(self._copies(*arguments))

    @classmethod
    def _copy(cls, item: object) -> object:
        require(item, cls._kind, cls.__name__)
        return cls._kind(item)

    @classmethod
    def _copies(cls, items: object = ()) -> list:
        if isinstance(items, (str, bytes)) or not isinstance(items, Iterable):
            raise AlmathError(f"{cls.__name__} takes a sequence, got {items!r}")
        return [cls._copy(item) for item in items]

    @classmethod
    def _blank(cls) -> object:
        return cls._kind()

    def __getitem__(self, index: int | slice) -> object:
        """Return a copy of an item, or of a slice."""
        found = super().__getitem__(index)
        return type(self)(found) if isinstance(index, slice) else self._copy(found)

    def __setitem__(self, index: int | slice, value: object) -> None:
        """Store a copy of an item, or of several."""
        super().__setitem__(index, self._copies(value) if isinstance(index, slice) else self._copy(value))

    def __iter__(self) -> Iterable:
        return (self._copy(item) for item in super(_TypedList, self).__iter__())

    def append(self, item: object) -> None:
        """Store a copy of an item at the end."""
        super().append(self._copy(item))

    push_back = append

    def extend(self, items: Iterable) -> None:
        """Store copies of items at the end."""
        super().extend(self._copies(items))

    def insert(self, index: int, item: object) -> None:
        """Store a copy of an item before the one at `index`."""
        super().insert(index, self._copy(item))

    def pop_back(self) -> None:
        """Drop the last item."""
        del self[-1]

    def front(self) -> object:
        """Return a copy of the first item."""
        return self[0]

    def back(self) -> object:
        """Return a copy of the last item."""
        return self[-1]

    def size(self) -> int:
        """Count the items."""
        return len(self)

    def empty(self) -> bool:
        """Tell whether there are no items."""
        return not self

    def assign(self, size: int, item: object) -> None:
        """Hold `size` copies of an item and nothing else."""
        self[:] = [item] * size

    def resize(self, size: int, item: object | None = None) -> None:
        """Drop items from the end or add copies of `item`, or of a fresh one, up to `size`."""
        if size < 0:
            raise AlmathError(f"{type(self).__name__} takes a size of zero or more, got {size}")
        del self[size:]
        self.extend([self._blank() if item is None else item] * (size - len(self)))

    def swap(self, other: _TypedList) -> None:
        """Exchange all items with another list of the same kind."""
        require(other, type(self), f"{type(self).__name__}.swap")
        self[:], other[:] = list(other), list(self)

    def __repr__(self) -> str:
        return f"{type(self).__name__}([{', '.join(self._shown(item) for item in self)}])"

    @staticmethod
    def _shown(item: object) -> str:
        return repr(item)


class vectorFloat(_TypedList):
    """A list of numbers."""

    @classmethod
    def _copy(cls, item: object) -> float:
        return as_number(item, f"an item of {cls.__name__}")

    @classmethod
    def _blank(cls) -> float:
        return 0.0

    @staticmethod
    def _shown(item: float) -> str:
        return f"{item:g}"


class vectorPosition2D(_TypedList):
    """A list of Position2D."""

    _kind = Position2D


class vectorPose2D(_TypedList):
    """A list of Pose2D."""

    _kind = Pose2D


class vectorPosition6D(_TypedList):
    """A list of Position6D."""

    _kind = Position6D
