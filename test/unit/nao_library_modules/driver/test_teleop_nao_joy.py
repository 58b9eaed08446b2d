"""The node between gamepad and driver: parameters, what it sends and how often, a gamepad that goes away."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.driver import teleop_nao_joy
from nao_library_modules.driver.walk_commands import Velocity
from naoqi.errors import NaoError

ENABLE, INIT, CROUCH, HEAD = 8, 0, 9, 5
PERIOD = 0.05


class FakeClients:
    def __init__(self, tell):
        self.velocities = []
        self.heads = []
        self.asked = []

    def walk(self, velocity):
        self.velocities.append(velocity)

    def turn_head(self, angles):
        self.heads.append(angles)

    def say(self, text):
        self.asked.append(("say", text))

    def call(self, service, done=""):
        self.asked.append(("call", service))

    def take_pose(self, name, then=""):
        self.asked.append(("pose", name, then))

    def close(self):
        self.asked.append(("close",))


@pytest.fixture
def parameters(monkeypatch):
    parameters = {"~motion_publish_rate": 1.0 / PERIOD}
    monkeypatch.setattr(teleop_nao_joy.rospy, "get_param", lambda name, default: parameters.get(name, default))
    return parameters


@pytest.fixture
def gamepad(monkeypatch, parameters):
    """The node with control, as `node`; `move` is what a person does, `publishers` how many send messages."""
    made = SimpleNamespace(publishers=1)
    subscriber = SimpleNamespace(get_num_connections=lambda: made.publishers, resolved_name="/joy")
    monkeypatch.setattr(teleop_nao_joy.rospy, "Subscriber", lambda *args, **options: subscriber)
    monkeypatch.setattr(teleop_nao_joy, "TeleopClients", FakeClients)
    made.node = teleop_nao_joy.TeleopNaoJoy()
    made.clients = made.node._clients

    def move(x=0.0, yaw=0.0, pressed=()):
        axes, buttons = [0.0, 0.0, 0.0, x, yaw, 0.0], [int(n in pressed) for n in range(12)]
        made.node._on_joy(SimpleNamespace(axes=axes, buttons=buttons))

    made.move = move
    move()
    move(pressed=[ENABLE])
    move()
    yield made
    made.node.close()


@pytest.mark.parametrize(
    "name, value, words",
    [
        ("~axis_x", 1.5, "~axis_x is 1.5: the number of an axis"),
        ("~btn_crouch", -2, "~btn_crouch is -2"),
        ("~btn_crouch", True, "~btn_crouch is True"),
        ("~max_vx", 1.2, "~max_vx is 1.2: 0 to 1"),
        ("~max_head_yaw", "far", "~max_head_yaw is 'far': 0 to 3.1416"),
    ],
)
def test_wrong_parameters_are_told(parameters, name, value, words):
    parameters[name] = value
    with pytest.raises(NaoError, match=words):
        teleop_nao_joy.read_settings()


def test_parameters_are_the_settings(parameters):
    parameters.update({"~axis_x": -1, "~max_vw": 1, "~btn_head_mod": 7})
    settings = teleop_nao_joy.read_settings()
    assert (settings.axis_x, settings.max_vw, settings.btn_head_mod, settings.axis_y) == (-1, 1.0, 7, 2)


def test_a_velocity_is_repeated_and_a_standstill_sent_once(gamepad, eventually):
    gamepad.move(x=0.5)
    eventually(lambda: len(gamepad.clients.velocities) >= 4)
    assert set(gamepad.clients.velocities) == {Velocity(0.5, 0.0, 0.0)}
    gamepad.move()
    sent = len(gamepad.clients.velocities)
    assert gamepad.clients.velocities[-1].is_zero
    gamepad.move(yaw=0.5, pressed=[HEAD])
    eventually(lambda: len(gamepad.clients.heads) >= 3)  # rounds in which no velocity is sent
    assert len(gamepad.clients.velocities) == sent
    assert gamepad.clients.heads[-1] == pytest.approx((0.5 * 2.0943, 0.0))


def test_buttons_ask_for_what_they_are_for(gamepad):
    for button in (INIT, CROUCH, ENABLE):
        gamepad.move(pressed=[button])
        gamepad.move()
    assert gamepad.clients.asked == [
        ("call", "body_stiffness/enable"),
        ("say", "Gamepad control enabled"),
        ("pose", "init", ""),
        ("pose", "crouch", "body_stiffness/disable"),
        ("call", "stop_walk_srv"),
        ("say", "Gamepad control disabled"),
    ]


def test_a_gamepad_that_goes_away_stops_the_robot(gamepad, eventually):
    gamepad.move(x=0.5)
    eventually(lambda: gamepad.clients.velocities)
    gamepad.publishers = 0
    eventually(lambda: gamepad.clients.velocities[-1].is_zero)
    assert "nobody publishes /joy" in gamepad.node.report().message


def test_a_gamepad_that_falls_silent_stops_the_robot_when_it_should_repeat_itself(gamepad, eventually):
    gamepad.node._timeout = 0.2
    gamepad.move(x=0.5)
    eventually(lambda: len(gamepad.clients.velocities) >= 3 and gamepad.clients.velocities[-1].is_zero)
    assert gamepad.node.report().message == "control is enabled"


def test_the_end_stops_the_robot(gamepad, eventually):
    gamepad.move(x=0.5)
    eventually(lambda: gamepad.clients.velocities)
    gamepad.node.close()
    assert gamepad.clients.velocities[-1].is_zero
    assert gamepad.clients.asked[-1] == ("close",)
