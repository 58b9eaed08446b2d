"""The node teleop_nao_keyboard: walks the robot with the keys of a terminal."""

from __future__ import annotations

import atexit
import os
import select
import sys
import termios
import time
import tty
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum

import rospy

from naoqi.errors import NaoError

from ..walk.walk_commands import STANDSTILL, Velocity
from .teleop_clients import TeleopClients

FIRST_HOLD = 0.7
"""s that a key counts as held after it was pressed: terminals repeat a key only after half a second or so."""
REPEAT_HOLD = 0.25
"""s that a key counts as held after a repetition."""
SLOWEST, SPEED_STEP = 0.1, 0.1

DIRECTIONS: Mapping[str, Velocity] = {
    "w": Velocity(1.0, 0.0, 0.0),
    "s": Velocity(-1.0, 0.0, 0.0),
    "a": Velocity(0.0, 1.0, 0.0),
    "d": Velocity(0.0, -1.0, 0.0),
    "q": Velocity(0.0, 0.0, 1.0),
    "e": Velocity(0.0, 0.0, -1.0),
}
ARROWS: Mapping[str, str] = {"up": "w", "down": "s", "left": "a", "right": "d"}
HELP = """\
  w / up       forward           q   turn to the left      space   stop
  s / down     back              e   turn to the right     + -     speed
  a / left     to the left       m   motors on             h ?     this help
  d / right    to the right      n   rest, motors off      x       end
  {poses}
The robot walks while a key is held."""


class KeyCommand(Enum):
    """What a key asks for."""

    STOP = "stop"
    POSE = "pose"
    WAKE_UP = "motors on"
    REST = "rest"
    SPEED = "speed"
    HELP = "help"
    QUIT = "quit"
    UNKNOWN = "unknown key"


@dataclass(frozen=True)
class KeyRequest:
    """What a key asks for, beside walking."""

    kind: KeyCommand
    detail: str = ""  # name of the pose, the speed in words, or the key


REQUESTS: Mapping[str, KeyRequest] = {
    " ": KeyRequest(KeyCommand.STOP),
    "m": KeyRequest(KeyCommand.WAKE_UP),
    "n": KeyRequest(KeyCommand.REST),
    "h": KeyRequest(KeyCommand.HELP),
    "?": KeyRequest(KeyCommand.HELP),
    "x": KeyRequest(KeyCommand.QUIT),
    "ctrl-c": KeyRequest(KeyCommand.QUIT),
    "ctrl-d": KeyRequest(KeyCommand.QUIT),
    "escape": KeyRequest(KeyCommand.QUIT),
}


class KeyboardControl:
    """The state of one keyboard; `speed` is a fraction of the top speed, 0.1 to 1. For one thread."""

    def __init__(self, poses: Sequence[str], speed: float = 0.5) -> None:
        """Start with no key held; the keys 1 to 9 are for `poses`."""
        self.speed = speed
        self._poses = {str(number): name for number, name in enumerate(poses[:9], start=1)}
        self._key: str | None = None
        self._until = 0.0

    @property
    def help(self) -> str:
        return HELP.format(poses="   ".join(f"{key} {name}" for key, name in self._poses.items()))

    def press(self, key: str, now: float) -> KeyRequest | None:
        """A key (a character, or the name of a key) was pressed, or is repeated because it is held.

        Returns what it asks for, if it does not walk.
        """
        key = ARROWS.get(key, key.lower())
        if key in DIRECTIONS:
            repeated = key == self._key and now < self._until
            self._key, self._until = key, now + (REPEAT_HOLD if repeated else FIRST_HOLD)
            return None
        if key in ("+", "-", "="):  # plus is the upper one of its key
            change = -SPEED_STEP if key == "-" else SPEED_STEP
            self.speed = round(min(1.0, max(SLOWEST, self.speed + change)), 2)
            return KeyRequest(KeyCommand.SPEED, f"{100 * self.speed:.0f} % of the top speed")
        self._key = None  # what is not walking ends it
        if key in self._poses:
            return KeyRequest(KeyCommand.POSE, self._poses[key])
        return REQUESTS.get(key, KeyRequest(KeyCommand.UNKNOWN, key))

    def velocity(self, now: float) -> Velocity:
        if self._key is None or now >= self._until:
            self._key = None
            return STANDSTILL
        direction = DIRECTIONS[self._key]
        return Velocity(self.speed * direction.x, self.speed * direction.y, self.speed * direction.theta)


