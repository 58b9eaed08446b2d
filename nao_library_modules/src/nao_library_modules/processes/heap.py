"""Memory that long messages leave behind, given back to the system."""

from __future__ import annotations

import ctypes
import time

PERIOD = 5.0
"""s between two returns: one takes some ms where there are many holes."""


class Heap:
    """Returns free memory of C's heap now and then. For one thread.

    glibc keeps what is below the last block in use; others do not, and have no `malloc_trim`.
    """

    def __init__(self) -> None:
        self._trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        self._due = time.monotonic()

    def tidy(self) -> None:
        now = time.monotonic()
        if self._trim is not None and now >= self._due:
            self._due = now + PERIOD
            self._trim(0)
