"""What keys ask for."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.keyboard_control import FIRST_HOLD, REPEAT_HOLD, KeyboardControl, Kind, Request
from nao_library_modules.driver.walk_commands import Velocity


@pytest.fixture
def keyboard():
    return KeyboardControl(["init", "crouch"], speed=0.5)


@pytest.mark.parametrize(
    "key, velocity",
    [
        ("w", (0.5, 0.0, 0.0)),
        ("up", (0.5, 0.0, 0.0)),
        ("s", (-0.5, 0.0, 0.0)),
        ("left", (0.0, 0.5, 0.0)),
        ("d", (0.0, -0.5, 0.0)),
        ("q", (0.0, 0.0, 0.5)),
        ("E", (0.0, 0.0, -0.5)),
    ],
)
def test_keys_walk(keyboard, key, velocity):
    assert keyboard.press(key, 10.0) is None
    assert keyboard.velocity(10.1) == Velocity(*velocity)


def test_a_key_walks_while_a_terminal_repeats_it_and_no_longer(keyboard):
    keyboard.press("w", 10.0)
    assert not keyboard.velocity(10.0 + FIRST_HOLD - 0.01).is_zero
    for n in range(20):
        keyboard.press("w", 10.6 + n * 0.04)
    last = 10.6 + 19 * 0.04
    assert not keyboard.velocity(last + REPEAT_HOLD - 0.01).is_zero
    assert keyboard.velocity(last + REPEAT_HOLD + 0.01).is_zero


def test_a_key_pressed_once_walks_for_a_moment(keyboard):
    keyboard.press("w", 10.0)
    assert keyboard.velocity(10.0 + FIRST_HOLD).is_zero
    assert keyboard.velocity(10.1).is_zero  # what has ended stays so


def test_the_last_key_counts(keyboard):
    keyboard.press("w", 10.0)
    keyboard.press("q", 10.1)
    assert keyboard.velocity(10.2) == Velocity(0.0, 0.0, 0.5)


@pytest.mark.parametrize("key", [" ", "1", "m", "n", "h", "y"])
def test_whatever_does_not_walk_ends_a_walk(keyboard, key):
    keyboard.press("w", 10.0)
    assert keyboard.press(key, 10.1) is not None
    assert keyboard.velocity(10.1).is_zero


def test_speed_changes_in_steps_and_has_limits_while_it_walks(keyboard):
    keyboard.press("w", 10.0)
    assert keyboard.press("+", 10.1) == Request(Kind.SPEED, "60 % of the top speed")
    assert keyboard.velocity(10.2).x == 0.6
    for _ in range(20):
        keyboard.press("=", 10.2)
    assert keyboard.speed == 1.0
    for _ in range(20):
        keyboard.press("-", 10.2)
    assert keyboard.speed == 0.1


@pytest.mark.parametrize(
    "key, request_",
    [
        ("1", Request(Kind.POSE, "init")),
        ("2", Request(Kind.POSE, "crouch")),
        ("3", Request(Kind.UNKNOWN, "3")),
        (" ", Request(Kind.STOP)),
        ("m", Request(Kind.WAKE_UP)),
        ("n", Request(Kind.REST)),
        ("?", Request(Kind.HELP)),
        ("x", Request(Kind.QUIT)),
        ("escape", Request(Kind.QUIT)),
        ("ctrl-d", Request(Kind.QUIT)),
    ],
)
def test_other_keys(keyboard, key, request_):
    assert keyboard.press(key, 10.0) == request_


def test_the_help_names_all_keys(keyboard):
    assert "1 init   2 crouch" in keyboard.help
    for word in ("forward", "turn to the left", "stop", "speed", "motors on", "end"):
        assert word in keyboard.help
