"""Gamepads, keyboards and terminals: what sticks, buttons and keys ask for, and what the node sends for it."""

from __future__ import annotations

import os
import pty
import termios
import threading
from types import SimpleNamespace

import pytest

from nao_library_modules.driver.teleop import teleop_nao_joy
from nao_library_modules.driver.teleop.teleop_nao_joy import JoyControl, JoySettings
from nao_library_modules.driver.teleop.teleop_nao_keyboard import (
    FIRST_HOLD,
    REPEAT_HOLD,
    KeyboardControl,
    KeyCommand,
    KeyRequest,
    TerminalKeys,
    decode,
)
from nao_library_modules.driver.walk.walk_commands import Velocity
from naoqi.errors import NaoError

ENABLE, INIT, CROUCH, HEAD = 8, 0, 9, 5
PATIENCE = 60.0


def axes(**values):
    """Axes by what they do with the default settings."""
    return [values.get(name, 0.0) for name in ("turn", "none", "y", "x", "yaw", "pitch")]


def buttons(*pressed):
    return [int(index in pressed) for index in range(12)]


@pytest.fixture
def joy():
    joy = JoyControl(JoySettings())
    joy.update(axes(), buttons())
    assert joy.update(axes(), buttons(ENABLE)) == [teleop_nao_joy.JoyRequest.ENABLE]
    assert joy.update(axes(), buttons()) == []
    return joy


def test_the_control_button_toggles_once_and_poses_are_asked_for_once(joy):
    assert joy.update(axes(x=1.0), buttons(ENABLE)) == [teleop_nao_joy.JoyRequest.DISABLE]
    assert joy.velocity.is_zero
    assert joy.update(axes(x=1.0), buttons(ENABLE)) == []
    joy.update(axes(), buttons())
    assert joy.update(axes(x=1.0), buttons(ENABLE, INIT)) == [
        teleop_nao_joy.JoyRequest.ENABLE,
        teleop_nao_joy.JoyRequest.INIT_POSE,
    ]
    assert joy.velocity.x == 1.0
    assert joy.update(axes(), buttons(INIT, CROUCH)) == [teleop_nao_joy.JoyRequest.CROUCH]
    assert joy.update(axes(), buttons(INIT, CROUCH)) == []


def test_without_control_nothing_moves():
    joy = JoyControl(JoySettings())
    assert joy.update(axes(), buttons(ENABLE)) == []  # held at the very first
    assert joy.update(axes(x=1.0, yaw=1.0), buttons(HEAD)) == []
    assert joy.update(axes(x=1.0), buttons(INIT, CROUCH)) == []
    assert joy.velocity.is_zero and joy.head is None and not joy.enabled


def test_sticks_walk_up_to_the_limits_and_release_holds_nothing(joy):
    for given, velocity in (
        (axes(x=1.0, y=-0.5, turn=1.0), (1.0, -0.5, 0.5)),
        (axes(x=3.0, turn=-2.0), (1.0, 0.0, -0.5)),
        (axes(), (0.0, 0.0, 0.0)),
        (axes(x=1.0), (1.0, 0.0, 0.0)),
    ):
        joy.update(given, buttons())
        assert joy.velocity == Velocity(*velocity)
    joy.release()
    assert joy.velocity.is_zero and joy.enabled


def test_with_the_head_button_the_axes_move_the_head_and_the_robot_stands(joy):
    joy.update(axes(x=1.0, yaw=0.5, pitch=-1.0), buttons(HEAD))
    assert joy.velocity.is_zero and joy.head == pytest.approx((0.5 * 2.0943, -0.7853))
    joy.update(axes(x=1.0, yaw=0.5), buttons())
    assert joy.head is None and joy.velocity.x == 1.0


