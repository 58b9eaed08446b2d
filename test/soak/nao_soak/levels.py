"""What a program holds over time (memory, threads, descriptors, its log), and whether that is level."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from statistics import median

MEMORY, THREADS, DESCRIPTORS, LOG = "memory MB", "threads", "descriptors", "log kB"
ALLOWED = 0.03
"""Share that anything may grow."""
LEAST = {MEMORY: 2.0, THREADS: 2.0, DESCRIPTORS: 2.0, LOG: 0.0}
"""What it may grow in any case: what a client has that comes or goes at the moment is more than the share."""
LOG_RATE = 0.2
"""kB that a log may grow each second, where nothing else is said: it tells of each client that is killed."""
SETTLED = 0.1
"""Share of the time after which everything is to be level."""


class Levels:
    """Samples of what processes hold, taken at equal times.

    Args:
        period: From one to the next, s.
        log_rates: Name -> kB that its log may grow each second.
    """

    def __init__(self, period: float, log_rates: Mapping[str, float] | None = None) -> None:
        self.period = period
        self._log_rates = log_rates or {}
        self._samples: dict[str, list[dict[str, float]]] = {}

    def add(self, name: str, pid: int | None = None, log: Path | None = None) -> None:
        """Add a sample of a process and its log, or of a log or a folder of logs; none of a process that is gone."""
        try:
            self._samples.setdefault(name, []).append(held(pid, log))
        except OSError:
            return

    def growth(self) -> dict[str, tuple[float, float]]:
        """Of each process and thing: how much when it had settled, and at the end; medians."""
        found = {}
        for name, samples in self._samples.items():
            settled = samples[int(len(samples) * SETTLED) :]
            share = max(1, len(settled) // 5)
            if len(settled) >= 10:
                for thing in settled[0]:
                    ends = settled[:share], settled[-share:]
                    found[f"{name}: {thing}"] = tuple(median(s[thing] for s in end) for end in ends)
        return found

    def swollen(self) -> list[str]:
        """What grew more than it may."""
        told = []
        for name, (before, after) in self.growth().items():
            of, _, thing = name.rpartition(": ")
            allowed = max(LEAST[thing], ALLOWED * before)
            if thing == LOG:
                allowed = self._log_rates.get(of, LOG_RATE) * self.period * len(self._samples[of])
            if after - before > allowed:
                told.append(f"{name} grew from {before:.1f} to {after:.1f}, allowed is {allowed:.1f} more")
        return told

    def course(self, thing: str) -> dict[str, list[float]]:
        """How much there was of a thing at each sample, to a tenth, by name."""
        return {
            n: [round(each[thing], 1) for each in samples]
            for n, samples in self._samples.items()
            if thing in samples[0]
        }

    def table(self) -> str:
        """All figures, a line each."""
        return "\n".join(f"{n:44} {before:9.1f} -> {after:9.1f}" for n, (before, after) in self.growth().items())


def held(pid: int | None, log: Path | None = None) -> dict[str, float]:
    """What a process holds now, and the size of its log, a file or a folder.

    Raises:
        OSError: There is no such process.
    """
    figures = {} if pid is None else _held_by(pid)
    if log is not None:
        files = [path for path in log.rglob("*") if path.is_file()] if log.is_dir() else [log]
        figures[LOG] = sum(path.stat().st_size for path in files) / 1024.0
    return figures


def _held_by(pid: int) -> dict[str, float]:
    status = dict(line.split(":", 1) for line in Path(f"/proc/{pid}/status").read_text("ascii", "replace").splitlines())
    return {
        MEMORY: int(status["VmRSS"].split()[0]) / 1024.0,
        THREADS: float(status["Threads"]),
        DESCRIPTORS: float(len(os.listdir(f"/proc/{pid}/fd"))),
    }
