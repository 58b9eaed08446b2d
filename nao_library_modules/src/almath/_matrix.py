"""Rotation matrices as plain tuples of rows. Numbers in, numbers out; no class of the package is known here.

Three angles (wx, wy, wz) stand for R = Rz(wz) Ry(wy) Rx(wx), in rad. Quaternions are (w, x, y, z).
"""

from __future__ import annotations

import math
from typing import Tuple

Triple = Tuple[float, float, float]
Matrix = Tuple[Triple, Triple, Triple]

IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

# Columns shorter than this cannot be told from noise, so no axis is built on them.
_SHORTEST_COLUMN = 0.0001


def dot(a: Triple, b: Triple) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Triple, b: Triple) -> Triple:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def scaled(a: Triple, factor: float) -> Triple:
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def transposed(m: Matrix) -> Matrix:
    return tuple(zip(*m))


def product(a: Matrix, b: Matrix) -> Matrix:
    columns = transposed(b)
    return tuple(tuple(dot(row, column) for column in columns) for row in a)


def applied(m: Matrix, v: Triple) -> Triple:
    """Turn a vector by a matrix."""
    return (dot(m[0], v), dot(m[1], v), dot(m[2], v))


def determinant(m: Matrix) -> float:
    """Volume that the rows span, with sign."""
    return dot(m[0], cross(m[1], m[2]))


def is_rotation(m: Matrix, epsilon: float) -> bool:
    """Tell whether the rows are unit vectors at right angles and right-handed, within `epsilon`."""
    gram = product(m, transposed(m))
    orthonormal = all(
        abs(gram[row][column] - IDENTITY[row][column]) <= epsilon for row in range(3) for column in range(3)
    )
    return orthonormal and abs(determinant(m) - 1.0) <= epsilon


def orthonormalised(m: Matrix) -> Matrix | None:
    """Nearest right-handed frame that keeps the third column's direction and the second column's half plane.

    Returns the rotation, or None if the second and third column do not span a plane.
    """
    _, second, third = transposed(m)
    z = _unit(third)
    if z is None:
        return None
    x = _unit(cross(second, z))
    if x is None:
        return None
    return transposed((x, cross(z, x), z))


def _unit(v: Triple) -> Triple | None:
    length = math.sqrt(dot(v, v))
    # Written this way round so that a NaN is refused too.
    return scaled(v, 1.0 / length) if length >= _SHORTEST_COLUMN else None


def about_x(angle: float) -> Matrix:
    """Rotation about X by `angle`, in rad."""
    c, s = math.cos(angle), math.sin(angle)
    return ((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c))


def about_y(angle: float) -> Matrix:
    """Rotation about Y by `angle`, in rad."""
    c, s = math.cos(angle), math.sin(angle)
    return ((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c))


def about_z(angle: float) -> Matrix:
    """Rotation about Z by `angle`, in rad."""
    c, s = math.cos(angle), math.sin(angle)
    return ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))


def about_axis(axis: Triple, angle: float) -> Matrix:
    """Rotation about a unit axis by `angle`, in rad (Rodrigues' formula)."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = axis
    turning = ((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0))
    return tuple(
        tuple(
            c * IDENTITY[row][column] + s * turning[row][column] + (1.0 - c) * axis[row] * axis[column]
            for column in range(3)
        )
        for row in range(3)
    )


def from_angles(wx: float, wy: float, wz: float) -> Matrix:
    """Rz(wz) Ry(wy) Rx(wx), angles in rad."""
    return product(about_z(wz), product(about_y(wy), about_x(wx)))


def to_angles(m: Matrix) -> Triple:
    """Angles (wx, wy, wz) in rad with Rz(wz) Ry(wy) Rx(wx) = m, and wy in [-pi/2, pi/2].

    Where wy is a right angle only the sum or difference of the others is defined; then wz is 0.
    """
    wz = math.atan2(m[1][0], m[0][0])
    # Undoing the yaw leaves Ry Rx, whose middle row (0, cos wx, -sin wx) is well defined even where wy is a
    # right angle and the last row is not.
    _, middle, _ = product(about_z(-wz), m)
    return (math.atan2(-middle[2], middle[1]), math.atan2(-m[2][0], math.hypot(m[0][0], m[1][0])), wz)


def from_quaternion(w: float, x: float, y: float, z: float) -> Matrix | None:
    """Rotation of a quaternion of any length but zero. Returns the rotation, or None for the zero quaternion."""
    square = w * w + x * x + y * y + z * z
    if square == 0.0:
        return None
    s = 2.0 / square
    return (
        (1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        (s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)),
        (s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)),
    )


def to_quaternion(m: Matrix) -> tuple[float, float, float, float]:
    """Unit quaternion of a rotation, with w >= 0."""
    trace = m[0][0] + m[1][1] + m[2][2]
    # Four times the squares of w, x, y, z: the largest is a safe divisor for the others.
    squares = (1.0 + trace, *(1.0 + 2.0 * m[axis][axis] - trace for axis in range(3)))
    largest = max(range(4), key=squares.__getitem__)
    turning = (m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1])
    if largest == 0:
        quaternion = [squares[0], *turning]
    else:
        i = largest - 1
        quaternion = [turning[i], *(m[i][j] + m[j][i] for j in range(3))]
        quaternion[largest] = squares[largest]
    length = math.sqrt(sum(value * value for value in quaternion))
    sign = -1.0 if quaternion[0] < 0.0 else 1.0
    w, x, y, z = (sign * value / length for value in quaternion)
    return (w, x, y, z)
