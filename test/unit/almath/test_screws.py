"""Logarithm, exponential and mean of transforms."""

import math

import numpy
import pytest

import almath


def power_series(velocity, terms=40):
    """Exponential of the 4x4 matrix of a body velocity, summed term by term."""
    x, y, z, wx, wy, wz = velocity.toVector()
    generator = numpy.array([[0, -wz, wy, x], [wz, 0, -wx, y], [-wy, wx, 0, z], [0, 0, 0, 0]])
    total = term = numpy.eye(4)
    for order in range(1, terms):
        term = term @ generator / order
        total = total + term
    return total


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 0.9e-4, 1.1e-4, 0.01, 1.0])
def test_exponential_is_the_power_series(scale, rng):
    for _ in range(20):
        velocity = almath.Velocity6D(*rng.normal(size=3), *(scale * rng.normal(size=3)))
        found = numpy.array(almath.velocityExponential(velocity).toVector()).reshape(4, 4)
        assert found == pytest.approx(power_series(velocity), abs=1e-8)


def test_logarithm_and_exponential_are_inverse(random_transforms):
    for transform in random_transforms:
        velocity = almath.transformLogarithm(transform)
        assert math.sqrt(velocity.wxd**2 + velocity.wyd**2 + velocity.wzd**2) <= math.pi + 1e-9
        assert almath.velocityExponential(velocity).isNear(transform, 1e-9)


@pytest.mark.parametrize("angle", [0.0, 1e-10, 1e-5, 0.9e-4, 1.1e-4, 1.0, math.pi - 1e-7])
def test_logarithm_finds_the_velocity_again_at_any_angle(angle, rng):
    for _ in range(20):
        axis = rng.normal(size=3)
        velocity = almath.Velocity6D(*rng.normal(size=3), *(angle * axis / numpy.linalg.norm(axis)))
        found = almath.transformLogarithm(almath.velocityExponential(velocity))
        assert found.isNear(velocity, 1e-6)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.6, 0.8, 0.0), (-0.48, 0.6, 0.64)])
def test_logarithm_of_half_a_turn_leads_there(axis):
    rotation = almath.rotationFromAngleDirection(math.pi, *axis)
    transform = almath.transformFromRotationPosition3D(rotation, 0.3, -0.2, 0.1)
    assert almath.velocityExponential(almath.transformLogarithm(transform)).isNear(transform, 1e-9)


def test_a_quarter_turn_while_driving_is_an_arc():
    velocity = almath.Velocity6D(math.pi / 2, 0.0, 0.0, 0.0, 0.0, math.pi / 2)
    expected = almath.Transform(1.0, 1.0, 0.0) * almath.Transform.fromRotZ(math.pi / 2)
    assert almath.velocityExponential(velocity).isNear(expected, 1e-12)
    assert almath.transformLogarithm(expected).isNear(velocity, 1e-9)


def test_mean_begins_at_one_and_ends_at_the_other(random_transforms):
    for start, end in zip(random_transforms, random_transforms[1:]):
        assert almath.transformMean(start, end, 0.0).isNear(start, 1e-9)
        assert almath.transformMean(start, end, 1.0).isNear(end, 1e-9)


def test_two_halves_of_the_way_are_the_same_motion(random_transforms):
    for start, end in zip(random_transforms, random_transforms[1:]):
        middle = almath.transformMean(start, end)
        assert start.diff(middle).isNear(middle.diff(end), 1e-9)


def test_mean_of_translations_and_of_turns_about_one_axis():
    straight = almath.transformMean(almath.Transform(), almath.Transform(1.0, 2.0, 4.0), 0.25)
    assert straight.isNear(almath.Transform(0.25, 0.5, 1.0), 1e-12)
    turned = almath.transformMean(almath.Transform.fromRotX(0.2), almath.Transform.fromRotX(1.0), 0.75)
    assert turned.isNear(almath.Transform.fromRotX(0.8), 1e-12)


@pytest.mark.parametrize("share", [-0.1, 1.1, math.nan])
def test_mean_refuses_a_share_outside_the_way(share):
    with pytest.raises(almath.AlmathError, match=r"share in \[0, 1\]"):
        almath.transformMean(almath.Transform(), almath.Transform(), share)


def test_difference_is_the_translation_and_the_sine_of_the_rotation(rng):
    for _ in range(50):
        axis = almath.Position3D(rng.normal(size=3)).normalize()
        angle = rng.uniform(-1.5, 1.5)
        current = almath.Transform.fromPosition(*rng.normal(size=6))
        turn = almath.rotationFromAngleDirection(angle, axis)
        rotation = turn * almath.rotationFromTransform(current)
        target = almath.transformFromRotationPosition3D(rotation, *rng.normal(size=3))
        moved = almath.position3DFromTransform(target) - almath.position3DFromTransform(current)
        expected = almath.Position6D(*moved.toVector(), *(axis * math.sin(angle)).toVector())
        assert almath.position6DFromTransformDiff(current, target).isNear(expected, 1e-9)


def test_in_place_forms_write_what_the_others_return(random_transforms):
    start, end = random_transforms[:2]
    velocity, transform, position = almath.Velocity6D(), almath.Transform(), almath.Position6D()
    almath.transformLogarithmInPlace(start, velocity)
    assert velocity == almath.transformLogarithm(start)
    almath.velocityExponentialInPlace(velocity, transform)
    assert transform == almath.velocityExponential(velocity)
    almath.transformMeanInPlace(start, end, 0.3, transform)
    assert transform == almath.transformMean(start, end, 0.3)
    almath.position6DFromTransformDiffInPlace(start, end, position)
    assert position == almath.position6DFromTransformDiff(start, end)
