"""The way from one transform to another: logarithm, exponential, mean and difference.

A Velocity6D held for one second is a screw motion; the exponential is where it leads, the logarithm the
velocity that leads there.
"""

from __future__ import annotations

import math

from almath import _matrix
from almath._components import as_number, in_place, require
from almath.errors import AlmathError
from almath.positions import Position6D, Velocity6D
from almath.transform import Transform

# Below this angle, in rad, the closed formulas divide rounding errors by its square; their series take over.
_SMALL_ANGLE = 0.0001


def velocityExponential(velocity: Velocity6D) -> Transform:
    """Transform that a body velocity, in m/s and rad/s, leads to within one second."""
    require(velocity, Velocity6D, "velocityExponential")
    linear = (velocity.xd, velocity.yd, velocity.zd)
    angular = (velocity.wxd, velocity.wyd, velocity.wzd)
    angle = math.sqrt(_matrix.dot(angular, angular))
    if angle < _SMALL_ANGLE:
        rows = _matrix.from_quaternion(1.0, *_matrix.scaled(angular, 0.5))
        across, along = 0.5, 1.0 / 6.0
    else:
        rows = _matrix.about_axis(_matrix.scaled(angular, 1.0 / angle), angle)
        across = (1.0 - math.cos(angle)) / angle**2
        along = (angle - math.sin(angle)) / angle**3
    return Transform._from_parts(rows, _bent(linear, angular, across, along))


velocityExponentialInPlace = in_place(velocityExponential)


def transformLogarithm(transform: Transform) -> Velocity6D:
    """Body velocity, in m/s and rad/s, that leads from the identity to `transform` within one second.

    The rotation is the shorter way round, at most pi.
    """
    require(transform, Transform, "transformLogarithm")
    w, *vector = _matrix.to_quaternion(transform._rows())
    sine = math.sqrt(_matrix.dot(vector, vector))
    angle = 2.0 * math.atan2(sine, w)
    if angle < _SMALL_ANGLE:
        angular = _matrix.scaled(vector, 2.0)
        along = 1.0 / 12.0
    else:
        angular = _matrix.scaled(vector, angle / sine)
        along = (1.0 - 0.5 * angle * w / sine) / angle**2
    return Velocity6D(*_bent(transform._point(), angular, -0.5, along), *angular)


transformLogarithmInPlace = in_place(transformLogarithm)


def _bent(v: _matrix.Triple, angular: _matrix.Triple, across: float, along: float) -> _matrix.Triple:
    """Sum v + across (angular x v) + along (angular x (angular x v)).

    The straight and the screwed way to a point differ by such a sum, in both directions.
    """
    once = _matrix.cross(angular, v)
    twice = _matrix.cross(angular, once)
    return tuple(a + across * b + along * c for a, b, c in zip(v, once, twice))


def transformMean(start: Transform, end: Transform, share: float = 0.5) -> Transform:
    """Transform on the screw motion from one to another.

    `start`: where the motion begins. `share`: how much of it is done, in [0, 1].
    """
    require(start, Transform, "transformMean")
    require(end, Transform, "transformMean")
    if not 0.0 <= as_number(share, "transformMean share") <= 1.0:
        raise AlmathError(f"transformMean takes a share in [0, 1], got {share}")
    return start * velocityExponential(transformLogarithm(start.diff(end)) * share)


transformMeanInPlace = in_place(transformMean)


def position6DFromTransformDiff(current: Transform, target: Transform) -> Position6D:
    """Difference of two transforms in the frame in which both are given, as a controller takes it.

    `current`: where the body is. `target`: where it should be. Returns the translation in m, and the axis of the
    rotation times the sine of its angle.
    """
    require(current, Transform, "position6DFromTransformDiff")
    require(target, Transform, "position6DFromTransformDiff")
    moved = (b - a for a, b in zip(current._point(), target._point()))
    columns = zip(_matrix.transposed(current._rows()), _matrix.transposed(target._rows()))
    turned = (0.5 * sum(parts) for parts in zip(*(_matrix.cross(a, b) for a, b in columns)))
    return Position6D(*moved, *turned)


position6DFromTransformDiffInPlace = in_place(position6DFromTransformDiff)
