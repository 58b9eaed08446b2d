"""Points and vectors of the plane and of space."""

import math

import numpy
import pytest

import almath


def test_norm_is_the_euclidean_length():
    assert almath.Position2D(3.0, 4.0).norm() == 5.0
    assert almath.Position3D(2.0, 3.0, 6.0).norm() == 7.0
    assert almath.Velocity3D(2.0, 3.0, 6.0).norm() == 7.0
    assert almath.Position6D(1.0, 1.0, 1.0, 1.0, 1.0, 2.0).norm() == 3.0
    assert almath.Velocity6D(1.0, 1.0, 1.0, 1.0, 1.0, 2.0).norm() == 3.0


@pytest.mark.parametrize(
    "kind, size",
    [
        (almath.Position2D, 2),
        (almath.Position3D, 3),
        (almath.Position6D, 6),
        (almath.Velocity3D, 3),
        (almath.Velocity6D, 6),
        (almath.Quaternion, 4),
    ],
)
def test_normalize_keeps_the_direction_and_makes_the_length_one(kind, size, rng):
    for _ in range(50):
        vector = kind(rng.normal(size=size))
        unit = vector.normalize()
        assert unit.norm() == pytest.approx(1.0)
        assert (unit * vector.norm()).isNear(vector, 1e-9)
        assert almath.normalize(vector) == unit


@pytest.mark.parametrize("kind", [almath.Position2D, almath.Position3D, almath.Position6D, almath.Velocity6D])
def test_a_zero_vector_has_no_direction(kind):
    with pytest.raises(almath.AlmathError, match="norm is zero"):
        kind().normalize()


def test_distance_is_the_norm_of_the_difference(rng):
    for kind in (almath.Position2D, almath.Position3D):
        size = len(kind().toVector())
        a, b = kind(rng.normal(size=size)), kind(rng.normal(size=size))
        assert a.distance(b) == pytest.approx((a - b).norm())
        assert a.distanceSquared(b) == pytest.approx((a - b).norm() ** 2)


def test_distance_of_positions_with_angles_ignores_the_angles():
    a = almath.Position6D(1.0, 2.0, 3.0, 0.5, 0.5, 0.5)
    assert a.distance(almath.Position6D(3.0, 5.0, 9.0, 0.0, 0.0, 0.0)) == 7.0
    assert a.distanceSquared(almath.Position6D(3.0, 5.0, 9.0, 0.0, 0.0, 0.0)) == 49.0


def test_products_of_vectors_agree_with_numpy(rng):
    for _ in range(50):
        a, b = rng.normal(size=3), rng.normal(size=3)
        p, q = almath.Position3D(a), almath.Position3D(b)
        assert p.dotProduct(q) == pytest.approx(numpy.dot(a, b))
        assert p.crossProduct(q).toVector() == pytest.approx(numpy.cross(a, b))


def test_cross_product_of_space_turns_x_into_y_into_z():
    x, y, z = almath.Position3D(1, 0, 0), almath.Position3D(0, 1, 0), almath.Position3D(0, 0, 1)
    assert x.crossProduct(y) == z
    assert y.crossProduct(z) == x
    assert z.crossProduct(x) == y


def test_cross_product_of_the_plane_is_positive_to_the_left():
    ahead, left = almath.Position2D(1.0, 0.0), almath.Position2D(0.0, 2.0)
    assert ahead.crossProduct(left) == 2.0
    assert left.crossProduct(ahead) == -2.0
    assert ahead.dotProduct(left) == 0.0


@pytest.mark.parametrize("angle", [-3.0, -math.pi / 2, 0.0, 0.7, math.pi])
def test_polar_coordinates_and_angle_are_inverse(angle):
    point = almath.Position2D.fromPolarCoordinates(2.0, angle)
    assert point.norm() == pytest.approx(2.0)
    assert point.getAngle() == pytest.approx(angle)
    assert almath.Position2D_fromPolarCoordinates(2.0, angle) == point


def test_unit_and_orthogonal_vectors_are_told_within_a_tolerance():
    x = almath.Position3D(1.00005, 0.0, 0.0)
    assert x.isUnitVector()
    assert not x.isUnitVector(0.00001)
    assert not (x * 1.001).isUnitVector()
    assert not almath.isUnitVector(x * 1.001)
    assert x.isOrthogonal(almath.Position3D(0.00005, 1.0, 0.0))
    assert not x.isOrthogonal(almath.Position3D(0.001, 1.0, 0.0))
    assert not almath.isOrthogonal(x, almath.Position3D(0.001, 1.0, 0.0))


def test_a_point_of_the_plane_has_no_distance_to_one_of_space():
    with pytest.raises(almath.AlmathError, match="Position2D.distanceSquared takes a Position2D"):
        almath.Position2D().distance(almath.Position3D())
