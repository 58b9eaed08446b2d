"""A place on the floor with a heading, as ALMotion's walk takes and returns it."""

from __future__ import annotations

import math

from almath._components import Linear, Placed, answer, asking, require
from almath.errors import AlmathError
from almath.positions import Position2D

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
