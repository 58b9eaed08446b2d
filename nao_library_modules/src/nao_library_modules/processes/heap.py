"""Memory that long messages leave behind, given back to the system."""

from __future__ import annotations

import ctypes
import time
from typing import Callable

PERIOD = 5.0
"""s between two returns: one takes some ms where there are many holes."""


def trim_of_libc() -> Callable[[], object]:
    """What returns free memory of C's heap: glibc keeps what is below the last block in use, others do not."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    return (lambda: trim(0)) if trim else lambda: None


class Heap:
    """Returns free memory now and then, by `trim`. For one thread. The clock is wall time, s."""

    def __init__(self, trim: Callable[[], object] | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        self._trim = trim or trim_of_libc()
        self._clock = clock
        self._due = clock()

    def tidy(self) -> None:
        now = self._clock()
        if now >= self._due:
            self._due = now + PERIOD
            self._trim()
