"""Angles on the circle, limits, inertia, constants and the functions that take many classes."""

import math

import numpy
import pytest

import almath
from almath import PI


@pytest.mark.parametrize(
    "angle, wrapped",
    [
        (0.0, 0.0),
        (0.99 * PI, 0.99 * PI),
        (-0.99 * PI, -0.99 * PI),
        (PI, PI),
        (-PI, PI),
        (PI + 0.5, 0.5 - PI),
        (-PI - 0.5, PI - 0.5),
        (10.0 * PI + 0.5, 0.5),
        (11.0 * PI + 0.5, 0.5 - PI),
    ],
)
def test_angles_are_wrapped_to_one_turn(angle, wrapped):
    assert almath.modulo2PI(angle) == pytest.approx(wrapped)


def test_wrapping_changes_an_angle_by_whole_turns(rng):
    for angle in rng.uniform(-100.0, 100.0, 200):
        wrapped = almath.modulo2PI(angle)
        turns = (angle - wrapped) / (2.0 * PI)
        assert -PI < wrapped <= PI
        assert turns == pytest.approx(round(turns), abs=1e-9)


def test_wrapping_in_place_takes_a_list_because_numbers_cannot_change():
    angles = [PI + 0.5, 0.2]
    almath.modulo2PIInPlace(angles)
    assert angles == pytest.approx([0.5 - PI, 0.2])
    with pytest.raises(almath.AlmathError, match="modulo2PI returns"):
        almath.modulo2PIInPlace(4.0)


@pytest.mark.parametrize(
    "angles, mean", [([0.3], 0.3), ([0.2, 0.4], 0.3), ([PI - 0.1, -PI + 0.1], PI), ([PI / 2, PI], 0.75 * PI)]
)
def test_mean_angle_goes_the_short_way_round(angles, mean):
    assert almath.modulo2PI(almath.meanAngle(angles) - mean) == pytest.approx(0.0, abs=1e-9)


def test_weights_pull_the_mean():
    assert almath.weightedMeanAngle([0.0, PI / 2], [1.0, 0.5]) == pytest.approx(math.atan(0.5))


@pytest.mark.parametrize(
    "angles, weights, told",
    [
        ([], [], "no mean direction"),
        ([0.0, PI], [1.0, 1.0], "no mean direction"),
        ([0.0, 1.0], [1.0], "got 1 for 2"),
        ([0.0, 1.0], [1.0, 0.0], "above zero"),
    ],
)
def test_mean_angle_that_does_not_exist_is_an_error(angles, weights, told):
    with pytest.raises(almath.AlmathError, match=told):
        almath.weightedMeanAngle(angles, weights)
    if weights == [1.0] * len(angles):
        with pytest.raises(almath.AlmathError, match=told):
            almath.meanAngle(angles)


def test_clipping_changes_lists_in_place_and_tells_whether_it_did():
    values = [-1.0, 1.0, 2.0, -0.5]
    assert almath.clipData(0.0, 1.0, values) is True
    assert values == [0.0, 1.0, 1.0, 0.0]
    assert almath.clipData(0.0, 1.0, values) is False
    nested = [almath.vectorFloat([0.1, 0.2]), [0.3, 5.0]]
    assert almath.clipData(0.0, 1.0, nested) is True
    assert nested == [[0.1, 0.2], [0.3, 1.0]]


def test_clipping_refuses_what_it_cannot_change():
    with pytest.raises(almath.AlmathError, match="a list to clip in place, got 0.7"):
        almath.clipData(0.0, 0.5, 0.7)
    with pytest.raises(almath.AlmathError, match="minimum up to the maximum"):
        almath.clipData(1.0, 0.0, [0.5])


def test_inertia_of_a_point_resists_turns_across_its_arm(rng):
    inertia = []
    almath.pointMassRotationalInertia(2.0, almath.Position3D(3.0, 0.0, 0.0), inertia)
    assert inertia == pytest.approx([0, 0, 0, 0, 18, 0, 0, 0, 18])
    for _ in range(20):
        arm, spin = rng.normal(size=3), rng.normal(size=3)
        almath.pointMassRotationalInertia(1.5, almath.Position3D(arm), inertia)
        momentum = 1.5 * numpy.cross(arm, numpy.cross(spin, arm))
        assert numpy.array(inertia).reshape(3, 3) @ spin == pytest.approx(momentum)


def test_angles_and_masks_have_their_values():
    assert (almath.PI, almath.PI_2, almath.PI_4) == (math.pi, math.pi / 2, math.pi / 4)
    assert 180.0 * almath.TO_RAD == pytest.approx(math.pi)
    assert math.pi * almath.TO_DEG == pytest.approx(180.0)
    single = [getattr(almath, "AXIS_MASK_" + axis) for axis in ("X", "Y", "Z", "WX", "WY", "WZ")]
    assert single == [1, 2, 4, 8, 16, 32]
    assert (almath.AXIS_MASK_VEL, almath.AXIS_MASK_ROT, almath.AXIS_MASK_ALL) == (7, 56, 63)
    assert (almath.AXIS_MASK_XY, almath.AXIS_MASK_WYWZ, almath.AXIS_MASK_PLANEZ) == (3, 48, 28)


@pytest.mark.parametrize("mask, valid", [(-1, False), (0, False), (1, True), (63, True), (64, False)])
def test_axis_masks_are_told_from_other_numbers(mask, valid):
    assert almath.isAxisMask(mask) is valid


def test_functions_ask_the_value_they_are_given():
    a, b = almath.Position3D(1.0, 2.0, 3.0), almath.Position3D(-1.0, 0.5, 2.0)
    assert almath.norm(a) == a.norm()
    assert almath.norm(almath.Transform(2.0, 3.0, 6.0)) == 7.0
    assert almath.norm(almath.Rotation3D(2.0, 3.0, 6.0)) == 7.0
    assert almath.distance(a, b) == a.distance(b)
    assert almath.distanceSquared(a, b) == a.distanceSquared(b)
    assert almath.dotProduct(a, b) == a.dotProduct(b)
    assert almath.crossProduct(a, b) == a.crossProduct(b)
    assert almath.isUnitVector(a.normalize())
    assert almath.isOrthogonal(a, a.crossProduct(b), 1e-9)
    rotation = almath.Rotation.from3DRotation(0.1, 0.2, 0.3)
    assert almath.transpose(rotation) == rotation.transpose()
    for matrix in (rotation, almath.transformFromRotation(rotation), almath.Transform().toVector()):
        assert almath.determinant(matrix) == pytest.approx(1.0)


def test_cross_product_fills_a_vector_of_space_only():
    out = almath.Position3D()
    assert almath.crossProduct(almath.Position3D(1, 0, 0), almath.Position3D(0, 1, 0), out) is None
    assert out == almath.Position3D(0, 0, 1)
    with pytest.raises(almath.AlmathError, match="returns a number"):
        almath.crossProduct(almath.Position2D(1, 0), almath.Position2D(0, 1), 0.0)


@pytest.mark.parametrize(
    "function, argument",
    [(almath.norm, 3.0), (almath.normalize, almath.Transform()), (almath.pinv, almath.Rotation())],
)
def test_functions_name_what_they_take(function, argument):
    with pytest.raises(almath.AlmathError, match=f"{function.__name__} takes one of .*Pose2D"):
        function(argument)
