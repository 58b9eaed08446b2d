"""Homogeneous transforms."""

import math

import numpy
import pytest

import almath


def matrix_of(transform):
    return numpy.array(transform.toVector()).reshape(4, 4)


def test_made_from_nothing_it_is_the_identity():
    assert matrix_of(almath.Transform()) == pytest.approx(numpy.eye(4))


def test_three_numbers_are_a_translation():
    assert almath.Transform(1.0, 2.0, 3.0) * almath.Position3D(0.5, 0.5, 0.5) == almath.Position3D(1.5, 2.5, 3.5)


def test_product_and_inverse_agree_with_numpy(random_transforms):
    for a, b in zip(random_transforms, random_transforms[1:]):
        assert matrix_of(a * b) == pytest.approx(matrix_of(a) @ matrix_of(b))
        assert matrix_of(a.inverse()) == pytest.approx(numpy.linalg.inv(matrix_of(a)))
        assert a.determinant() == pytest.approx(1.0)


def test_a_point_is_turned_first_and_moved_then(random_transforms, rng):
    for transform in random_transforms:
        point = rng.normal(size=3)
        expected = (matrix_of(transform) @ [*point, 1.0])[:3]
        assert (transform * almath.Position3D(point)).toVector() == pytest.approx(expected)
    on_floor = almath.Transform.fromRotZ(math.pi / 2) * almath.Position2D(1.0, 0.0)
    assert on_floor.isNear(almath.Position3D(0.0, 1.0, 0.0), 1e-12)


def test_translation_and_angles_turn_about_the_moved_origin():
    chained = (
        almath.Transform(1.0, 2.0, 3.0)
        * almath.transformFromRotZ(0.3)
        * almath.transformFromRotY(0.2)
        * almath.transformFromRotX(0.1)
    )
    assert almath.transformFromPosition(1.0, 2.0, 3.0, 0.1, 0.2, 0.3).isNear(chained, 1e-12)
    assert almath.Transform_fromPosition(1.0, 2.0, 3.0) == almath.Transform(1.0, 2.0, 3.0)
    assert almath.transformFromPosition(1.0, 2.0, 3.0) == almath.Transform(1.0, 2.0, 3.0)
    assert almath.transformFrom3DRotation(0.1, 0.2, 0.3) == almath.Transform_from3DRotation(0.1, 0.2, 0.3)


def test_diff_leads_from_one_to_the_other(random_transforms):
    for start, end in zip(random_transforms, random_transforms[1:]):
        assert (start * start.diff(end)).isNear(end, 1e-9)
        assert almath.transformDiff(start, end) == start.diff(end)


def test_all_spellings_of_the_inverse_agree(random_transforms):
    transform = random_transforms[0]
    out, turned = almath.Transform(), almath.Transform(transform)
    assert almath.transformInverse(transform, out) is None
    almath.transformInvertInPlace(turned)
    assert transform.inverse() == almath.transformInverse(transform) == almath.pinv(transform) == out == turned


def test_in_place_products_from_either_side(random_transforms):
    a, b = random_transforms[:2]
    right, left = almath.Transform(a), almath.Transform(b)
    right *= b
    almath.transformPreMultiply(a, left)
    assert right == left == a * b
    square = almath.Transform(a)
    square *= square
    assert square == a * a


def test_distance_and_norm_are_those_of_the_origins():
    a = almath.Transform.fromPosition(1.0, 2.0, 3.0, 1.0, 1.0, 1.0)
    b = almath.Transform.fromPosition(1.0, 5.0, 7.0)
    assert a.distance(b) == almath.transformDistance(a, b) == 5.0
    assert a.distanceSquared(b) == almath.transformDistanceSquared(a, b) == 25.0
    assert almath.Transform(2.0, 3.0, 6.0).norm() == 7.0


def test_lists_of_12_and_16_numbers_make_the_transform_again(random_transforms):
    for transform in random_transforms:
        assert almath.Transform(transform.toVector()) == transform
        assert almath.Transform(almath.transformToFloatVector(transform)) == transform
    filled = []
    assert almath.transformToFloatVector(transform, filled) is None
    assert filled == transform.toVector()[:12]
    assert transform.toVector()[12:] == [0.0, 0.0, 0.0, 1.0]
    assert transform.toVector(filled) is None
    assert filled == transform.toVector()


def test_a_list_whose_rotation_is_off_is_put_right(random_transforms, rng):
    for transform in random_transforms:
        numbers = numpy.array(transform.toVector())
        numbers[[0, 1, 2, 4, 5, 6, 8, 9, 10]] += rng.normal(scale=0.01, size=9)
        repaired = almath.Transform(numbers)
        assert repaired.isTransform(1e-9)
        assert repaired.isNear(transform, 0.1)
        assert almath.position3DFromTransform(repaired) == almath.position3DFromTransform(transform)


@pytest.mark.parametrize(
    "arguments, told",
    [
        (([0.0] * 6,), "12 or 16 numbers, got 6"),
        (([0.0] * 16,), "do not span a plane"),
        ((1.0,), "3 numbers or a sequence"),
        ((1.0, 2.0), "got 2 arguments"),
        ((1.0, "2", 3.0), "Transform y must be a number"),
        (([[1.0, 0.0, 0.0, 0.0]] * 4,), r"Transform\[0\] must be a number"),
    ],
)
def test_wrong_arguments_are_refused_and_named(arguments, told):
    with pytest.raises(almath.AlmathError, match=told):
        almath.Transform(*arguments)


def test_normalizing_repairs_a_changed_entry():
    transform = almath.Transform(1.0, 2.0, 3.0)
    transform.r1_c2 = 0.2
    assert not transform.isTransform()
    almath.normalizeTransform(transform)
    assert transform.isTransform(1e-12)
    assert transform.toVector()[3::4][:3] == [1.0, 2.0, 3.0]


def test_transform_prints_its_upper_rows():
    transform = almath.Transform(1.0, 2.0, 3.5)
    assert str(transform) == "[[1, 0, 0, 1]\n [0, 1, 0, 2]\n [0, 0, 1, 3.5]]"
    assert repr(transform) == "Transform([1, 0, 0, 1,\n           0, 1, 0, 2,\n           0, 0, 1, 3.5])"


def test_pairs_copy_their_parts_and_compare_them():
    transform, velocity = almath.Transform(1.0, 2.0, 3.0), almath.Velocity6D(0.1)
    pair = almath.TransformAndVelocity6D(transform, velocity)
    transform.r1_c4 = 9.0
    assert pair.T.r1_c4 == 1.0
    assert pair.isNear(almath.TransformAndVelocity6D(almath.Transform(1.0, 2.0, 3.0), velocity))
    assert not pair.isNear(almath.TransformAndVelocity6D(almath.Transform(1.0, 2.0, 3.0)))
    assert not pair.isNear(almath.TransformAndVelocity6D(None, velocity))
    assert "Velocity6D(xd=0.1" in repr(pair)
