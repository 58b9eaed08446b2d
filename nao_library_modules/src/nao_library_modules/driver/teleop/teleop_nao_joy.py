"""The node teleop_nao_joy: walks the robot and turns its head with a gamepad."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from enum import Enum

import rospy
from sensor_msgs.msg import Joy

from naoqi.errors import NaoError

from ...core.fields import limit, number_parameter
from ...core.health import Level, Report
from ...core.waiting import CancellationToken, WallClock
from ..base.polling import Rate
from ..walk.walk_commands import STANDSTILL, Velocity
from .teleop_clients import TeleopClients


class JoyRequest(Enum):
    """What a button asks for, once each time it is pressed."""

    ENABLE = "gamepad control enabled"
    DISABLE = "gamepad control disabled"
    INIT_POSE = "init"
    CROUCH = "crouch"


@dataclass(frozen=True)
class JoySettings:
    """Indices of axes and buttons (-1: none), and the ranges of the axes."""

    axis_x: int = 3  # walk forward
    axis_y: int = 2  # walk to the left
    axis_turn: int = 0  # turn to the left
    axis_head_yaw: int = 4  # while btn_head_mod is held
    axis_head_pitch: int = 5  # while btn_head_mod is held
    btn_crouch: int = 9  # crouch, and then the motors go off
    btn_init_pose: int = 0  # stand up
    btn_enable_control: int = 8  # take control, and give it back
    btn_head_mod: int = 5  # while it is held the axes move the head, and the robot stands
    max_vx: float = 1.0  # fraction of the top speed at the end of the axis, 0 to 1
    max_vy: float = 1.0  # the same
    max_vw: float = 0.5  # the same
    max_head_yaw: float = 2.0943  # rad at the end of the axis
    max_head_pitch: float = 0.7853  # rad


class JoyControl:
    """The state of one gamepad. For one thread.

    `velocity` is to be walked; `head` is its yaw and pitch in rad, None while its button is not held.
    """

    def __init__(self, settings: JoySettings) -> None:
        self._settings = settings
        self._buttons: list[int] | None = None
        self._axes_now: Sequence[float] = ()
        self.enabled = False
        self.velocity = STANDSTILL
        self.head: tuple[float, float] | None = None

    def update(self, axes: Sequence[float], buttons: Sequence[int]) -> list[JoyRequest]:
        """Take the state of the gamepad.

        `axes`: positions, -1 to 1. `buttons`: 1 for those that are pressed. Returns requests of buttons that were not
        pressed before. Those held in the very first state request nothing.
        """
        settings = self._settings
        before = list(buttons) if self._buttons is None else self._buttons
        self._buttons, self._axes_now = list(buttons), axes
        requests = []
        if self._pressed(settings.btn_enable_control, before):
            self.enabled = not self.enabled
            requests.append(JoyRequest.ENABLE if self.enabled else JoyRequest.DISABLE)
        if self.enabled:
            if self._pressed(settings.btn_init_pose, before):
                requests.append(JoyRequest.INIT_POSE)
            if self._pressed(settings.btn_crouch, before):
                requests.append(JoyRequest.CROUCH)
        head = self.enabled and _at(buttons, settings.btn_head_mod) == 1
        self.velocity, self.head = STANDSTILL, None
        if head:
            self.head = (
                self._axis(settings.axis_head_yaw, settings.max_head_yaw),
                self._axis(settings.axis_head_pitch, settings.max_head_pitch),
            )
        elif self.enabled:
            self.velocity = Velocity(
                self._axis(settings.axis_x, settings.max_vx),
                self._axis(settings.axis_y, settings.max_vy),
                self._axis(settings.axis_turn, settings.max_vw),
            )
        return requests

    def missing(self) -> list[str]:
        """Settings whose axis or button the gamepad does not have, as its last message shows."""
        have = {"axis": len(self._axes_now), "btn": len(self._buttons or ())}
        return [
            f"{name} {index}"
            for name, index in vars(self._settings).items()
            if name.split("_")[0] in have and index >= have[name.split("_")[0]]
        ]

    def release(self) -> None:
        """Stop everything: the gamepad went away."""
        self.velocity, self.head = STANDSTILL, None

    def _pressed(self, index: int, before: Sequence[int]) -> bool:
        return _at(self._buttons or (), index) == 1 and _at(before, index) != 1

    def _axis(self, index: int, scale: float) -> float:
        value = _at(self._axes_now, index)
        return scale * max(-1.0, min(1.0, value)) if math.isfinite(value) else 0.0  # what is no number moves nothing


def _at(values: Sequence[float], index: int) -> float:
    return values[index] if 0 <= index < len(values) else 0


DEFAULT_RATE = 10.0
RATE, TIMEOUT = "~motion_publish_rate", "~joy_timeout"
LOSE_LIMIT = 2.0


class TeleopNaoJoy:
    """Gamepad control. One button takes control and gives it back; without control nothing is sent.

    A velocity is sent again and again while a stick is away from its rest, so that nao_walker does not take the
    gamepad for lost, and once when it comes to rest. When the gamepad goes away, the robot stops.

    ROS API (relative names):
        Subscribes `joy` (sensor_msgs/Joy). The driver of gamepads, the node `joy_node` of the package `joy`, is not
        packaged for Debian; it is for ROS Noetic, and builds from its sources.
        Publishes and calls what `TeleopClients` has. Walking is inhibited at nao_walker, for every sender.
        Parameters: the fields of `JoySettings`; `~motion_publish_rate` (10 Hz); `~joy_timeout` (0: none; s without a
        message after which the robot stops. Only for gamepads whose node repeats itself: `~autorepeat_rate` of joy).
    """

    def __init__(self) -> None:
        self._control = JoyControl(read_settings())
        rate = number_parameter(RATE, rospy.get_param(RATE, DEFAULT_RATE), limit("teleop rate"))
        self._timeout = number_parameter(TIMEOUT, rospy.get_param(TIMEOUT, 0.0), limit("timeout"))
        self._wall = WallClock()
        self._lock = threading.Lock()  # guards the three below
        self._heard: float | None = None
        self._moving = False
        self._told_missing = False
        self._clients = TeleopClients(lambda text: rospy.loginfo("%s", text))
        self._interrupt = CancellationToken()
        self._joy = rospy.Subscriber("joy", Joy, self._on_joy, queue_size=10)
        self._thread = threading.Thread(target=self._run, args=(1.0 / rate,), name="gamepad", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Send nothing any more; a walking robot is stopped."""
        self._interrupt.stop()
        self._thread.join(LOSE_LIMIT)
        with self._lock:
            self._control.release()
            with suppress(rospy.ROSException):  # where the topics are closed already nao_walker stops by itself
                self._send()
        self._clients.close()

    def report(self) -> Report:
        values = {"control": "enabled" if self._control.enabled else "disabled"}
        if not self._joy.get_num_connections():
            return Report(Level.WARN, f"no publisher of {self._joy.resolved_name}", values)
        return Report(Level.OK, f"control is {values['control']}", values)

    def _on_joy(self, message: Joy) -> None:
        with self._lock:
            self._heard = self._wall.now()
            for request in self._control.update(message.axes, message.buttons):
                self._carry_out(request)
            if not self._told_missing:
                self._told_missing = True
                missing = self._control.missing()
                if missing:
                    rospy.logwarn("the gamepad does not have %s", ", ".join(missing))
            if self._moving and self._control.velocity.is_zero:
                self._send()  # a stop does not wait for its turn

    def _carry_out(self, request: JoyRequest) -> None:
        if request is JoyRequest.ENABLE:
            self._clients.call("body_stiffness/enable", request.value)
            self._clients.say("Gamepad control enabled")
        elif request is JoyRequest.DISABLE:
            self._clients.call("stop_walk_srv", request.value)
            self._clients.say("Gamepad control disabled")
        elif request is JoyRequest.CROUCH:
            self._clients.take_pose(request.value, then="body_stiffness/disable")
        else:
            self._clients.take_pose(request.value)

    def _run(self, period: float) -> None:
        rate = Rate(self._wall, period, period / 2, self._interrupt)
        while rate.wait():
            with self._lock:
                if self._heard is not None and self._is_lost():
                    rospy.logwarn("the gamepad went away")
                    self._heard = None
                    self._control.release()
                self._send()

    def _is_lost(self) -> bool:
        silent = self._timeout > 0.0 and self._wall.now() - (self._heard or 0.0) > self._timeout
        return silent or not self._joy.get_num_connections()

    def _send(self) -> None:
        """Send what is due; with the lock."""
        velocity, head = self._control.velocity, self._control.head
        if self._moving or not velocity.is_zero:
            self._moving = not velocity.is_zero
            self._clients.walk(velocity)
        if head is not None:
            self._clients.turn_head(head)


def read_settings() -> JoySettings:
    """Settings from the parameters of the node; raises NaoError."""
    values = {}
    for field in fields(JoySettings):
        name, value = f"~{field.name}", rospy.get_param(f"~{field.name}", field.default)
        if isinstance(field.default, int):
            if isinstance(value, bool) or not isinstance(value, int) or value < -1:
                raise NaoError(f"{name} is {value!r}: the number of an axis or button from 0, -1 for none")
        else:
            kind = "share" if field.name.startswith("max_v") else "head angle"
            value = number_parameter(name, value, limit(kind))
        values[field.name] = value
    return JoySettings(**values)
