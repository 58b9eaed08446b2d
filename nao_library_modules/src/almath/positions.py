"""Points in the plane and in space, a point with three angles, and how fast they move."""

from __future__ import annotations

import math

from almath._components import Components, Linear, Placed, Vector, as_number, require


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
