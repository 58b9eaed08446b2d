"""What all values share: how they are made, compared, changed, listed and printed; typed lists; what is exported."""

from __future__ import annotations

import numpy
import pytest

import almath
from almath import AlmathError, Pose2D, Position2D, Position3D, Quaternion, Rotation, Transform, vectorFloat

NAMES = {
    almath.Pose2D: "x y theta",
    almath.Position2D: "x y",
    almath.Position3D: "x y z",
    almath.Position6D: "x y z wx wy wz",
    almath.Velocity3D: "xd yd zd",
    almath.Velocity6D: "xd yd zd wxd wyd wzd",
    almath.Rotation3D: "wx wy wz",
    almath.Quaternion: "w x y z",
    almath.PositionAndVelocity: "q dq",
}
LINEAR = [kind for kind in NAMES if kind not in (Quaternion, almath.PositionAndVelocity)]


def numbers_for(kind):
    return [float(place) for place, _ in enumerate(NAMES[kind].split(), start=1)]


def refused(told, function, *arguments):
    with pytest.raises(AlmathError, match=told):
        function(*arguments)


@pytest.mark.parametrize("kind", NAMES)
def test_components_have_the_names_of_the_sdk_in_its_order(kind):
    value = kind(*numbers_for(kind))
    assert [getattr(value, name) for name in NAMES[kind].split()] == value.toVector() == numbers_for(kind)
    target = vectorFloat()
    assert value.toVector(target) is None
    assert target == numbers_for(kind)


@pytest.mark.parametrize("kind", [*LINEAR, Quaternion, Transform, Rotation])
def test_made_from_a_sequence_of_any_kind_or_another_of_its_class(kind):
    if kind in NAMES:
        for container in (list, tuple, numpy.array, numpy.float32, vectorFloat):
            assert kind(container(numbers_for(kind))) == kind(*numbers_for(kind))
    original = kind()
    twin = kind(original)
    name = next(iter(vars(twin)))
    setattr(twin, name, 9.0)
    assert getattr(original, name) == getattr(kind(), name) != 9.0


def test_wrong_numbers_are_refused_and_named():
    refused("Pose2D.*3 numbers.*x, y, theta.*got 2", Pose2D, 1.0, 2.0)
    refused(r"Pose2D\[1\].*None", Pose2D, [1.0, None, 3.0])
    refused(r"Pose2D.*Position3D\(x=1, y=2, z=3\)", Pose2D, Position3D(1.0, 2.0, 3.0))
    pose = Pose2D()
    refused(r"Pose2D\.theta must be a number, got '90'", setattr, pose, "theta", "90")
    assert pose == Pose2D()
    assert almath.PositionAndVelocity().toVector() == [0.0, 0.0]
    assert almath.PositionAndVelocity(0.5).toVector() == [0.5, 0.0]
    refused(r"PositionAndVelocity\.dq must be a number", almath.PositionAndVelocity, 0.5, "fast")


@pytest.mark.parametrize("kind", LINEAR)
def test_sums_and_multiples_go_component_by_component(kind):
    left = numpy.array(numbers_for(kind)) - 2.25
    right = 0.5 * left[::-1]
    a, b = kind(left), kind(right)
    assert (kind().toVector(), kind(0.5).toVector()) == ([0.0] * len(left), [0.5] * len(left))
    assert (a + b).toVector() == pytest.approx(left + right)
    assert (a - b).toVector() == pytest.approx(left - right)
    assert (-a).toVector() == pytest.approx(-left)
    assert +a == a
    assert (a * 3).toVector() == (3 * a).toVector() == (numpy.float64(3.0) * a).toVector() == pytest.approx(3.0 * left)
    assert (a / 4.0).toVector() == pytest.approx(left / 4.0)
    value = alias = kind(2.0)
    value += kind(1.0)
    value *= 4.0
    value -= kind(2.0)
    value /= 5.0
    assert alias is value and alias == kind(2.0)


def test_equality_is_exact_and_nearness_is_not():
    pose, close = Pose2D(1.0, 2.0, 3.0), Pose2D(1.0, 2.0, 3.00009)
    assert pose == Pose2D(1.0, 2.0, 3.0) and pose != close
    assert pose.isNear(close) and not pose.isNear(close, 0.00008)
    assert not pose.isNear(Pose2D(1.0, 2.0, 3.00011))


def test_values_print_their_class_and_components():
    assert repr(Pose2D(0.0, 1.3, 2.9)) == str(Pose2D(0.0, 1.3, 2.9)) == "Pose2D(x=0, y=1.3, theta=2.9)"
    assert repr(vectorFloat([1, 0.25])) == "vectorFloat([1, 0.25])"
    assert str(Rotation.fromRotZHalfPi()) == "[[0, -1, 0]\n [1, 0, 0]\n [0, 0, 1]]"


# Typed lists


def test_a_vector_is_made_from_a_sequence_or_from_a_size():
    assert vectorFloat() == [] and vectorFloat((1, 2.5)) == [1.0, 2.5]
    assert vectorFloat(2) == [0.0, 0.0] and vectorFloat(2, 0.5) == [0.5, 0.5]
    assert almath.vectorPose2D(2) == [Pose2D(), Pose2D()]
    refused("an item of vectorFloat must be a number", vectorFloat, [1.0, "2"])
    refused("zero or more", vectorFloat, -1)


def test_a_vector_copies_items_in_and_out_and_refuses_other_classes():
    point = Position2D(1.0, 2.0)
    points = almath.vectorPosition2D([point])
    point.x = 9.0
    points[0].x = 8.0
    next(iter(points)).x = 7.0
    points.front().x = 6.0
    assert points == [Position2D(1.0, 2.0)]
    told = "vectorPosition2D takes a Position2D, got Pose2D"
    for store in (points.append, points.push_back, lambda p: points.insert(0, p), lambda p: points.extend([p])):
        refused(told, store, Pose2D())
    assert points.size() == 1


def test_a_vector_has_the_methods_of_cpp():
    numbers = vectorFloat()
    for number in (1.0, 2.0, 3.0):
        numbers.push_back(number)
    assert (numbers.size(), numbers.front(), numbers.back(), numbers.empty()) == (3, 1.0, 3.0, False)
    numbers.pop_back()
    numbers.resize(4, 7.0)
    assert numbers == [1.0, 2.0, 7.0, 7.0]
    assert isinstance(numbers[1:3], vectorFloat)
    numbers[1:3] = (9,)
    numbers[0] = 5
    assert numbers == [5.0, 9.0, 7.0]
    numbers.insert(1, 4)
    numbers.resize(2)
    other = vectorFloat([6.0])
    numbers.swap(other)
    assert (numbers, other) == ([6.0], [5.0, 4.0])
    numbers.assign(3, 0.5)
    assert numbers == [0.5, 0.5, 0.5]
    numbers.clear()
    assert numbers.empty()