SEQUENCES = {
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
}
"""Last character of the sequences that arrow keys send after escape and [ or O."""
CONTROL = {"\x03": "ctrl-c", "\x04": "ctrl-d"}
ESCAPE = "\x1b"
LONGEST = 1024


class TerminalKeys:
    """A terminal whose keys arrive at once (cbreak mode). A context manager; inside, `read` gives keys."""

    def __init__(self, file: int) -> None:
        """Take a terminal by its file descriptor; raises NaoError if it is none."""
        if not os.isatty(file):
            raise NaoError("keys need a terminal: start this in one with rosrun, not by a launch file or a pipe")
        self._file = file
        self._before = termios.tcgetattr(file)

    def __enter__(self) -> TerminalKeys:
        atexit.register(self.restore)  # for an end that does not pass through here
        tty.setcbreak(self._file)
        return self

    def __exit__(self, *_: object) -> None:
        self.restore()
        atexit.unregister(self.restore)

    def restore(self) -> None:
        """Restore the settings of the terminal; keys not read yet are discarded."""
        with suppress(termios.error, OSError):  # where the terminal is gone, its settings are with it
            termios.tcsetattr(self._file, termios.TCSAFLUSH, self._before)

    def read(self, limit: float) -> list[str]:
        """Keys since the last call, after waiting for one at most `limit` s.

        "ctrl-d" when the terminal is gone.
        """
        ready, _, _ = select.select([self._file], [], [], limit)
        if not ready:
            return []
        try:
            text = os.read(self._file, LONGEST)
        except OSError:
            text = b""
        return decode(text.decode(errors="replace")) if text else ["ctrl-d"]


def decode(text: str) -> list[str]:
    """Names of the keys in the text of a terminal; sequences of arrow keys come in one piece."""
    keys = []
    place = 0
    while place < len(text):
        if text[place] == ESCAPE and text[place + 1 : place + 2] in ("[", "O"):
            end = place + 2
            while end < len(text) and not text[end].isalpha() and text[end] != "~":
                end += 1
            name = SEQUENCES.get(text[end : end + 1])
            keys.append(name or "another key")
            place = end + 1
        else:
            character = text[place]
            keys.append("escape" if character == ESCAPE else CONTROL.get(character, character))
            place += 1
    return keys


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
        self._clients = TeleopClients(self._print)
        self._walking = False
        self._actions: dict[KeyCommand, Callable[[KeyRequest], None]] = {
            KeyCommand.STOP: self._stop,
            KeyCommand.POSE: lambda request: self._clients.take_pose(request.detail),
            KeyCommand.WAKE_UP: lambda request: self._clients.call("wakeup", "the robot is awake"),
            KeyCommand.REST: lambda request: self._clients.call("rest", "the robot rests"),
            KeyCommand.SPEED: lambda request: self._print(request.detail),
            KeyCommand.HELP: lambda request: self._print(self._control.help),
            KeyCommand.UNKNOWN: lambda request: self._print(f"{request.detail!r} does nothing; h for help"),
        }

    def run(self, keys: TerminalKeys) -> None:
        """Obey keys until one of them ends it, or the node ends."""
        self._print(self._control.help)
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
        self._print("stop")
        self._walking = False
        self._clients.walk(self._control.velocity(float("inf")))
        self._clients.call("stop_walk_srv", "the robot stands")

    @staticmethod
    def _print(text: str) -> None:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
