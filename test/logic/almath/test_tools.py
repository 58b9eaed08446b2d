"""Angles on the circle, limits, inertia, filter and controller, constants."""

from __future__ import annotations

import math

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import almath
import motion
import vision_definitions
from almath import PI, AlmathError, Position3D

few = settings(max_examples=30)


def refused(told, function, *arguments):
    with pytest.raises(AlmathError, match=told):
        function(*arguments)


# Angles


@pytest.mark.parametrize("angle, wrapped", [(0.99 * PI, 0.99 * PI), (PI, PI), (-PI, PI), (7 * PI + 0.5, 0.5 - PI)])
def test_angles_are_wrapped_to_one_turn(angle, wrapped):
    assert almath.modulo2PI(angle) == pytest.approx(wrapped)
    angles = [angle, 0.2]
    almath.modulo2PIInPlace(angles)
    assert angles == pytest.approx([wrapped, 0.2])


@pytest.mark.parametrize(
    "angles, weights, mean",
    [
        ([0.3], [1.0], 0.3),
        ([0.2, 0.4], [1.0, 1.0], 0.3),
        ([PI - 0.1, -PI + 0.1], [1.0, 1.0], PI),
        ([PI / 2, PI], [1.0, 1.0], 0.75 * PI),
        ([0.0, PI / 2], [1.0, 0.5], math.atan(0.5)),
    ],
)
def test_mean_angle_goes_the_short_way_round_and_weights_pull_it(angles, weights, mean):
    found = [almath.weightedMeanAngle(angles, weights)]
    found += [almath.meanAngle(angles)] if set(weights) == {1.0} else []
    for each in found:
        assert almath.modulo2PI(each - mean) == pytest.approx(0.0, abs=1e-9)


# Limits, inertia, and functions that take many classes


def test_clipping_changes_lists_in_place_and_tells_whether_it_did():
    values = [-1.0, 1.0, 2.0, -0.5]
    assert almath.clipData(0.0, 1.0, values) is True
    assert values == [0.0, 1.0, 1.0, 0.0]
    assert almath.clipData(0.0, 1.0, values) is False
    nested = [almath.vectorFloat([0.1, 0.2]), [0.3, 5.0]]
    assert almath.clipData(0.0, 1.0, nested) is True
    assert nested == [[0.1, 0.2], [0.3, 1.0]]
    refused("a list to clip in place, got 0.7", almath.clipData, 0.0, 0.5, 0.7)
    refused("minimum up to the maximum", almath.clipData, 1.0, 0.0, [0.5])


@few
@given(st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6))
def test_inertia_of_a_point_resists_turns_across_its_arm(numbers):
    inertia, arm, spin = [], numbers[:3], numbers[3:]
    almath.pointMassRotationalInertia(1.5, Position3D(arm), inertia)
    momentum = 1.5 * numpy.cross(arm, numpy.cross(spin, arm))
    assert numpy.array(inertia).reshape(3, 3) @ spin == pytest.approx(momentum, abs=1e-9)


def test_functions_ask_the_value_they_are_given():
    a, b = Position3D(1.0, 2.0, 3.0), Position3D(-1.0, 0.5, 2.0)
    assert almath.norm(a) == a.norm()
    assert almath.norm(almath.Transform(2.0, 3.0, 6.0)) == almath.norm(almath.Rotation3D(2.0, 3.0, 6.0)) == 7.0
    for name in ("distance", "distanceSquared", "dotProduct", "crossProduct"):
        assert getattr(almath, name)(a, b) == getattr(a, name)(b)
    assert almath.isUnitVector(a.normalize())
    assert almath.isOrthogonal(a, a.crossProduct(b), 1e-9)
    rotation = almath.Rotation.from3DRotation(0.1, 0.2, 0.3)
    for matrix in (rotation, almath.transformFromRotation(rotation), almath.Transform().toVector()):
        assert almath.determinant(matrix) == pytest.approx(1.0)
    out = Position3D()
    assert almath.crossProduct(Position3D(1, 0, 0), Position3D(0, 1, 0), out) is None
    assert out == Position3D(0, 0, 1)
    refused("norm takes one of .*Pose2D", almath.norm, 3.0)


# Digital filter and PID controller


def filtered(weights, feedback, gain, samples):
    digital = almath.DigitalFilter()
    digital.configureFilter(weights, feedback, gain)
    first = [digital.processFilter(sample) for sample in samples]
    digital.resetFilter()
    assert [digital.processFilter(sample) for sample in samples] == first
    return first


