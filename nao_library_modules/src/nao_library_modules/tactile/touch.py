"""When a touch is the one that somebody waits for: pressed, let go, held, or pressed several times. Pure."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

PRESS, RELEASE, HOLD, COUNT = "press", "release", "hold", "count"
KINDS = (PRESS, RELEASE, HOLD, COUNT)
SWAPPED = 0.05
"""s by which a press may seem later than its release where only their arrivals are known: libqi tells each in a thread,
and so in any order."""


@dataclass(frozen=True)
class WantedTouch:
    kind: str = PRESS  # one of `KINDS`
    count: int = 2  # how many presses (count)
    duration: float = 1.0  # s, how long a hold lasts, or within what time a count has to come


class Contact(NamedTuple):
    name: str  # short name of the sensor
    begin: float  # ROS time of the first contact, s
    end: float = 0.0  # that of the last one; 0 while it lasts


class TouchWatch:
    """Tells of each touch that is wanted. Times are passed in, s: when sensors changed, not when that was heard of.

    What is pressed when the watch begins counts for a release and, from then on, for a hold, but it is no press.

    Args:
        wanted: What counts.
        pressed: What is pressed already: name -> time of the first contact.
        now: When the watch begins.
    """

    def __init__(self, wanted: WantedTouch, pressed: Mapping[str, float], now: float) -> None:
        self._wanted = wanted
        self._begin = now
        self._since = dict(pressed)
        # Who asked for events before asking what is pressed may be told of the same press twice.
        self._untold = set(self._since)
        self._released: dict[str, float] = {}  # when sensors were let go that nobody knew to be pressed
        self._held: set[str] = set()
        self._presses: deque[tuple[float, str]] = deque()

    @property
    def pressed(self) -> list[str]:
        """What is pressed now, in the order in which it was."""
        return list(self._since)

    @property
    def due(self) -> float | None:
        """When `look` may have something to tell; None if only a touch can change that."""
        if self._wanted.kind != HOLD:
            return None
        begun = [max(since, self._begin) for name, since in self._since.items() if name not in self._held]
        return min(begun) + self._wanted.duration if begun else None

    def tell(self, name: str, pressed: bool, now: float) -> list[Contact]:
        """Take a change of a sensor; returns what has been touched as wanted by it."""
        held_enough = self.look(now)
        untold = name in self._untold
        self._untold.discard(name)
        if pressed == (name in self._since) and not (pressed and untold):
            if not pressed:
                self._released[name] = now
            return held_enough
        if pressed:
            self._since[name] = min(self._since.get(name, now), now)
            found = self._pressed(name, now)
            released = self._released.pop(name, None)
            if released is None or now - released > SWAPPED:
                return [*held_enough, *found]
            return self.tell(name, False, max(now, released)) or found
        begin = self._since.pop(name)
        self._held.discard(name)
        if self._wanted.kind == RELEASE:
            return [Contact(name, begin, now)]
        return [held._replace(end=now) if held.name == name else held for held in held_enough]

    def look(self, now: float) -> list[Contact]:
        """What has been held long enough by now, and was not told of before."""
        if self._wanted.kind != HOLD:
            return []
        # Sums of times are not exact: who waits until `due` comes a hair before.
        limit = now - self._wanted.duration + 1e-6
        held = [
            Contact(name, since)
            for name, since in self._since.items()
            if max(since, self._begin) <= limit and name not in self._held
        ]
        self._held.update(contact.name for contact in held)
        return held

    def _pressed(self, name: str, now: float) -> list[Contact]:
        if self._wanted.kind == PRESS:
            return [Contact(name, now)]
        if self._wanted.kind != COUNT:
            return []
        self._presses.append((now, name))
        while self._presses[0][0] < now - self._wanted.duration - 1e-6:
            self._presses.popleft()
        if len(self._presses) < self._wanted.count:
            return []
        first: dict[str, float] = {}
        for time, pressed in self._presses:
            first.setdefault(pressed, time)
        self._presses.clear()
        return [Contact(*each) for each in first.items()]