def test_settings_assign_axes_and_buttons_and_those_that_are_missing_rest(joy):
    other = JoyControl(JoySettings(axis_x=1, axis_turn=-1, btn_enable_control=2, max_vx=0.4))
    other.update([0.0, 0.0], [0, 0, 0])
    assert other.update([1.0, 1.0], [0, 0, 1]) == [teleop_nao_joy.JoyRequest.ENABLE]
    assert other.velocity == Velocity(0.4, 0.0, 0.0)
    assert joy.missing() == []
    assert joy.update([0.0, 0.0, 0.0, 1.0], buttons()[:9]) == []
    assert joy.velocity == Velocity(1.0, 0.0, 0.0)
    assert joy.missing() == ["axis_head_yaw 4", "axis_head_pitch 5", "btn_crouch 9"]


@pytest.fixture
def parameters(monkeypatch):
    parameters = {"~motion_publish_rate": 20.0}
    monkeypatch.setattr(teleop_nao_joy.rospy, "get_param", lambda name, default: parameters.get(name, default))
    return parameters


def test_wrong_parameters_are_told(parameters):
    parameters.update({"~axis_y": -1, "~max_vw": 1, "~btn_head_mod": 7})
    settings = teleop_nao_joy.read_settings()
    assert (settings.axis_y, settings.max_vw, settings.btn_head_mod, settings.axis_x) == (-1, 1.0, 7, 3)
    for name, value, allowed in (
        ("~axis_x", 1.5, "the number of an axis"),
        ("~btn_crouch", -2, ""),
        ("~max_head_yaw", "far", "0 to 3.1416"),
    ):
        parameters[name] = value
        with pytest.raises(NaoError, match=f"{name} is {value!r}: {allowed}"):
            teleop_nao_joy.read_settings()
        del parameters[name]


@pytest.fixture
def pad(monkeypatch, parameters):
    """The node with control: `move` is what a person does, the lists are what it sends."""
    parameters["~joy_timeout"] = 0.2
    pad = SimpleNamespace(publishers=1, velocities=[], heads=[], asked=[], close=lambda: None)
    pad.walk, pad.turn_head, pad.say = pad.velocities.append, pad.heads.append, lambda text: None
    pad.call = lambda service, done="": pad.asked.append(service)
    pad.take_pose = lambda name, then="": pad.asked.append((name, then))

    def subscribe(topic, kind, callback, **options):
        pad.tell = callback
        return SimpleNamespace(get_num_connections=lambda: pad.publishers, resolved_name="/joy")

    monkeypatch.setattr(teleop_nao_joy.rospy, "Subscriber", subscribe)
    monkeypatch.setattr(teleop_nao_joy, "TeleopClients", lambda tell: pad)
    pad.node = teleop_nao_joy.TeleopNaoJoy()
    pad.move = lambda pressed=(), **values: pad.tell(SimpleNamespace(axes=axes(**values), buttons=buttons(*pressed)))
    for pressed in ([], [ENABLE], []):
        pad.move(pressed)
    yield pad
    pad.node.close()


def test_a_velocity_is_repeated_until_the_gamepad_is_silent_or_goes_away(pad):
    def soon(condition):
        pause = threading.Event()
        assert any(condition() or pause.wait(0.005) for _ in range(int(PATIENCE / 0.005)))

    sent = pad.velocities
    pad.move(x=0.5)
    soon(lambda: len(sent) >= 3 and sent[-1].is_zero)  # it fell silent
    assert set(sent[:-1]) == {Velocity(0.5, 0.0, 0.0)}
    assert pad.node.report().message == "control is enabled"
    pad.move([HEAD], yaw=0.5)
    soon(lambda: len(pad.heads) >= 2)
    assert pad.heads[-1] == pytest.approx((0.5 * 2.0943, 0.0)) and sum(each.is_zero for each in sent) == 1
    pad.move(x=1.0)
    pad.publishers = 0
    soon(lambda: "no publisher of /joy" in pad.node.report().message and sent[-1].is_zero)
    for button in (INIT, CROUCH, ENABLE):
        pad.move([button])
        pad.move()
    assert pad.asked == ["body_stiffness/enable", ("init", ""), ("crouch", "body_stiffness/disable"), "stop_walk_srv"]


