"""Typed lists with the names of a C++ vector."""

import pytest

import almath


def test_made_from_a_sequence_or_from_a_size():
    assert almath.vectorFloat() == []
    assert almath.vectorFloat((1, 2.5)) == [1.0, 2.5]
    assert almath.vectorFloat(2) == [0.0, 0.0]
    assert almath.vectorFloat(2, 0.5) == [0.5, 0.5]
    assert almath.vectorPose2D(2) == [almath.Pose2D(), almath.Pose2D()]


@pytest.mark.parametrize(
    "arguments, told",
    [
        (([1.0, "2"],), "an item of vectorFloat must be a number"),
        (("12",), "takes a sequence"),
        ((2.5,), "takes a sequence"),
        ((-1,), "zero or more"),
        (([1.0], 2), "a size before an item"),
        ((1, 2, 3), "a size and an item"),
    ],
)
def test_wrong_arguments_are_named(arguments, told):
    with pytest.raises(almath.AlmathError, match=told):
        almath.vectorFloat(*arguments)


def test_items_of_another_class_are_refused():
    points = almath.vectorPosition2D()
    for store in (
        points.append,
        points.push_back,
        lambda item: points.insert(0, item),
        lambda item: points.extend([item]),
    ):
        with pytest.raises(almath.AlmathError, match="vectorPosition2D takes a Position2D, got Pose2D"):
            store(almath.Pose2D())
    assert points.empty()


def test_items_are_copied_in_and_out():
    point = almath.Position2D(1.0, 2.0)
    points = almath.vectorPosition2D([point])
    point.x = 9.0
    points[0].x = 8.0
    next(iter(points)).x = 7.0
    points.front().x = 6.0
    assert points == [almath.Position2D(1.0, 2.0)]


def test_methods_of_a_vector():
    numbers = almath.vectorFloat()
    for number in (1.0, 2.0, 3.0):
        numbers.push_back(number)
    assert (numbers.size(), numbers.front(), numbers.back(), numbers.empty()) == (3, 1.0, 3.0, False)
    numbers.pop_back()
    numbers.resize(4, 7.0)
    assert numbers == [1.0, 2.0, 7.0, 7.0]
    numbers.resize(1)
    other = almath.vectorFloat([5.0, 6.0])
    numbers.swap(other)
    assert (numbers, other) == ([5.0, 6.0], [1.0])
    numbers.assign(3, 0.5)
    assert numbers == [0.5, 0.5, 0.5]
    numbers.clear()
    assert numbers.empty()


def test_slices_are_of_the_same_kind_and_can_be_replaced():
    numbers = almath.vectorFloat([1.0, 2.0, 3.0, 4.0])
    assert isinstance(numbers[1:3], almath.vectorFloat)
    numbers[1:3] = (9,)
    assert numbers == [1.0, 9.0, 4.0]
    numbers[0] = 5
    assert numbers == [5.0, 9.0, 4.0]


def test_they_print_their_items():
    assert repr(almath.vectorFloat([1, 0.25])) == "vectorFloat([1, 0.25])"
    assert repr(almath.vectorPosition2D([almath.Position2D(0.1, 2)])) == "vectorPosition2D([Position2D(x=0.1, y=2)])"
