"""What sticks and buttons of a gamepad ask for."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.joy_control import JoyControl, JoySettings, Request
from nao_library_modules.driver.walk_commands import Velocity

ENABLE, INIT, CROUCH, HEAD = 8, 0, 9, 5


def axes(**values):
    """Axes by what they do with the default settings."""
    names = ("turn", "none", "y", "x", "yaw", "pitch")
    return [values.get(name, 0.0) for name in names]


def buttons(*pressed):
    return [int(index in pressed) for index in range(12)]


@pytest.fixture
def joy():
    joy = JoyControl(JoySettings())
    joy.update(axes(), buttons())
    assert joy.update(axes(), buttons(ENABLE)) == [Request.ENABLE]
    assert joy.update(axes(), buttons()) == []
    return joy


def test_without_control_nothing_moves():
    joy = JoyControl(JoySettings())
    assert joy.update(axes(x=1.0, yaw=1.0), buttons(HEAD)) == []
    assert joy.update(axes(x=1.0), buttons(INIT, CROUCH)) == []
    assert joy.velocity.is_zero and joy.head is None


def test_sticks_walk_up_to_the_limits(joy):
    joy.update(axes(x=1.0, y=-0.5, turn=1.0), buttons())
    assert joy.velocity == Velocity(1.0, -0.5, 0.5)
    joy.update(axes(), buttons())
    assert joy.velocity.is_zero


def test_the_control_button_toggles_once_each_time_it_is_pressed(joy):
    assert joy.update(axes(x=1.0), buttons(ENABLE)) == [Request.DISABLE]
    assert joy.velocity.is_zero
    assert joy.update(axes(x=1.0), buttons(ENABLE)) == []
    joy.update(axes(), buttons())
    assert joy.update(axes(x=1.0), buttons(ENABLE)) == [Request.ENABLE]
    assert joy.velocity.x == 1.0


def test_a_button_held_at_the_very_first_asks_for_nothing():
    joy = JoyControl(JoySettings())
    assert joy.update(axes(), buttons(ENABLE)) == []
    assert not joy.enabled


def test_poses_are_asked_for_once(joy):
    assert joy.update(axes(), buttons(INIT)) == [Request.INIT_POSE]
    assert joy.update(axes(), buttons(INIT, CROUCH)) == [Request.CROUCH]
    assert joy.update(axes(), buttons(INIT, CROUCH)) == []


def test_with_the_head_button_the_axes_move_the_head_and_the_robot_stands(joy):
    joy.update(axes(x=1.0, yaw=0.5, pitch=-1.0), buttons(HEAD))
    assert joy.velocity.is_zero
    assert joy.head == pytest.approx((0.5 * 2.0943, -0.7853))
    joy.update(axes(x=1.0, yaw=0.5), buttons())
    assert joy.head is None and joy.velocity.x == 1.0


def test_axes_beyond_their_range_are_at_its_end(joy):
    joy.update(axes(x=3.0, turn=-2.0), buttons())
    assert joy.velocity == Velocity(1.0, 0.0, -0.5)


def test_settings_assign_axes_and_buttons():
    joy = JoyControl(JoySettings(axis_x=1, axis_turn=-1, btn_enable_control=2, max_vx=0.4))
    joy.update([0.0, 0.0], [0, 0, 0])
    assert joy.update([1.0, 1.0], [0, 0, 1]) == [Request.ENABLE]
    assert joy.velocity == Velocity(0.4, 0.0, 0.0)


def test_a_small_gamepad_lacks_axes_and_buttons_and_they_rest(joy):
    assert joy.missing() == []
    assert joy.update([0.0, 0.0, 0.0, 1.0], buttons()[:9]) == []
    assert joy.velocity == Velocity(1.0, 0.0, 0.0)
    assert joy.missing() == ["axis_head_yaw 4", "axis_head_pitch 5", "btn_crouch 9"]


def test_a_gamepad_that_went_away_holds_nothing(joy):
    joy.update(axes(x=1.0), buttons())
    joy.release()
    assert joy.velocity.is_zero and joy.enabled
