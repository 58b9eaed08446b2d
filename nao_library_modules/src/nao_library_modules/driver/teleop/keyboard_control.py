"""Keys become walking while one is held, poses, motors, speed. Arithmetic only; times are passed in, in s. No ROS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from ..walk.walk_commands import STANDSTILL, Velocity

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
