"""Points in the plane and in space, poses, how fast they move, and the typed lists of the SDK."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import ClassVar

from almath._components import AlmathError, Components, Linear, Placed, Vector, answer, as_number, asking, require


class Position2D(Linear, Vector, Placed):
    """A point or vector in the plane."""

    x: float  # m
    y: float  # m

    @staticmethod
    def fromPolarCoordinates(radius: float, angle: float) -> Position2D:
        """Point at `radius` m from the origin, in the direction `angle` rad from the X axis."""
        return Position2D(radius * math.cos(angle), radius * math.sin(angle))

    def dotProduct(self, other: Position2D) -> float:
        """Inner product, in m^2."""
        require(other, Position2D, "Position2D.dotProduct")
        return self.x * other.x + self.y * other.y

    def crossProduct(self, other: Position2D) -> float:
        """Z component of the vector product, in m^2: positive if `other` lies to the left."""
        require(other, Position2D, "Position2D.crossProduct")
        return self.x * other.y - self.y * other.x

    def getAngle(self) -> float:
        """Direction from the X axis, in rad in [-pi, pi]."""
        return math.atan2(self.y, self.x)


class Position3D(Linear, Vector, Placed):
    """A point or vector in space."""

    x: float  # m
    y: float  # m
    z: float  # m

    def dotProduct(self, other: Position3D) -> float:
        """Inner product, in m^2."""
        require(other, Position3D, "Position3D.dotProduct")
        return self.x * other.x + self.y * other.y + self.z * other.z

    def crossProduct(self, other: Position3D) -> Position3D:
        """Vector product, in m^2."""
        require(other, Position3D, "Position3D.crossProduct")
        return Position3D(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )

    def isUnitVector(self, epsilon: float = 0.0001) -> bool:
        """Tell whether the length is 1, within `epsilon`."""
        return abs(self.norm() - 1.0) <= epsilon

    def isOrthogonal(self, other: Position3D, epsilon: float = 0.0001) -> bool:
        """Tell whether the inner product with `other` is 0, within `epsilon`."""
        return abs(self.dotProduct(other)) <= epsilon


class Position6D(Linear, Vector, Placed):
    """A point in space and three angles: R = Rz(wz) Ry(wy) Rx(wx)."""

    x: float  # m
    y: float  # m
    z: float  # m
    wx: float  # rad
    wy: float  # rad
    wz: float  # rad

    def _point(self) -> list[float]:
        return self._values()[:3]


class Velocity3D(Linear, Vector):
    """A linear velocity."""

    xd: float  # m/s
    yd: float  # m/s
    zd: float  # m/s


class Velocity6D(Linear, Vector):
    """A linear and an angular velocity."""

    xd: float  # m/s
    yd: float  # m/s
    zd: float  # m/s
    wxd: float  # rad/s
    wyd: float  # rad/s
    wzd: float  # rad/s


class PositionAndVelocity(Components):
    """Where one joint is and how fast it moves."""

    q: float  # position, rad or m
    dq: float  # velocity, rad/s or m/s

    def __init__(self, q: float = 0.0, dq: float = 0.0) -> None:
        self._assign((as_number(q, "PositionAndVelocity.q"), as_number(dq, "PositionAndVelocity.dq")))


# Below this length, in m, the direction of a pose's point is noise.
_SHORTEST = 0.0001


class Pose2D(Linear, Placed):
    """A point in the plane and a heading; also the motion that leads there from the origin.

    `a * b` is `b`, seen from `a`, in the frame of `a`; `a * 2` multiplies the three numbers; `a * point`
    places a Position2D.
    """

    x: float  # m
    y: float  # m
    theta: float  # rad, positive to the left, not wrapped

    @staticmethod
    def fromPolarCoordinates(radius: float, angle: float) -> Pose2D:
        """Pose at `radius` m from the origin in the direction `angle` (rad), heading away from the origin."""
        return Pose2D(radius * math.cos(angle), radius * math.sin(angle), angle)

    def __mul__(self, other: Pose2D | Position2D | float) -> Pose2D | Position2D:
        """Chain two poses, place a point, or multiply by a number."""
        if isinstance(other, Pose2D):
            point = self._placed(other.x, other.y)
            return self._make((*point, self.theta + other.theta))
        if isinstance(other, Position2D):
            return Position2D(*self._placed(other.x, other.y))
        return super().__mul__(other)

    def _placed(self, x: float, y: float) -> tuple[float, float]:
        c, s = math.cos(self.theta), math.sin(self.theta)
        return (self.x + c * x - s * y, self.y + s * x + c * y)

    def inverse(self) -> Pose2D:
        """Pose of the origin, seen from here: `pose.inverse() * pose` is the origin."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        return self._make((-c * self.x - s * self.y, s * self.x - c * self.y, -self.theta))

    def diff(self, other: Pose2D) -> Pose2D:
        """Motion that leads from here to `other`, in the frame of this pose."""
        require(other, Pose2D, "Pose2D.diff")
        return self.inverse() * other

    def _point(self) -> list[float]:
        return [self.x, self.y]

    def norm(self) -> float:
        """Distance of the point from the origin, in m."""
        return math.hypot(self.x, self.y)

    def normalize(self) -> Pose2D:
        """Pose 1 m from the origin in the same direction, with the same heading."""
        length = self.norm()
        if length < _SHORTEST:
            raise AlmathError(f"{self!r} has no direction: it is less than {_SHORTEST} m from the origin")
        return self._make((self.x / length, self.y / length, self.theta))

    def getAngle(self) -> float:
        """Direction of the point seen from the origin, in rad in [-pi, pi]; not the heading."""
        return math.atan2(self.y, self.x)


def pose2DInverse(pose: Pose2D, out: Pose2D | None = None) -> Pose2D | None:
    """Inverse of a pose; written to `out` if that is given."""
    require(pose, Pose2D, "pose2DInverse")
    return answer(pose.inverse(), out, "pose2DInverse")


def pose2dInvertInPlace(pose: Pose2D) -> None:
    """Replace a pose by its inverse."""
    pose2DInverse(pose, pose)


pose2dDiff = asking("diff", (Pose2D,), Pose2D.diff.__doc__, "pose2dDiff")


# ruff: noqa: N801  class names are those of the SDK


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