@pytest.fixture
def keyboard():
    return KeyboardControl(["init", "crouch"], speed=0.5)


def test_keys_walk_and_the_last_one_counts(keyboard):
    ways = {
        "up": (0.5, 0, 0),
        "s": (-0.5, 0, 0),
        "left": (0, 0.5, 0),
        "d": (0, -0.5, 0),
        "q": (0, 0, 0.5),
        "E": (0, 0, -0.5),
    }
    for key, velocity in ways.items():
        assert keyboard.press(key, 10.0) is None
        assert keyboard.velocity(10.1) == Velocity(*velocity)


def test_a_key_walks_while_a_terminal_repeats_it_and_no_longer(keyboard):
    keyboard.press("w", 5.0)
    assert keyboard.velocity(5.0 + FIRST_HOLD).is_zero and keyboard.velocity(5.1).is_zero  # what has ended stays so
    keyboard.press("w", 10.0)
    assert not keyboard.velocity(10.0 + FIRST_HOLD - 0.01).is_zero
    for n in range(20):
        last = 10.6 + n * 0.04
        keyboard.press("w", last)
    assert not keyboard.velocity(last + REPEAT_HOLD - 0.01).is_zero
    assert keyboard.velocity(last + REPEAT_HOLD + 0.01).is_zero


def test_speed_changes_in_steps_and_has_limits_while_it_walks(keyboard):
    keyboard.press("w", 10.0)
    assert keyboard.press("+", 10.1) == KeyRequest(KeyCommand.SPEED, "60 % of the top speed")
    assert keyboard.velocity(10.2).x == 0.6
    for key, limit in (("=", 1.0), ("-", 0.1)):
        for _ in range(20):
            keyboard.press(key, 10.2)
        assert keyboard.speed == limit


def test_other_keys_end_a_walk_and_ask_for_something(keyboard):
    asked = {
        "1": (KeyCommand.POSE, "init"),
        "3": (KeyCommand.UNKNOWN, "3"),
        " ": (KeyCommand.STOP,),
        "m": (KeyCommand.WAKE_UP,),
    }
    asked.update(
        {"n": (KeyCommand.REST,), "?": (KeyCommand.HELP,), "x": (KeyCommand.QUIT,), "escape": (KeyCommand.QUIT,)}
    )
    for key, request in asked.items():
        keyboard.press("w", 10.0)
        assert keyboard.press(key, 10.0) == KeyRequest(*request)
        assert keyboard.velocity(10.1).is_zero
    for word in ("1 init   2 crouch", "forward", "turn to the left", "stop", "speed", "motors on", "end"):
        assert word in keyboard.help


def test_keys_count_at_once_and_the_settings_come_back_also_after_an_error():
    keyboard, program = pty.openpty()
    flags = lambda: termios.tcgetattr(program)[3] & (termios.ICANON | termios.ECHO)  # noqa: E731
    before = flags()
    with pytest.raises(RuntimeError), TerminalKeys(program) as keys:
        assert before and flags() == 0
        os.write(keyboard, b"w\x1b[A")
        assert keys.read(PATIENCE) == ["w", "up"]
        assert keys.read(0.0) == []
        raise RuntimeError("whatever")
    assert flags() == before
    with TerminalKeys(program) as keys:
        os.close(keyboard)
        assert keys.read(PATIENCE) == ["ctrl-d"]
    assert decode("ww1 \x1b[A\x1b[B\x1b[C\x1b[D") == ["w", "w", "1", " ", "up", "down", "right", "left"]
    assert decode("\x1bOAw\x1b[1;5A\x03\x04\x1b") == ["up", "w", "up", "ctrl-c", "ctrl-d", "escape"]
    os.close(program)
