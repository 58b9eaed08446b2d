"""Waits that end as soon as they can."""

from __future__ import annotations

import os
import signal
import threading
import time

import pytest

PATIENCE = 120.0
"""Longest wait for something that must happen, in s; passing tests do not come near it."""


@pytest.fixture
def eventually():
    """Asks again and again until a condition holds, for what other threads and processes bring about unannounced."""

    def wait(condition, what="it"):
        end = time.monotonic() + PATIENCE
        pause = threading.Event()
        while not condition():
            assert time.monotonic() < end, f"did not come about: {what}"
            pause.wait(0.005)

    return wait


def hold(pid):
    """Stop a child of this process; it goes on by SIGCONT. The signal alone comes before the child has stopped."""
    os.kill(pid, signal.SIGSTOP)
    os.waitid(os.P_PID, pid, os.WSTOPPED)
