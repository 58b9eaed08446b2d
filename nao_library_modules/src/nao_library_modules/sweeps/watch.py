"""Watches the true pose of the torso during a run, and pushes it when the moment has come."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass

from nao_sim_bridge.base.readings import FALLEN, Pose


@dataclass(frozen=True)
class Push:
    """A push on the torso.

    Attributes:
        momentum: N s.
        heading: Where to, rad in world from the x axis to the left.
        moment: s of simulated time after the begin of what runs.
    """

    DURATION = 0.1

    momentum: float
    heading: float
    moment: float

    @property
    def force(self) -> tuple[float, float, float]:
        """N in world, for `DURATION` s."""
        size = self.momentum / self.DURATION
        return size * math.cos(self.heading), size * math.sin(self.heading), 0.0


class TorsoWatch:
    """One run, told the poses of the torso as they come, from any thread; the lock guards what is noted.

    Attributes:
        lean: The most the torso has leant, rad.
        pushed_at: s after the begin of what runs; None: not pushed.

    Args:
        after: Poses count from this simulated time on, s.
        push: What is to come, None for nothing.
        do_push: Carries it out.
    """

    def __init__(self, after: float, push: Push | None, do_push: Callable[[Push], None]) -> None:
        self.lean = 0.0
        self.pushed_at: float | None = None
        self._after = self._began = self._now = after
        self._push, self._do_push = push, do_push
        self._running = False
        self._first: tuple[float, float] | None = None
        self._last = (0.0, 0.0)
        self._lock = threading.Lock()

    @property
    def fell(self) -> bool:
        return self.lean > FALLEN

    @property
    def moved(self) -> float:
        """Distance on the floor between the first and the last place, m."""
        return math.dist(self._first or self._last, self._last)

    def begin(self, now: float) -> None:
        """What runs begins, at a simulated time in s; only the first call counts."""
        with self._lock:
            if not self._running:
                self._running, self._began = True, now

    def look(self, time: float, torso: Pose) -> None:
        """The true pose of the torso at a simulated time, s; pushes when the moment has come."""
        if time <= self._after:
            return  # of the run before
        with self._lock:
            self._now = time
            self.lean = max(self.lean, torso.lean)
            self._last = torso.position[:2]
            self._first = self._first or self._last
            due = self._running and self._push is not None and time >= self._began + self._push.moment
            push = self._take() if due else None
        if push is not None:
            self._do_push(push)

    def end(self) -> None:
        """What runs is over: a push whose moment has not come, for this run was shorter, comes now."""
        with self._lock:
            push = self._take()
        if push is not None:
            self._do_push(push)

    def _take(self) -> Push | None:
        """The push, once; the lock is held."""
        push, self._push = self._push, None
        if push is not None:
            self.pushed_at = max(0.0, self._now - self._began)
        return push
