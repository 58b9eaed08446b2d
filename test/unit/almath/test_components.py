"""What all values share: how they are made, compared, changed, listed and printed."""

import copy
import pickle

import numpy
import pytest

import almath

LINEAR = [
    almath.Pose2D,
    almath.Position2D,
    almath.Position3D,
    almath.Position6D,
    almath.Velocity3D,
    almath.Velocity6D,
    almath.Rotation3D,
]
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


def numbers_for(kind):
    return [float(place) for place, _ in enumerate(NAMES[kind].split(), start=1)]


@pytest.mark.parametrize("kind", NAMES)
def test_components_have_the_names_of_the_sdk_in_its_order(kind):
    value = kind(*numbers_for(kind))
    assert [getattr(value, name) for name in NAMES[kind].split()] == numbers_for(kind)
    assert value.toVector() == numbers_for(kind)


@pytest.mark.parametrize("kind", LINEAR)
def test_made_from_nothing_all_components_are_zero(kind):
    assert kind().toVector() == [0.0] * len(numbers_for(kind))


@pytest.mark.parametrize("kind", LINEAR)
def test_one_number_fills_all_components(kind):
    assert kind(0.5).toVector() == [0.5] * len(numbers_for(kind))


@pytest.mark.parametrize("kind", [*LINEAR, almath.Quaternion])
@pytest.mark.parametrize("container", [list, tuple, numpy.array, numpy.float32, almath.vectorFloat])
def test_made_from_a_sequence_of_any_kind(kind, container):
    numbers = numbers_for(kind)
    assert kind(container(numbers)) == kind(*numbers)


@pytest.mark.parametrize("kind", [*LINEAR, almath.Quaternion, almath.Transform, almath.Rotation])
def test_made_from_another_of_its_class_is_an_independent_copy(kind):
    original = kind()
    twin = kind(original)
    name = next(iter(vars(twin)))
    setattr(twin, name, 9.0)
    assert getattr(original, name) == vars(kind())[name]


@pytest.mark.parametrize(
    "arguments, told",
    [
        ((1.0, 2.0), ["Pose2D", "3 numbers", "x, y, theta", "got 2"]),
        (([1.0, 2.0, 3.0, 4.0],), ["Pose2D", "got 4"]),
        (("123",), ["Pose2D", "'123'"]),
        (([1.0, None, 3.0],), ["Pose2D[1]", "None"]),
        ((None,), ["Pose2D", "None"]),
        ((almath.Position3D(1.0, 2.0, 3.0),), ["Pose2D", "Position3D(x=1, y=2, z=3)"]),
    ],
)
def test_wrong_arguments_are_refused_and_named(arguments, told):
    with pytest.raises(almath.AlmathError) as caught:
        almath.Pose2D(*arguments)
    for text in told:
        assert text in str(caught.value)


def test_a_component_only_takes_numbers():
    pose = almath.Pose2D()
    with pytest.raises(almath.AlmathError, match=r"Pose2D\.theta must be a number, got '90'"):
        pose.theta = "90"
    assert pose == almath.Pose2D()


@pytest.mark.parametrize("kind", LINEAR)
def test_sum_difference_and_multiples_go_component_by_component(kind, rng):
    a, b = (kind(rng.uniform(-2.0, 2.0, len(numbers_for(kind)))) for _ in range(2))
    left, right = numpy.array(a.toVector()), numpy.array(b.toVector())
    assert (a + b).toVector() == pytest.approx(left + right)
    assert (a - b).toVector() == pytest.approx(left - right)
    assert (-a).toVector() == pytest.approx(-left)
    assert +a == a
    assert (a * 3).toVector() == pytest.approx(3.0 * left)
    assert (3 * a).toVector() == pytest.approx(3.0 * left)
    assert (a / 4.0).toVector() == pytest.approx(left / 4.0)


@pytest.mark.parametrize("kind", LINEAR)
def test_operators_with_equals_sign_change_the_object_itself(kind):
    value = alias = kind(2.0)
    value += kind(1.0)
    value *= 4.0
    value -= kind(2.0)
    value /= 5.0
    assert alias == kind(2.0)
    assert alias is value


