"""Angles on the circle, limits and the inertia of a point."""

from __future__ import annotations

import math
from collections.abc import MutableSequence
from numbers import Real
from typing import List, Union

from almath._components import as_number, as_numbers, require
from almath.constants import PI
from almath.errors import AlmathError
from almath.positions import Position3D

# A mean direction shorter than this is the rounding of directions that cancel out.
_SHORTEST_MEAN = 0.001

Clippable = Union[List[float], List[List[float]]]


def modulo2PI(angle: float) -> float:
    """Wrap an angle, in rad, to ]-pi, pi]."""
    # math.remainder is exact and lies in [-pi, pi]; only the lower end has to move.
    wrapped = math.remainder(as_number(angle, "modulo2PI angle"), 2.0 * PI)
    return PI if wrapped == -PI else wrapped


def modulo2PIInPlace(angles: list[float]) -> None:
    """Wrap each angle of a list, in rad, to ]-pi, pi].

    Raises AlmathError if it is a number: Python numbers cannot change, use `modulo2PI`.
    """
    if not isinstance(angles, MutableSequence):
        raise AlmathError(f"modulo2PIInPlace takes a list of angles, got {angles!r}; modulo2PI returns a wrapped angle")
    angles[:] = [modulo2PI(angle) for angle in as_numbers(angles, "modulo2PIInPlace")]


def meanAngle(angles: list[float]) -> float:
    """Direction of the mean of the unit vectors at some angles, in rad in ]-pi, pi].

    Raises AlmathError if there are no angles, or their directions cancel out.
    """
    angles = as_numbers(angles, "meanAngle")
    return weightedMeanAngle(angles, [1.0] * len(angles))


def weightedMeanAngle(angles: list[float], weights: list[float]) -> float:
    """Direction of the weighted mean of the unit vectors at some angles.

    `angles`: in rad. `weights`: one for each angle, all above zero. Returns the mean, in rad in ]-pi, pi]. Raises
    AlmathError if the lengths differ, a weight is not above zero, or the directions cancel out.
    """
    angles = as_numbers(angles, "weightedMeanAngle angles")
    weights = as_numbers(weights, "weightedMeanAngle weights")
    if len(angles) != len(weights):
        raise AlmathError(f"weightedMeanAngle takes a weight for each angle, got {len(weights)} for {len(angles)}")
    if not all(weight > 0.0 for weight in weights):
        raise AlmathError(f"weightedMeanAngle takes weights above zero, got {weights}")
    x = sum(weight * math.cos(angle) for angle, weight in zip(angles, weights))
    y = sum(weight * math.sin(angle) for angle, weight in zip(angles, weights))
    if math.hypot(x, y) < _SHORTEST_MEAN:
        raise AlmathError(f"the angles {angles} with the weights {weights} have no mean direction")
    return modulo2PI(math.atan2(y, x))


def clipData(minimum: float, maximum: float, values: Clippable) -> bool:
    """Clip the numbers of a list, or of a list of lists, in place.

    `minimum`: smallest value allowed. `maximum`: largest value allowed. Returns True if a number had to change. Raises
    AlmathError if `values` is a number: Python numbers cannot change, use `min(max(value, minimum), maximum)`.
    """
    if not isinstance(values, MutableSequence):
        raise AlmathError(f"clipData takes a list to clip in place, got {values!r}")
    if not minimum <= maximum:
        raise AlmathError(f"clipData takes a minimum up to the maximum, got {minimum} and {maximum}")
    clipped = False
    for index, value in enumerate(values):
        if isinstance(value, Real):
            values[index] = min(max(value, minimum), maximum)
            clipped = clipped or values[index] != value
        else:
            clipped = clipData(minimum, maximum, value) or clipped
    return clipped


def pointMassRotationalInertia(mass: float, point: Position3D, out: list[float]) -> None:
    """Rotational inertia of a point mass about the origin.

    Args:
        mass: In kg.
        point: Where it is, in m.
        out: List to overwrite with the nine numbers of the 3x3 matrix, row by row, in kg m^2.
    """
    require(point, Position3D, "pointMassRotationalInertia")
    mass = as_number(mass, "pointMassRotationalInertia mass")
    place = point._values()
    square = point.dotProduct(point)
    out[:] = [
        mass * ((square if row == column else 0.0) - place[row] * place[column])
        for row in range(3)
        for column in range(3)
    ]
