"""Vectors and transforms in turned axes."""

import pytest

import almath

VECTORS = [
    (almath.changeReferencePosition3D, almath.changeReferenceTransposePosition3D, almath.Position3D),
    (almath.changeReferencePosition6D, almath.changeReferenceTransposePosition6D, almath.Position6D),
    (almath.changeReferenceVelocity6D, almath.changeReferenceTransposeVelocity6D, almath.Velocity6D),
]


@pytest.mark.parametrize("forth, back, kind", VECTORS)
def test_each_triple_is_turned_and_not_moved(forth, back, kind, random_transforms, rng):
    for transform in random_transforms:
        rotation = almath.rotationFromTransform(transform)
        vector = kind(rng.normal(size=len(kind().toVector())))
        turned, again = kind(), kind()
        forth(transform, vector, turned)
        for start in range(0, len(vector.toVector()), 3):
            triple = almath.Position3D(vector.toVector()[start : start + 3])
            assert (rotation * triple).toVector() == pytest.approx(turned.toVector()[start : start + 3])
        back(transform, turned, again)
        assert again.isNear(vector, 1e-9)


def test_in_place_forms_turn_the_point_itself():
    transform = almath.Transform.fromPosition(5.0, 6.0, 7.0, 0.1, 0.2, 0.3)
    point = almath.Position3D(1.0, 2.0, 3.0)
    expected = almath.rotationFromTransform(transform) * point
    almath.changeReferencePosition3DInPlace(transform, point)
    assert point.isNear(expected, 1e-12)
    almath.changeReferenceTransposePosition3DInPlace(transform, point)
    assert point.isNear(almath.Position3D(1.0, 2.0, 3.0), 1e-12)


def test_transforms_are_turned_with_their_origin(random_transforms):
    for turn, other in zip(random_transforms, random_transforms[1:]):
        out, again = almath.Transform(), almath.Transform()
        almath.changeReferenceTransform(turn, other, out)
        assert out.isNear(almath.transformFromRotation(almath.rotationFromTransform(turn)) * other, 1e-12)
        almath.changeReferenceTransposeTransform(turn, out, again)
        assert again.isNear(other, 1e-9)


def test_pose_is_turned_about_the_origin_and_keeps_its_heading():
    out = almath.Pose2D()
    almath.changeReferencePose2D(almath.PI_2, almath.Pose2D(1.0, 2.0, 0.5), out)
    assert out.isNear(almath.Pose2D(-2.0, 1.0, 0.5), 1e-12)
    almath.changeReferencePose2DInPlace(-almath.PI_2, out)
    assert out.isNear(almath.Pose2D(1.0, 2.0, 0.5), 1e-12)


def test_result_must_be_of_the_class_of_the_vector():
    with pytest.raises(almath.AlmathError, match="changeReferencePosition3D takes a Position3D, got Position6D"):
        almath.changeReferencePosition3D(almath.Transform(), almath.Position3D(), almath.Position6D())