@pytest.mark.parametrize("kind", [*LINEAR, almath.Quaternion])
def test_division_by_zero_is_an_error_that_names_the_value(kind):
    with pytest.raises(almath.AlmathError, match=f"{kind.__name__}.*by zero"):
        kind() / 0.0


def test_position_and_velocity_of_a_joint_are_zero_unless_given():
    assert almath.PositionAndVelocity().toVector() == [0.0, 0.0]
    assert almath.PositionAndVelocity(0.5).toVector() == [0.5, 0.0]
    with pytest.raises(almath.AlmathError, match=r"PositionAndVelocity\.dq must be a number"):
        almath.PositionAndVelocity(0.5, "fast")


def test_values_of_different_classes_do_not_mix():
    point, rotation = almath.Position3D(1.0, 2.0, 3.0), almath.Rotation3D(1.0, 2.0, 3.0)
    assert point != rotation
    with pytest.raises(TypeError):
        point + rotation
    with pytest.raises(almath.AlmathError, match="isNear takes a Position3D"):
        point.isNear(rotation)


def test_equality_is_exact_and_nearness_is_not():
    pose = almath.Pose2D(1.0, 2.0, 3.0)
    close = almath.Pose2D(1.0, 2.0, 3.00009)
    assert pose == almath.Pose2D(1.0, 2.0, 3.0)
    assert pose != close
    assert pose.isNear(close)
    assert not pose.isNear(close, 0.00008)
    assert not pose.isNear(almath.Pose2D(1.0, 2.0, 3.00011))


def test_values_cannot_be_keys_because_they_can_change():
    with pytest.raises(TypeError, match="unhashable"):
        {almath.Pose2D(): 1}


def test_to_vector_fills_a_list_that_is_passed():
    target = almath.vectorFloat()
    assert almath.Pose2D(1.0, 2.0, 3.0).toVector(target) is None
    assert target == [1.0, 2.0, 3.0]


def test_a_number_of_numpy_scales_from_the_left():
    assert numpy.float64(2.0) * almath.Pose2D(1.0, 2.0, 3.0) == almath.Pose2D(2.0, 4.0, 6.0)


@pytest.mark.parametrize("twin_of", [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_values_can_be_copied_and_pickled(twin_of):
    transform = almath.Transform.fromPosition(1.0, 2.0, 3.0, 0.1, 0.2, 0.3)
    twin = twin_of(transform)
    assert twin == transform
    twin.r1_c4 = 7.0
    assert transform.r1_c4 == 1.0


def test_a_subclass_with_its_own_constructor_keeps_its_operators():
    class Named(almath.Pose2D):
        def __init__(self, name):
            super().__init__(1.0, 2.0, 0.0)
            self.name = name

    assert (Named("start") + Named("end")).toVector() == [2.0, 4.0, 0.0]
    assert almath.Pose2D(1.0, 2.0, 0.0) == Named("start")


@pytest.mark.parametrize(
    "value, text",
    [
        (almath.Pose2D(0.0, 1.3, 2.9), "Pose2D(x=0, y=1.3, theta=2.9)"),
        (almath.Position2D(0.1, 0.2), "Position2D(x=0.1, y=0.2)"),
        (
            almath.Position6D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6),
            "Position6D(x=0.1, y=0.2, z=0.3, wx=0.4, wy=0.5, wz=0.6)",
        ),
        (almath.Velocity3D(1.0 / 3.0, 0.2, 1e-7), "Velocity3D(xd=0.333333, yd=0.2, zd=1e-07)"),
        (almath.PositionAndVelocity(0.1, 0.2), "PositionAndVelocity(q=0.1, dq=0.2)"),
        (almath.Quaternion(), "Quaternion(w=1, x=0, y=0, z=0)"),
    ],
)
def test_values_print_their_class_and_components(value, text):
    assert repr(value) == str(value) == text