def test_filter_is_the_difference_equation_and_reset_forgets_the_past():
    assert filtered([1.0, 1.0, 1.0], [], 3.0, (3.0, 6.0, 9.0, 12.0)) == [3.0, 6.0, 6.0, 9.0]
    samples = [1.0, -0.5, 0.25, 2.0, -1.5, 0.75, 0.1, 3.0]
    outputs = filtered([0.2, 0.3], [0.1, 0.5], 2.0, samples)
    assert outputs[:2] == samples[:2]
    for now in range(2, len(samples)):
        fed = (0.2 * samples[now - 1] + 0.3 * samples[now]) / 2.0
        assert outputs[now] == pytest.approx(fed + 0.1 * outputs[now - 2] + 0.5 * outputs[now - 1])


def test_proportional_gain_answers_the_error_beyond_the_threshold():
    controller = almath.PIDController(2.0, 0.0, 0.0, 0.5, 0.1, 0.02)
    answers = [controller.computeFeedback(*pair) for pair in ((3.0, 1.0), (1.0, 3.0), (1.0, 1.4))]
    assert answers == pytest.approx([2.0 * 1.5 + 0.1, -2.0 * 1.5 + 0.1, 0.1])


def test_a_fresh_controller_answers_nothing_until_it_has_gains():
    controller = almath.PIDController()
    assert [controller.computeFeedback(error, 0.0) for error in (1.0, -2.0)] == [0.0, 0.0]
    refused("gains of zero or more", almath.PIDController, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    refused("period above zero", almath.PIDController, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    controller.initialize()
    controller.setGains(1.0, 1.0, 1.0)
    # Without a set period a second passes with each call.
    assert [controller.computeFeedback(error, 0.0) for error in (0.1, -0.1)] == pytest.approx([0.2, -0.3])


def test_integral_and_derivative_of_a_ramp():
    controller = almath.PIDController()
    controller.initialize(0.0, 1.0, 1.0, 0.0, 0.0, 0.5)
    errors = numpy.arange(0.0, 3.0, 0.5)
    answers = [controller.computeFeedback(error, 0.0) for error in errors]
    slopes = [0.0, *numpy.diff(errors) / 0.5]
    assert answers == pytest.approx(slopes + numpy.cumsum(errors) * 0.5)
    controller = almath.PIDController(0.0, 1.0, 0.0, 0.0, 0.0, 0.5)
    controller.computeFeedback(0.0, 0.0)
    assert controller.computeFeedback(1.0, 0.0, 0.1) == pytest.approx(10.0)  # the period given with the call


def test_size_of_a_deviation_has_a_slope_without_sign_and_counts_from_the_threshold():
    slopes = almath.PIDController(0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    assert [slopes.computeFeedbackAbsolute(size) for size in (0.0, 3.0, 1.0)] == [0.0, 3.0, 2.0]
    beyond = almath.PIDController(2.0, 0.0, 0.0, 0.5, 0.0, 1.0)
    assert [beyond.computeFeedbackAbsolute(size) for size in (0.4, 0.75)] == [0.0, 0.5]


# Constants of almath, motion and vision_definitions


def constants_of(module, start):
    return {name: value for name, value in vars(module).items() if name.startswith(start)}


def test_angles_and_masks_have_their_values():
    assert (almath.PI, almath.PI_2, almath.PI_4) == (math.pi, math.pi / 2, math.pi / 4)
    for module in (almath, motion):
        assert 180.0 * module.TO_RAD == pytest.approx(math.pi)
        assert math.pi * module.TO_DEG == pytest.approx(180.0)
    single = [getattr(almath, "AXIS_MASK_" + axis) for axis in ("X", "Y", "Z", "WX", "WY", "WZ")]
    assert single == [1, 2, 4, 8, 16, 32]
    assert (almath.AXIS_MASK_VEL, almath.AXIS_MASK_ROT, almath.AXIS_MASK_ALL) == (7, 56, 63)
    assert (almath.AXIS_MASK_XY, almath.AXIS_MASK_WYWZ, almath.AXIS_MASK_PLANEZ) == (3, 48, 28)
    masks = constants_of(motion, "AXIS_MASK_")
    assert len(masks) == 12
    assert masks == {name: getattr(almath, name) for name in masks}
    assert [almath.isAxisMask(mask) for mask in (-1, 0, 1, 63, 64)] == [False, False, True, True, False]


def test_frames_have_the_numbers_of_almotion_under_both_names():
    assert (motion.FRAME_TORSO, motion.FRAME_WORLD, motion.FRAME_ROBOT) == (0, 1, 2)
    assert (motion.SPACE_TORSO, motion.SPACE_WORLD, motion.SPACE_NAO) == (0, 1, 2)
    cameras = vision_definitions.kTopCamera, vision_definitions.kBottomCamera, vision_definitions.kVGA
    assert (*cameras, vision_definitions.kBGRColorSpace) == (0, 1, 2, 13)
