"""Rotation matrices and triples of angles."""

import math

import numpy
import pytest

import almath


def matrix_of(rotation):
    return numpy.array(rotation.toVector()).reshape(3, 3)


@pytest.mark.parametrize(
    "rotation, turned",
    [
        (almath.Rotation.fromRotX(math.pi / 2), [(1, 0, 0), (0, 0, 1), (0, -1, 0)]),
        (almath.Rotation.fromRotY(math.pi / 2), [(0, 0, -1), (0, 1, 0), (1, 0, 0)]),
        (almath.Rotation.fromRotZ(math.pi / 2), [(0, 1, 0), (-1, 0, 0), (0, 0, 1)]),
    ],
)
def test_a_quarter_turn_moves_the_axes_by_the_right_hand_rule(rotation, turned):
    axes = [almath.Position3D(1, 0, 0), almath.Position3D(0, 1, 0), almath.Position3D(0, 0, 1)]
    for axis, image in zip(axes, turned):
        assert (rotation * axis).isNear(almath.Position3D(image), 1e-12)


def test_three_angles_turn_about_x_first_and_z_last(rng):
    for _ in range(50):
        wx, wy, wz = rng.uniform(-3.1, 3.1, 3)
        chained = almath.rotationFromRotZ(wz) * almath.rotationFromRotY(wy) * almath.rotationFromRotX(wx)
        assert almath.Rotation.from3DRotation(wx, wy, wz).isNear(chained, 1e-12)
        assert almath.rotationFrom3DRotation(wx, wy, wz) == almath.Rotation_from3DRotation(wx, wy, wz)


def test_angles_of_a_rotation_make_the_rotation_again(rng):
    for _ in range(100):
        rotation = almath.Rotation.from3DRotation(*rng.uniform(-3.1, 3.1, 3))
        angles = almath.rotation3DFromRotation(rotation)
        assert abs(angles.wy) <= math.pi / 2
        assert almath.Rotation.from3DRotation(*angles.toVector()).isNear(rotation, 1e-9)


@pytest.mark.parametrize("wy", [math.pi / 2, -math.pi / 2])
@pytest.mark.parametrize("wx, wz", [(0.0, 0.0), (0.4, 0.0), (0.0, -0.9), (1.2, 0.5)])
def test_angles_are_found_where_the_pitch_is_a_right_angle(wx, wy, wz):
    rotation = almath.Rotation.from3DRotation(wx, wy, wz)
    angles = almath.rotation3DFromRotation(rotation)
    assert almath.Rotation.from3DRotation(*angles.toVector()).isNear(rotation, 1e-9)


def test_product_and_transpose_agree_with_numpy(rng):
    for _ in range(50):
        a, b = (almath.Rotation.from3DRotation(*rng.uniform(-3.1, 3.1, 3)) for _ in range(2))
        assert matrix_of(a * b) == pytest.approx(matrix_of(a) @ matrix_of(b))
        assert matrix_of(a.transpose()) == pytest.approx(matrix_of(a).T)
        assert (a * a.transpose()).isNear(almath.Rotation(), 1e-12)
        assert a.determinant() == pytest.approx(1.0)
        a *= b
        assert a.isRotation(1e-9)


def test_turning_keeps_lengths_and_angles_of_points_and_velocities(rng):
    rotation = almath.Rotation.from3DRotation(0.3, -0.4, 2.0)
    for _ in range(20):
        numbers = rng.normal(size=3)
        turned = rotation * almath.Position3D(numbers)
        assert turned.norm() == pytest.approx(numpy.linalg.norm(numbers))
        assert (rotation * almath.Velocity3D(numbers)).toVector() == pytest.approx(turned.toVector())
        assert almath.applyRotation(rotation, *numbers) == pytest.approx(turned.toVector())


def test_rotation_about_an_axis_leaves_the_axis_and_turns_by_the_angle(rng):
    for _ in range(50):
        axis = almath.Position3D(rng.normal(size=3)).normalize()
        angle = rng.uniform(-3.0, 3.0)
        rotation = almath.rotationFromAngleDirection(angle, axis)
        assert rotation.isRotation(1e-9)
        assert (rotation * axis).isNear(axis, 1e-9)
        assert sum(matrix_of(rotation).diagonal()) == pytest.approx(1.0 + 2.0 * math.cos(angle))
        assert almath.rotationFromAngleDirection(angle, axis.x, axis.y, axis.z) == rotation


@pytest.mark.parametrize("axis, about", [((1, 0, 0), almath.Rotation.fromRotX), ((0, 1, 0), almath.Rotation.fromRotY)])
def test_rotation_about_a_coordinate_axis_has_its_sign(axis, about):
    assert almath.Rotation.fromAngleDirection(0.7, *axis).isNear(about(0.7), 1e-12)


