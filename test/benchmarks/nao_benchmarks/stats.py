"""Measuring alternatives side by side. Machines are noisy: what counts are ratios of medians."""

from __future__ import annotations

import time
from dataclasses import dataclass
from statistics import median, quantiles
from typing import Callable, Sequence


@dataclass(frozen=True)
class Sample:
    """How long the runs of one alternative took.

    Attributes:
        seconds: Each run, in s, in the order of the runs.
    """

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """Middle of the runs, s."""
        return median(self.seconds)

    @property
    def quartiles(self) -> tuple[float, float]:
        """A quarter of the runs is below the first, a quarter above the second, s."""
        if len(self.seconds) < 2:
            return self.seconds[0], self.seconds[0]
        first, _, third = quantiles(self.seconds, n=4, method="inclusive")
        return first, third

    def share_above(self, limit: float) -> float:
        """Share 0..1 of the runs that took longer than `limit` (s)."""
        return sum(each > limit for each in self.seconds) / len(self.seconds)


def interleave(
    alternatives: Sequence[Callable[[], object]],
    rounds: int,
    warm_up: int = 0,
    clock: Callable[[], float] = time.perf_counter,
) -> list[Sample]:
    """Run alternatives in turns, so that whatever disturbs the machine meets all of them alike.

    Every second round goes backwards: the one that follows another must not always be the same.

    Args:
        alternatives: What to run.
        rounds: How often each runs, at least once.
        warm_up: Rounds before those, which are not measured.
        clock: Time in s.

    Returns:
        A sample for each alternative, in their order.

    Raises:
        ValueError: If `rounds` is less than 1 or `warm_up` less than 0.
    """
    if rounds < 1 or warm_up < 0:
        raise ValueError(f"rounds is {rounds}, warm_up {warm_up}: at least 1 and 0")
    seconds: list[list[float]] = [[] for _ in alternatives]
    pairs = list(zip(alternatives, seconds))
    for turn in range(-warm_up, rounds):
        for run, taken in pairs if turn % 2 == 0 else reversed(pairs):
            began = clock()
            run()
            ended = clock()
            if turn >= 0:
                taken.append(ended - began)
    return [Sample(tuple(taken)) for taken in seconds]
