"""Threads of this process that Python does not know, as those of libqi: a program must not end under them.

One that wants to take Python's lock while the interpreter is being taken down ends the process by `std::terminate`.
After an answer, and when a session has been closed, libqi still puts objects away; nothing tells when it has.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time

TASKS = "/proc/self/task"
LOOK_PERIOD = 0.002
"""s between two looks, in which others can have Python's lock."""
LOOKS = 2
"""So many in a row must find nobody at work: at the first one a thread may wait for the lock that the look holds."""


def wait_until_idle(limit: float) -> bool:
    """Wait until no thread that is not Python's does anything.

    Args:
        limit: Longest wait, in s.

    Returns:
        Whether that has come true.
    """
    end = time.monotonic() + limit
    looks = 0
    while looks < LOOKS:
        if time.monotonic() > end:
            return False
        time.sleep(LOOK_PERIOD)
        looks = 0 if _any_works() else looks + 1
    return True


def _any_works() -> bool:
    # One of libqi's that has called Python is in Python's list as well, as a dummy.
    own = {each.native_id for each in threading.enumerate() if not isinstance(each, threading._DummyThread)}
    return any(_works(task) for task in os.listdir(TASKS) if int(task) not in own)


def _works(task: str) -> bool:
    with contextlib.suppress(FileNotFoundError, ProcessLookupError), open(f"{TASKS}/{task}/stat") as file:
        return file.read().rpartition(") ")[2].startswith("R")
    return False  # it has ended