def test_an_axis_must_have_length_one():
    with pytest.raises(almath.AlmathError, match="length 1"):
        almath.Rotation.fromAngleDirection(0.5, 1.0, 1.0, 0.0)
    with pytest.raises(almath.AlmathError, match="rotationFromAngleDirection takes"):
        almath.rotationFromAngleDirection(0.5, 1.0, 0.0)


@pytest.mark.parametrize(
    "exact, rounded",
    [
        (almath.Rotation.fromRotXPi(), almath.Rotation.fromRotX(math.pi)),
        (almath.Rotation.fromRotYPi(), almath.Rotation.fromRotY(math.pi)),
        (almath.Rotation.fromRotZPi(), almath.Rotation.fromRotZ(math.pi)),
        (almath.Rotation.fromRotZHalfPi(), almath.Rotation.fromRotZ(math.pi / 2)),
    ],
)
def test_named_turns_have_no_rounding(exact, rounded):
    assert exact.isNear(rounded, 1e-12)
    assert set(exact.toVector()) <= {-1.0, 0.0, 1.0}


def test_made_from_a_list_row_by_row_or_from_the_list_of_a_transform():
    transform = almath.Transform.fromPosition(1.0, 2.0, 3.0, 0.1, 0.2, 0.3)
    rotation = almath.Rotation.from3DRotation(0.1, 0.2, 0.3)
    assert almath.Rotation(transform.toVector()) == rotation
    assert almath.Rotation(transform.toVector()[:12]) == rotation
    assert almath.Rotation(range(9)).r2_c3 == 5.0
    with pytest.raises(almath.AlmathError, match="9, 12 or 16 numbers, got 10"):
        almath.Rotation([0.0] * 10)
    with pytest.raises(almath.AlmathError, match="got 3 arguments"):
        almath.Rotation(0.1, 0.2, 0.3)


def test_normalizing_a_disturbed_rotation_keeps_the_third_column_and_is_idempotent(rng):
    for _ in range(50):
        rotation = almath.Rotation.from3DRotation(*rng.uniform(-3.1, 3.1, 3))
        disturbed = almath.Rotation(matrix_of(rotation).ravel() + rng.normal(scale=0.01, size=9))
        assert not disturbed.isRotation()
        third = matrix_of(disturbed)[:, 2]
        almath.normalizeRotation(disturbed)
        assert disturbed.isRotation(1e-9)
        assert disturbed.isNear(rotation, 0.1)
        assert matrix_of(disturbed)[:, 2] == pytest.approx(third / numpy.linalg.norm(third))
        again = almath.Rotation(disturbed)
        again.normalizeRotation()
        assert again.isNear(disturbed, 1e-12)


@pytest.mark.parametrize("numbers", [[0.0] * 9, [0, 1, 1, 0, 1, 1, 0, 1, 1], [math.nan] * 9])
def test_a_matrix_without_a_plane_is_no_rotation(numbers):
    with pytest.raises(almath.AlmathError, match="do not span a plane"):
        almath.Rotation(numbers).normalizeRotation()


def test_a_mirror_is_no_rotation():
    assert not almath.Rotation([1, 0, 0, 0, 1, 0, 0, 0, -1]).isRotation()


def test_axes_become_columns(rng):
    rotation = almath.Rotation.from3DRotation(0.5, -0.3, 1.9)
    x, y, z = (almath.Position3D(column) for column in matrix_of(rotation).T)
    assert almath.rotationFromAxesXYZ(x, y, z).isNear(rotation, 1e-12)
    assert almath.rotationFromAxesXY(x, y).isNear(rotation, 1e-12)
    assert almath.rotationFromAxesXZ(x, z).isNear(rotation, 1e-12)
    assert almath.rotationFromAxesYZ(y, z).isNear(rotation, 1e-12)
    with pytest.raises(almath.AlmathError, match="right-handed"):
        almath.rotationFromAxesXYZ(y, x, z)
    with pytest.raises(almath.AlmathError, match="right angles"):
        almath.rotationFromAxesXY(x, x)


def test_rotation_prints_its_rows():
    rotation = almath.Rotation.fromRotZHalfPi()
    assert str(rotation) == "[[0, -1, 0]\n [1, 0, 0]\n [0, 0, 1]]"
    assert repr(rotation) == "Rotation([0, -1, 0,\n          1, 0, 0,\n          0, 0, 1])"


def test_a_rotation_does_not_turn_a_pose():
    with pytest.raises(TypeError):
        almath.Rotation() * almath.Pose2D()
