"""The node teleop_nao_keyboard: keys of a terminal walk the robot."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence

import rospy

from .keyboard_control import KeyboardControl, KeyCommand, KeyRequest
from .teleop_clients import TeleopClients
from .terminal_keys import TerminalKeys

PERIOD = 0.1
"""s of real time between two velocities while a key is held."""
DEFAULT_POSES = ("init", "zero", "crouch")


class TeleopNaoKeyboard:
    """Keyboard control. Everything runs in the thread that calls `run`; only lines of text come from others.

    While a key is held its velocity is sent ten times a second, and a standstill when it is released. Should this
    program end in any other way, nao_walker stops the robot because the commands cease.

    ROS API (relative names):
        Publishes and calls what `TeleopClients` has.
        Parameters `~poses` (init, zero, crouch; names for the keys 1, 2, ...), `~speed` (0.5: fraction of the top
        speed to begin with).
    """

    def __init__(self, poses: Sequence[str], speed: float) -> None:
        self._control = KeyboardControl(poses, speed)
        self._clients = TeleopClients(self._tell)
        self._walking = False
        self._actions: dict[KeyCommand, Callable[[KeyRequest], None]] = {
            KeyCommand.STOP: self._stop,
            KeyCommand.POSE: lambda request: self._clients.take_pose(request.detail),
            KeyCommand.WAKE_UP: lambda request: self._clients.call("wakeup", "the robot is awake"),
            KeyCommand.REST: lambda request: self._clients.call("rest", "the robot rests"),
            KeyCommand.SPEED: lambda request: self._tell(request.detail),
            KeyCommand.HELP: lambda request: self._tell(self._control.help),
            KeyCommand.UNKNOWN: lambda request: self._tell(f"{request.detail!r} does nothing; h for help"),
        }

    def run(self, keys: TerminalKeys) -> None:
        """Obey keys until one of them ends it, or the node ends."""
        self._tell(self._control.help)
        try:
            while not rospy.is_shutdown():
                for key in keys.read(PERIOD):
                    request = self._control.press(key, time.monotonic())
                    if request is None:
                        continue
                    if request.kind is KeyCommand.QUIT:
                        return
                    self._actions[request.kind](request)
                self._walk()
        finally:
            if self._walking and not rospy.is_shutdown():
                self._clients.walk(self._control.velocity(float("inf")))
            self._clients.close()

    def _walk(self) -> None:
        velocity = self._control.velocity(time.monotonic())
        if self._walking or not velocity.is_zero:
            self._walking = not velocity.is_zero
            self._clients.walk(velocity)

    def _stop(self, _: KeyRequest) -> None:
        self._tell("stop")
        self._walking = False
        self._clients.walk(self._control.velocity(float("inf")))
        self._clients.call("stop_walk_srv", "the robot stands")

    @staticmethod
    def _tell(text: str) -> None:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
