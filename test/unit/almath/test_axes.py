"""Rotations about a given axis."""

import math

import numpy
import pytest

import almath


def matrix_of(rotation):
    return numpy.array(rotation.toVector()).reshape(3, 3)


def test_projection_is_nearer_than_any_other_rotation_about_the_axis(rng):
    angles = numpy.linspace(-math.pi, math.pi, 721)
    for _ in range(20):
        axis = almath.Position3D(rng.normal(size=3))
        rotation = almath.Rotation.from3DRotation(*rng.uniform(-3.1, 3.1, 3))
        projected = almath.axisRotationProjection(axis, rotation)
        distance = numpy.linalg.norm(matrix_of(projected) - matrix_of(rotation))
        others = (almath.rotationFromAngleDirection(angle, axis.normalize()) for angle in angles)
        nearest = min(numpy.linalg.norm(matrix_of(other) - matrix_of(rotation)) for other in others)
        assert (projected * axis).isNear(axis, 1e-9)
        assert distance <= nearest + 1e-9
        assert distance == pytest.approx(nearest, abs=1e-2)


def test_projection_leaves_a_rotation_about_the_axis(rng):
    for _ in range(20):
        axis = almath.Position3D(rng.normal(size=3)).normalize()
        rotation = almath.rotationFromAngleDirection(rng.uniform(-3.0, 3.0), axis)
        assert almath.axisRotationProjection(axis * 5.0, rotation).isNear(rotation, 1e-9)


def test_projection_of_a_tilt_across_the_axis_is_no_rotation():
    tilted = almath.transformFromRotX(0.2)
    assert almath.axisRotationProjection(almath.Position3D(0, 0, 1), tilted).isNear(almath.Transform(), 1e-12)


def test_projection_keeps_the_origin_of_a_transform_and_works_in_place():
    transform = almath.Transform.fromPosition(1.0, 2.0, 3.0, 0.2, 0.3, 0.4)
    axis = almath.Position3D(0.0, 1.0, 0.0)
    projected = almath.axisRotationProjection(axis, transform)
    assert almath.position3DFromTransform(projected) == almath.Position3D(1.0, 2.0, 3.0)
    almath.axisRotationProjectionInPlace(axis, transform)
    assert transform == projected


def test_projection_needs_an_axis_and_something_to_project():
    with pytest.raises(almath.AlmathError, match="no direction"):
        almath.axisRotationProjection(almath.Position3D(), almath.Rotation())
    with pytest.raises(almath.AlmathError, match="a Rotation or a Transform"):
        almath.axisRotationProjection(almath.Position3D(1, 0, 0), almath.Rotation3D())


@pytest.mark.parametrize("axis", [(2, 0, 0), (0, -3, 0), (0, 0, 0.5), (0, 0, -1), (1, 2, -3), (1e-6, 1.0, 1.0)])
def test_orthogonal_space_is_a_rotation_with_the_axis_in_its_third_column(axis):
    frame = almath.orthogonalSpace(almath.Position3D(axis))
    assert frame.isTransform(1e-9)
    third = almath.Position3D(frame.r1_c3, frame.r2_c3, frame.r3_c3)
    assert third.isNear(almath.Position3D(axis).normalize(), 1e-12)


def test_orthogonal_space_written_to_a_transform_keeps_its_origin():
    frame = almath.Transform(1.0, 2.0, 3.0)
    assert almath.orthogonalSpace(almath.Position3D(1.0, 0.0, 0.0), frame) is None
    assert frame == almath.Transform(1.0, 2.0, 3.0) * almath.orthogonalSpace(almath.Position3D(1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    "mask, about",
    [
        (almath.AXIS_MASK_X, almath.transformFromRotX),
        (almath.AXIS_MASK_Y, almath.transformFromRotY),
        (almath.AXIS_MASK_Z, almath.transformFromRotZ),
    ],
)
def test_rotation_about_a_named_axis(mask, about):
    point = almath.Position3D(1.0, 2.0, 3.0)
    assert almath.transformFromRotVec(mask, 0.4) == about(0.4)
    assert almath.transformFromRotVec(mask, 0.4, point) == almath.Transform(1.0, 2.0, 3.0) * about(0.4)
    out = almath.Transform()
    almath.transformFromRotVecInPlace(mask, 0.4, point, out)
    assert out == almath.transformFromRotVec(mask, 0.4, point)


def test_translation_alone_and_wrong_arguments():
    point = almath.Position3D(1.0, 2.0, 3.0)
    assert almath.transformFromRotVec(point) == almath.Transform(1.0, 2.0, 3.0)
    for arguments in [(), (almath.AXIS_MASK_WX, 0.1), (almath.AXIS_MASK_X,), (almath.AXIS_MASK_X, point)]:
        with pytest.raises(almath.AlmathError, match="transformFromRotVec takes"):
            almath.transformFromRotVec(*arguments)
    with pytest.raises(almath.AlmathError, match="last argument"):
        almath.transformFromRotVecInPlace()
