"""When a touch is the one that somebody waits for: pressed, let go, held, or pressed several times. Pure."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

PRESS, RELEASE, HOLD, COUNT = "press", "release", "hold", "count"
KINDS = (PRESS, RELEASE, HOLD, COUNT)


@dataclass(frozen=True)
class Wanted:
    """A kind of touch.

    Attributes:
        kind: One of `KINDS`.
        count: How many presses (count).
        duration: s, how long a hold lasts, or within what time a count has to come.
    """

    kind: str = PRESS
    count: int = 2
    duration: float = 1.0


class TouchWatch:
    """Tells of each touch that is wanted. Times are passed in, s.

    What is pressed when the watch begins counts for a hold and for a release, but it is no press.

    Args:
        wanted: What counts.
        pressed: What is pressed already, by name.
        now: When that is.
    """

    def __init__(self, wanted: Wanted, pressed: Iterable[str], now: float) -> None:
        self._wanted = wanted
        self._since = dict.fromkeys(pressed, now)
        # Who asked for events before asking what is pressed may be told of the same press twice.
        self._untold = set(self._since)
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
        begun = [since for name, since in self._since.items() if name not in self._held]
        return min(begun) + self._wanted.duration if begun else None

    def tell(self, name: str, pressed: bool, now: float) -> list[str]:
        """Take a change of a sensor; returns what has been touched as wanted by it."""
        held_enough = self.look(now)
        untold = name in self._untold
        self._untold.discard(name)
        if pressed == (name in self._since) and not (pressed and untold):
            return held_enough
        if pressed:
            self._since.setdefault(name, now)
            return self._pressed(name, now)
        del self._since[name]
        self._held.discard(name)
        return [name] if self._wanted.kind == RELEASE else held_enough

    def look(self, now: float) -> list[str]:
        """What has been held long enough by now, and was not told of before."""
        if self._wanted.kind != HOLD:
            return []
        # Sums of times are not exact: who waits until `due` comes a hair before.
        limit = now - self._wanted.duration + 1e-6
        held = [name for name, since in self._since.items() if since <= limit and name not in self._held]
        self._held.update(held)
        return held

    def _pressed(self, name: str, now: float) -> list[str]:
        if self._wanted.kind == PRESS:
            return [name]
        if self._wanted.kind != COUNT:
            return []
        self._presses.append((now, name))
        while self._presses[0][0] < now - self._wanted.duration - 1e-6:
            self._presses.popleft()
        if len(self._presses) < self._wanted.count:
            return []
        names = list(dict.fromkeys(name for _, name in self._presses))
        self._presses.clear()
        return names
