"""How far the last stop of a robot is."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable

from .runs import Run

STOPPING, STOPPED = "stopping", "stopped"
"""What was going on has not ended yet; all of it has, and nothing has begun since."""


class LastStop:
    """What the last stop has to end: the goals that ran, and steps of its own. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._goals: set[Run] = set()
        self._steps: set[object] = set()
        self._past = True  # whether there was none, or something has begun since

    def begin(self, runs: Iterable[Run], *steps: Callable[[], None]) -> list[Callable[[], None]]:
        """A stop begins. Returns its steps, to be called by threads of their own."""
        keys = [object() for _ in steps]
        with self._lock:
            self._goals, self._steps, self._past = set(runs), set(keys), False
        return [self._counted(key, step) for key, step in zip(keys, steps)]

    def has_begun(self) -> None:
        """Something has begun that is no goal."""
        with self._lock:
            self._past = True

    def state(self, runs: Iterable[Run]) -> str:
        """STOPPING, STOPPED, or empty: nothing was stopped, or something has begun since. `runs`: that go on now."""
        with self._lock:
            going = set(runs)
            self._past = self._past or bool(going - self._goals)
            if self._steps or going & self._goals:
                return STOPPING
            return "" if self._past else STOPPED

    def _counted(self, key: object, step: Callable[[], None]) -> Callable[[], None]:
        def carry_out() -> None:
            try:
                step()
            finally:
                with self._lock:
                    self._steps.discard(key)

        return carry_out
