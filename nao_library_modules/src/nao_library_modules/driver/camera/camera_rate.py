"""Rate of pictures. No ROS."""

from __future__ import annotations

import threading
from collections import deque

WINDOW = 3.0
"""s that the rate is measured over."""
GAP = 1.5
"""Periods between two pictures from which on some are missing."""


class PictureRate:
    """Counts pictures (`count`), and missed ones between them (`missed`). Any thread may ask."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._times: deque[float] = deque()
        self.count = 0
        self.missed = 0

    def restart(self) -> None:
        """Begin another stream: the time until its first picture is no gap."""
        with self._lock:
            self._times.clear()

    def note(self, time: float, period: float) -> None:
        """Count a picture taken at `time`, s; `period`, s, should be between two of them."""
        with self._lock:
            if self._times and time < self._times[-1]:
                self._times.clear()
            since = time - self._times[-1] if self._times else 0.0
            if since > GAP * period:
                self.missed += round(since / period) - 1
            self.count += 1
            self._times.append(time)
            while self._times[-1] - self._times[0] > WINDOW and len(self._times) > 2:
                self._times.popleft()

    @property
    def rate(self) -> float | None:
        """Pictures a second; None until a second has been seen."""
        with self._lock:
            span = self._times[-1] - self._times[0] if self._times else 0.0
            return (len(self._times) - 1) / span if span >= 1.0 else None
