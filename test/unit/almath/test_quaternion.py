"""Quaternions as rotations."""

import math

import pytest

import almath


def test_i_times_j_is_k():
    i, j, k = almath.Quaternion(0, 1, 0, 0), almath.Quaternion(0, 0, 1, 0), almath.Quaternion(0, 0, 0, 1)
    assert i * j == k
    assert j * k == i
    assert k * i == j
    assert i * i == j * j == k * k == almath.Quaternion(-1, 0, 0, 0)


def test_made_from_nothing_it_turns_nothing():
    assert almath.Quaternion() * almath.Position3D(1.0, 2.0, 3.0) == almath.Position3D(1.0, 2.0, 3.0)


def test_turning_a_point_agrees_with_the_rotation_matrix(random_quaternions, rng):
    for quaternion in random_quaternions:
        point = almath.Position3D(rng.normal(size=3))
        assert (quaternion * point).isNear(almath.rotationFromQuaternion(quaternion) * point, 1e-9)


def test_product_of_quaternions_is_the_product_of_rotations(random_quaternions):
    for a, b in zip(random_quaternions, random_quaternions[1:]):
        product = almath.rotationFromQuaternion(a) * almath.rotationFromQuaternion(b)
        assert almath.rotationFromQuaternion(a * b).isNear(product, 1e-9)


def test_inverse_undoes_a_rotation(random_quaternions):
    for quaternion in random_quaternions:
        assert (quaternion * quaternion.inverse()).isNear(almath.Quaternion(), 1e-9)
        out = almath.Quaternion()
        assert almath.quaternionInverse(quaternion, out) is None
        assert out == almath.quaternionInverse(quaternion) == quaternion.inverse()


def test_angle_and_axis_make_the_quaternion_again(random_quaternions):
    for quaternion in random_quaternions:
        angle, *axis = almath.angleAndAxisRotationFromQuaternion(quaternion)
        assert 0.0 <= angle <= 2.0 * math.pi
        assert almath.Position3D(axis).isUnitVector(1e-9)
        assert almath.quaternionFromAngleAndAxisRotation(angle, *axis).isNear(quaternion, 1e-9)


def test_half_angle_is_in_the_components():
    quaternion = almath.Quaternion.fromAngleAndAxisRotation(math.pi / 2, 0.0, 0.0, 1.0)
    assert quaternion.isNear(almath.Quaternion(math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)), 1e-12)
    assert almath.Quaternion_fromAngleAndAxisRotation(math.pi / 2, 0.0, 0.0, 1.0) == quaternion


def test_axis_of_any_length_gives_a_unit_quaternion():
    quaternion = almath.quaternionFromAngleAndAxisRotation(0.8, 0.0, 5.0, 0.0)
    assert quaternion.norm() == pytest.approx(1.0)
    assert quaternion.isNear(almath.quaternionFromAngleAndAxisRotation(0.8, 0.0, 1.0, 0.0), 1e-12)
    with pytest.raises(almath.AlmathError, match="no direction"):
        almath.quaternionFromAngleAndAxisRotation(0.8, 0.0, 0.0, 0.0)


def test_without_rotation_the_axis_is_x():
    assert almath.angleAndAxisRotationFromQuaternion(almath.Quaternion()) == [0.0, 1.0, 0.0, 0.0]


def test_a_quaternion_and_its_negative_are_near_but_not_equal(random_quaternions):
    for quaternion in random_quaternions:
        assert quaternion.isNear(quaternion * -1.0)
        assert quaternion != quaternion * -1.0
    assert not almath.Quaternion().isNear(almath.Quaternion(0.0, 1.0, 0.0, 0.0))
    assert not almath.Quaternion().isNear(almath.Quaternion(1.0, 0.001, 0.0, 0.0))


def test_length_does_not_matter_for_the_rotation_but_zero_is_none(random_quaternions):
    for quaternion in random_quaternions:
        rotation = almath.rotationFromQuaternion(quaternion * 3.0)
        assert rotation.isNear(almath.rotationFromQuaternion(quaternion), 1e-9)
    zero = almath.Quaternion(0.0, 0.0, 0.0, 0.0)
    with pytest.raises(almath.AlmathError, match="other than zero"):
        almath.rotationFromQuaternion(zero)
    with pytest.raises(almath.AlmathError, match="turns nothing"):
        zero * almath.Position3D(1.0, 0.0, 0.0)
    with pytest.raises(almath.AlmathError, match="norm is zero"):
        zero.normalize()


def test_multiples_and_in_place_products():
    quaternion = almath.Quaternion(1.0, 2.0, 3.0, 4.0)
    assert quaternion / 2.0 == almath.Quaternion(0.5, 1.0, 1.5, 2.0)
    quaternion *= almath.Quaternion(0.0, 1.0, 0.0, 0.0)
    assert quaternion == almath.Quaternion(-2.0, 1.0, 4.0, -3.0)
    with pytest.raises(almath.AlmathError, match="would not leave a Quaternion"):
        quaternion *= almath.Position3D(1.0, 0.0, 0.0)
