"""Native threads of this process, such as libqi's: the interpreter must not shut down while they work.

A native thread that takes the GIL while the interpreter is finalised ends the process by `std::terminate`. libqi
deletes objects after an answer and after a session is closed, and gives no signal when it has finished.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time

TASKS = "/proc/self/task"
LOOK_PERIOD = 0.002
"""s between two checks, in which other threads can take the GIL."""
LOOKS = 2
"""Consecutive checks that must find no thread at work: at the first, a thread may wait for the GIL held by it."""


def wait_until_idle(limit: float) -> bool:
    """Wait up to `limit` s until no native thread is running; whether that was reached."""
    end = time.monotonic() + limit
    looks = 0
    while looks < LOOKS:
        if time.monotonic() > end:
            return False
        time.sleep(LOOK_PERIOD)
        looks = 0 if _any_works() else looks + 1
    return True


def _any_works() -> bool:
    # A thread of libqi that has called Python is listed there too, as a dummy.
    own = {each.native_id for each in threading.enumerate() if not isinstance(each, threading._DummyThread)}
    return any(_works(task) for task in os.listdir(TASKS) if int(task) not in own)


def _works(task: str) -> bool:
    with contextlib.suppress(FileNotFoundError, ProcessLookupError), open(f"{TASKS}/{task}/stat") as file:
        return file.read().rpartition(") ")[2].startswith("R")
    return False  # it has ended
