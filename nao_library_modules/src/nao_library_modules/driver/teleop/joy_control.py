"""Axes and buttons of a gamepad become a velocity, angles of the head, and requests. No ROS."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from ..walk.walk_commands import STANDSTILL, Velocity


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
