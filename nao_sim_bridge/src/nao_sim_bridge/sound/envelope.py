"""Values that change along the timeline in straight lines: volumes, and places of sources."""

from __future__ import annotations

from typing import Sequence, Tuple

import numpy as np

Value = Tuple[float, ...]
Knot = Tuple[int, Value]

PART = 64
"""Knots that are kept together; only the newest part is ever changed."""
BEGINNING = -(2**62)


class Envelope:
    """Numbers that stay as they are until somebody sets them, and then go to the new ones in a straight line.

    Written in the simulation thread, and only for frames that are still to come; read in any thread. A change takes
    `ramp` frames unless it is told.
    """

    def __init__(self, value: Sequence[float], ramp: int) -> None:
        self._ramp = ramp
        # Tuples of tuples, replaced as a whole: a reader in another thread has the old ones or the new ones. A part
        # begins with the knot that the one before ends with.
        self._parts: tuple[tuple[Knot, ...], ...] = (((BEGINNING, tuple(map(float, value))),),)

    @property
    def target(self) -> Value:
        """What it is or is going to."""
        return self._parts[-1][-1][1]

    def set(self, now: int, value: Sequence[float], ramp: int | None = None) -> None:
        """Go to `value` from frame `now` on; what was planned for later is dropped."""
        value = tuple(map(float, value))
        if value != self.target:
            self._plan(now, [(now + (self._ramp if ramp is None else ramp), value)])

    def at(self, frame: int) -> Value:
        """The value at one frame."""
        return tuple(float(v[0]) for v in self.over(np.array([frame])))

    def over(self, frames: np.ndarray) -> list[np.ndarray]:
        """For each number: its values at `frames` ((n,), not empty), float64."""
        return _interpolated(self._around(int(frames.min()), int(frames.max())), frames)

    def between(self, first: int, last: int) -> list[np.ndarray] | Value:
        """Values for the frames `first` to `last` (without it): numbers when they are the same for all of them."""
        knots = self._around(first, last)
        begun = sum(1 for knot in knots if knot[0] <= first)
        ahead = sum(1 for knot in knots if knot[0] < last)
        needed = knots[max(0, begun - 1) : ahead + 1]
        if all(knot[1] == needed[0][1] for knot in needed):
            return needed[0][1]
        return _interpolated(knots, np.arange(first, last))

    def forget(self, before: int) -> None:
        """Drop what is not needed for frames from `before` on."""
        parts = self._parts
        kept = next(n for n in reversed(range(len(parts))) if n == 0 or parts[n][0][0] <= before)
        if kept:
            self._parts = parts[kept:]

    def _plan(self, now: int, knots: list[Knot]) -> None:
        *old, newest = self._parts
        kept = tuple(knot for knot in newest if knot[0] < now)
        here = (now, self.at(now))
        if len(kept) >= PART:
            self._parts = (*old, (*kept, here), (here, *knots))
        else:
            self._parts = (*old, (*kept, here, *knots))

    def _around(self, first: int, last: int) -> Sequence[Knot]:
        parts = self._parts
        low = len(parts) - 1
        while low > 0 and parts[low][0][0] > first:
            low -= 1
        high = low + 1
        while high < len(parts) and parts[high][0][0] < last:
            high += 1
        return parts[low] if high == low + 1 else [knot for part in parts[low:high] for knot in part]


def _interpolated(knots: Sequence[Knot], frames: np.ndarray) -> list[np.ndarray]:
    at = [knot[0] for knot in knots]
    return [np.interp(frames, at, [knot[1][k] for knot in knots]) for k in range(len(knots[0][1]))]
