"""How far a sweep is: a bar in a terminal, lines in a file or a log."""

from __future__ import annotations

import math
import sys
import time
from typing import Any, Mapping

from nao_sim_bridge.sweep.table import ERROR, SEED

PERIOD = 30.0
"""s between two lines where there is no terminal."""


def counted(count: int, noun: str) -> str:
    """A number with its noun, in the plural unless it is 1."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


class Progress:
    """Counts runs, and shows them on stderr.

    Attributes:
        workers: How many there are; None: the sweep runs in this process.

    Args:
        done: Runs that the file has already.
        total: All runs.
        shown: False: report messages alone.
    """

    def __init__(self, done: int, total: int, shown: bool) -> None:
        self.workers: int | None = None
        self._before, self._done, self._total, self._failed = done, done, total, 0
        self._bar: Any = None
        self._printed = -1  # runs in the last line
        self._lines = shown and not sys.stderr.isatty()
        if shown and not self._lines:
            from tqdm import tqdm  # only a terminal needs it

            self._bar = tqdm(initial=done, total=total, unit="run")
        self._began = self._line_at = time.monotonic()

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._lines and self._printed != self._done:
            self._print_line()

    def add(self, row: Mapping[str, Any]) -> None:
        """Count a run that has ended."""
        self._done += 1
        if row[ERROR] and not self._failed:
            self.report(f"the first run that failed (seed {row[SEED]}): {row[ERROR]}")
        self._failed += bool(row[ERROR])
        if self._bar is not None:
            self._bar.update()
        self.refresh()

    def refresh(self) -> None:
        """Print a line if the last one is old; to be called while nothing ends, too."""
        if self._lines and time.monotonic() >= self._line_at + PERIOD:
            self._print_line()

    def report(self, message: str) -> None:
        """Print a message, whatever is shown of the progress."""
        line = f"sweep: {message}"
        if self._bar is not None:
            self._bar.write(line, file=sys.stderr)
        else:
            print(line, file=sys.stderr, flush=True)

    def _print_line(self) -> None:
        self._line_at, self._printed = time.monotonic(), self._done
        parts = [f"{self._done} of {self._total} runs"]
        if self._failed:
            parts.append(f"{self._failed} failed")
        made, left = self._done - self._before, self._total - self._done
        if left and self.workers is not None:
            parts.append(counted(self.workers, "worker"))
        if left and made:
            seconds = (self._line_at - self._began) / made * left
            parts.append(f"about {math.ceil(seconds / 60.0)} min left")
        self.report(", ".join(parts))
