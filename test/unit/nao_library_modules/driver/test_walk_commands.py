"""Messages become walking commands, or an error that says what is wrong with them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.driver.walk_commands import (
    Step,
    Target,
    Velocity,
    read_step,
    read_target,
    read_velocity,
)
from nao_library_modules.errors import BadGoal

NAN, INFINITE = float("nan"), float("inf")


def twist(x, y, turn):
    return SimpleNamespace(linear=SimpleNamespace(x=x, y=y, z=9.0), angular=SimpleNamespace(x=9.0, y=9.0, z=turn))


def pose(x, y, theta):
    return SimpleNamespace(x=x, y=y, theta=theta)


def test_a_velocity_is_forward_left_and_turning():
    assert read_velocity(twist(0.5, -0.25, 1.0)) == (Velocity(0.5, -0.25, 1.0), "")


def test_a_velocity_out_of_range_is_clamped_and_said_to_be():
    velocity, clamped = read_velocity(twist(1.5, 0.2, -3.0))
    assert velocity == Velocity(1.0, 0.2, -1.0)
    assert clamped == "linear.x is 1.5, taken as 1, angular.z is -3, taken as -1"


@pytest.mark.parametrize(
    "parts, field",
    [((NAN, 0, 0), "linear.x"), ((0, INFINITE, 0), "linear.y"), ((0, 0, -INFINITE), "angular.z")],
)
def test_a_velocity_that_is_no_number_is_refused(parts, field):
    with pytest.raises(BadGoal) as caught:
        read_velocity(twist(*parts))
    assert caught.value.field == field
    assert "-1 to 1" in str(caught.value)


@pytest.mark.parametrize("parts, zero", [((0.0009, -0.0009, 0.0), True), ((0.0, 0.0, 0.0011), False)])
def test_next_to_nothing_is_a_standstill(parts, zero):
    assert Velocity(*parts).is_zero is zero


def test_a_target_must_be_finite():
    assert read_target(pose(1, -0.5, 3.1)) == Target(1.0, -0.5, 3.1)
    with pytest.raises(BadGoal, match="pose.theta: nan is not allowed: a finite number, in rad"):
        read_target(pose(1.0, 0.0, NAN))


@pytest.mark.parametrize("leg, name", [(0, "RLeg"), (1, "LLeg")])
def test_a_step_names_its_leg(leg, name):
    assert read_step(SimpleNamespace(leg=leg, pose=pose(0.04, 0.1, 0.2))) == Step(name, 0.04, 0.1, 0.2)


@pytest.mark.parametrize("leg, parts, field", [(2, (0.0, 0.1, 0.0), "leg"), (0, (0.0, INFINITE, 0.0), "pose.y")])
def test_a_wrong_step_is_refused(leg, parts, field):
    with pytest.raises(BadGoal) as caught:
        read_step(SimpleNamespace(leg=leg, pose=pose(*parts)))
    assert caught.value.field == field
