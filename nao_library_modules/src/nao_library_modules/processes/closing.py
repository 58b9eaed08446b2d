"""The end of a program: every step is made, even if others fail, and it is over in time. No ROS."""

from __future__ import annotations

import logging
import os
import sys
import threading
import time
from typing import Callable

log = logging.getLogger(__name__)

CLOSE_LIMIT = 4.0
"""s that all steps together may take."""
EXIT_LIMIT = 5.0
"""s after which the process ends in any case."""

Step = Callable[[], object]


def close_all(*steps: Step, limit: float = CLOSE_LIMIT) -> None:
    """Make steps one after the other; one that raises is logged, one that hangs is left to itself.

    All may take `limit` s together; each may take half of the time that is left, then the next begins.
    """
    deadline = time.monotonic() + limit
    begun = [_begin(step, deadline) for step in steps]
    for step, thread in zip(steps, begun):
        thread.join(max(0.0, deadline - time.monotonic()))
        if thread.is_alive():
            log.error("%s has not ended within %g s and is left", _name(step), limit)


def _begin(step: Step, deadline: float) -> threading.Thread:
    thread = threading.Thread(target=_guarded, args=(step,), name=_name(step), daemon=True)
    thread.start()
    thread.join(max(0.0, deadline - time.monotonic()) / 2.0)
    return thread


def _guarded(step: Step) -> None:
    try:
        step()
    except Exception:
        log.exception("%s failed, at the end of the program", _name(step))


def _name(step: Step) -> str:
    return getattr(step, "__qualname__", repr(step))


def exit_in_time(limit: float = EXIT_LIMIT) -> threading.Timer:
    """End the process after `limit` s, even if threads still wait. Returns the timer, which can be cancelled."""

    def end() -> None:
        print(f"the end took longer than {limit:g} s: something hangs, and is cut off", file=sys.stderr, flush=True)
        os._exit(1)

    timer = threading.Timer(limit, end)
    timer.name, timer.daemon = "limit of the end", True
    timer.start()
    return timer
