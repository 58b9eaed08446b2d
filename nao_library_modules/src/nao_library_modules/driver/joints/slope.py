"""How fast values change, from samples whose times are not quite even. Arithmetic only."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

SAMPLES = 5
GAP = 0.5
"""s without a sample after which older ones say nothing about the present."""


class SlopeEstimator:
    """Slopes of straight lines through the last few samples of several values.

    The robot measures in cycles of its own, so of two samples 20 ms apart one may hold one cycle's motion and the next
    three; a line through several of them is not upset by that. The slope is that of the middle of the window.
    """

    def __init__(self) -> None:
        self._samples: deque[tuple[float, Sequence[float]]] = deque(maxlen=SAMPLES)

    def add(self, time: float, values: Sequence[float]) -> list[float]:
        """Take a sample and return the change of each value per s; zeros with less than two samples.

        A `time` (s) that goes back, or far ahead, makes the estimator start anew.
        """
        if self._samples and not 0.0 <= time - self._samples[-1][0] <= GAP:
            self._samples.clear()
        if self._samples and time == self._samples[-1][0]:
            self._samples.pop()
        self._samples.append((time, values))
        count = len(self._samples)
        mean = sum(t for t, _ in self._samples) / count
        offsets = [t - mean for t, _ in self._samples]
        spread = sum(offset * offset for offset in offsets)
        if spread == 0.0:
            return [0.0] * len(values)
        weights = [offset / spread for offset in offsets]
        return [sum(w * v for w, v in zip(weights, column)) for column in zip(*(row for _, row in self._samples))]
