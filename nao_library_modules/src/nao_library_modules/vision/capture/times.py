"""Limit and measurement of frame rates, and the times of frames in a video. Numbers only."""

from __future__ import annotations

from collections import deque

STRANGEST_GAP = 3600.0
"""s; stamps that jump further ahead come from another clock."""
FAR_BACK = 1.0
"""s; stamps that jump further back belong to a clock that was set back, as that of a simulation that starts again."""
SLACK = 0.1
"""Fraction of the period that a frame may be early: stamps are not even."""


class RateLimit:
    """Selects frames so that they are at most so many a second; rate 0: all."""

    def __init__(self, rate: float) -> None:
        self._period = 1.0 / rate if rate > 0.0 else 0.0
        self._due: float | None = None

    def passes(self, stamp: float) -> bool:
        """Whether a frame of a time (s) is passed on."""
        if not self._period:
            return True
        due = self._due
        if due is not None and due - self._period - FAR_BACK <= stamp < due - SLACK * self._period:
            return False
        on_time = due is not None and due - self._period <= stamp <= due + self._period
        self._due = (due if on_time else stamp) + self._period
        return True


class VideoTimes:
    """Times of frames in a video: as the camera stamps them, from 0, and always growing."""

    def __init__(self, step: float) -> None:
        """Begin with the next frame; the step is the resolution of times in the video, s."""
        self._step = step
        self._shift: float | None = None
        self._last = 0.0
        self._period = 0.0

    def place(self, stamp: float) -> float | None:
        """Time in the video of a frame of a time (s); None if it is less than a step after the last one."""
        if self._shift is None:
            self._shift = stamp
            return 0.0
        time = stamp - self._shift
        gap = time - self._last
        if gap < -FAR_BACK or gap > STRANGEST_GAP:
            time = self._last + max(self._period, self._step)
            self._shift = stamp - time
        elif gap < self._step:
            return None
        self._period = time - self._last
        self._last = time
        return time


class RecentRate:
    """The rate of the latest 30 frames."""

    def __init__(self) -> None:
        self._stamps: deque[float] = deque(maxlen=30)

    def count(self, stamp: float) -> None:
        if self._stamps and stamp < self._stamps[-1]:
            self._stamps.clear()  # the clock was set back
        self._stamps.append(stamp)

    @property
    def rate(self) -> float:
        """Frames a second; 0 before the second one."""
        if len(self._stamps) < 2 or self._stamps[-1] <= self._stamps[0]:
            return 0.0
        return (len(self._stamps) - 1) / (self._stamps[-1] - self._stamps[0])
