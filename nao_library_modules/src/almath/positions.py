"""Points in the plane and in space, and a point with three angles."""

from __future__ import annotations

import math

from almath._components import Linear, require, unit


class Position2D(Linear):
    """A point or vector in the plane.

    Attributes:
        x: In m.
        y: In m.
    """

    x: float
    y: float

    _names = ("x", "y")
    _defaults = (0.0, 0.0)
    _one_number_fills_all = True

    @staticmethod
    def fromPolarCoordinates(radius: float, angle: float) -> Position2D:
        """Point at `radius` m from the origin, in the direction `angle` rad from the X axis."""
        return Position2D(radius * math.cos(angle), radius * math.sin(angle))

    def norm(self) -> float:
        """Distance from the origin, in m."""
        return math.hypot(self.x, self.y)

    def normalize(self) -> Position2D:
        """Vector of length 1 in the same direction."""
        return unit(self, self.norm())

    def distanceSquared(self, other: Position2D) -> float:
        """Square of the distance to another point, in m^2."""
        require(other, Position2D, "Position2D.distanceSquared")
        return (self.x - other.x) ** 2 + (self.y - other.y) ** 2

    def distance(self, other: Position2D) -> float:
        """Distance to another point, in m."""
        return math.sqrt(self.distanceSquared(other))

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


class Position3D(Linear):
    """A point or vector in space.

    Attributes:
        x: In m.
        y: In m.
        z: In m.
    """

    x: float
    y: float
    z: float

    _names = ("x", "y", "z")
    _defaults = (0.0, 0.0, 0.0)
    _one_number_fills_all = True

    def norm(self) -> float:
        """Distance from the origin, in m."""
        return math.sqrt(self.dotProduct(self))

    def normalize(self) -> Position3D:
        """Vector of length 1 in the same direction."""
        return unit(self, self.norm())

    def distanceSquared(self, other: Position3D) -> float:
        """Square of the distance to another point, in m^2."""
        require(other, Position3D, "Position3D.distanceSquared")
        return (self.x - other.x) ** 2 + (self.y - other.y) ** 2 + (self.z - other.z) ** 2

    def distance(self, other: Position3D) -> float:
        """Distance to another point, in m."""
        return math.sqrt(self.distanceSquared(other))

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


class Position6D(Linear):
    """A point in space and three angles: R = Rz(wz) Ry(wy) Rx(wx).

    Attributes:
        x: In m.
        y: In m.
        z: In m.
        wx: In rad.
        wy: In rad.
        wz: In rad.
    """

    x: float
    y: float
    z: float
    wx: float
    wy: float
    wz: float

    _names = ("x", "y", "z", "wx", "wy", "wz")
    _defaults = (0.0,) * 6
    _one_number_fills_all = True

    def norm(self) -> float:
        """Root of the sum of the squares of all six numbers, metres and radians alike."""
        return math.sqrt(sum(value * value for value in self._values()))

    def normalize(self) -> Position6D:
        """Divide all six numbers by the norm."""
        return unit(self, self.norm())

    def distanceSquared(self, other: Position6D) -> float:
        """Square of the distance between the two points, in m^2; the angles do not count."""
        require(other, Position6D, "Position6D.distanceSquared")
        return (self.x - other.x) ** 2 + (self.y - other.y) ** 2 + (self.z - other.z) ** 2

    def distance(self, other: Position6D) -> float:
        """Distance between the two points, in m; the angles do not count."""
        return math.sqrt(self.distanceSquared(other))
