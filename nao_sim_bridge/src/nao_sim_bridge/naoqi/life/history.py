"""What a life has been: states, activities, and how long. Any thread may read."""

from __future__ import annotations

from collections import deque
from typing import Callable

from nao_sim_bridge.base.sizes import load_sizes

# Entries that are remembered.
LENGTH = 500
FOCUS_COUNT, COMPLETION_COUNT = "focusCount", "completionCount"
START, COMPLETION, DURATION, TOTAL = (
    "prevFocusStartTime",
    "prevCompletionTime",
    "prevFocusDuration",
    "totalFocusDuration",
)


class LifeRecord:
    """Part of ALAutonomousLife: histories and statistics; times in whole s of simulated time."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._states: deque[tuple[str, int]] = deque([("disabled", int(clock()))], maxlen=LENGTH)
        self._focus: deque[tuple[str, int]] = deque(maxlen=LENGTH)
        self._statistics: dict[str, dict[str, int]] = {}
        self._lived = 0.0
        self._since: float | None = None

    def getLifeTime(self) -> int:
        return int(self._lived + (0.0 if self._since is None else self._clock() - self._since))

    def getActivityStatistics(self) -> dict[str, dict[str, int]]:
        """Counts and times by activity."""
        return {name: dict(entry) for name, entry in self._statistics.items()}

    def getStateHistory(self, depth: int | None = None) -> list[tuple[str, int]]:
        """The last states and when they began, newest first."""
        return _newest(self._states, depth)

    def getFocusHistory(self, depth: int | None = None) -> list[tuple[str, int]]:
        """The last activities and when they got the focus, newest first."""
        return _newest(self._focus, depth)

    def entered(self, state: str, alive: bool) -> None:
        now = self._clock()
        self._states.append((state, int(now)))
        if alive and self._since is None:
            self._since = now
        elif not alive and self._since is not None:
            self._lived, self._since = self._lived + now - self._since, None

    def focused(self, activity: str) -> None:
        now = int(self._clock())
        self._focus.append((activity, now))
        if activity not in self._statistics and len(self._statistics) >= load_sizes().clients.activities:
            del self._statistics[next(iter(self._statistics))]
        entry = self._statistics.setdefault(activity, dict.fromkeys((FOCUS_COUNT, COMPLETION_COUNT, TOTAL), 0))
        entry[FOCUS_COUNT] += 1
        entry[START] = now

    def left(self, activity: str, completed: bool) -> None:
        now, entry = int(self._clock()), self._statistics[activity]  # it has the focus: nothing is forgotten meanwhile
        entry[DURATION] = now - entry[START]
        entry[TOTAL] += entry[DURATION]
        if completed:
            entry[COMPLETION_COUNT] += 1
            entry[COMPLETION] = now


def _newest(entries: deque[tuple[str, int]], depth: int | None) -> list[tuple[str, int]]:
    listed = list(entries)[::-1]
    return listed if depth is None else listed[: max(depth, 0)]
