"""Memory of processes over the soak, and whether it is flat."""

from __future__ import annotations

from collections.abc import Mapping
from statistics import median

ALLOWED_GROWTH = 0.05
ALLOWED_MB = 2.0
"""MB that any process may grow: a twentieth of a small one is less than an allocator's page or two."""
SETTLED = 0.4
"""Share of the time after which programs have imported, cached and connected what they need."""


class MemoryRecord:
    """Samples of the memory of processes, taken at equal times."""

    def __init__(self) -> None:
        self._samples: list[Mapping[str, float]] = []

    def add(self, held: Mapping[str, float]) -> None:
        """Add a sample: MB by name."""
        self._samples.append(held)

    def course(self) -> dict[str, list[float | None]]:
        """MB of each process at each sample, to a tenth; None where it was not there."""
        names = sorted(set().union(*self._samples))
        return {n: [round(sample[n], 1) if n in sample else None for sample in self._samples] for n in names}

    def growth(self) -> dict[str, tuple[float, float]]:
        """Of each process that was there all the time: MB when it had settled, and at the end."""
        if len(self._samples) < 10:
            return {}
        settled = self._samples[int(len(self._samples) * SETTLED) :]
        fifth = max(1, len(settled) // 5)
        names = set.intersection(*(set(sample) for sample in settled))
        before = {name: median(sample[name] for sample in settled[:fifth]) for name in sorted(names)}
        return {name: (mb, median(sample[name] for sample in settled[-fifth:])) for name, mb in before.items()}

    def swollen(self) -> dict[str, tuple[float, float]]:
        """Those that grew more than they may."""
        return {
            name: (before, after)
            for name, (before, after) in self.growth().items()
            if after - before > max(ALLOWED_MB, ALLOWED_GROWTH * before)
        }
