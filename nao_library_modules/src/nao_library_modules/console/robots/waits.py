"""Waits for what nothing tells of."""

from __future__ import annotations

import time
from collections.abc import Callable

LOOK_PERIOD = 0.01
"""s of this computer between two looks."""


def within(limit: float, condition: Callable[[], bool]) -> bool:
    """Look now and then whether something has come to hold; whether it has, `limit` s of this computer at most."""
    deadline = time.monotonic() + limit
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(LOOK_PERIOD)
    return True
