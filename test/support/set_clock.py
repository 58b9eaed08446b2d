"""A clock for tests."""

from __future__ import annotations

import threading


class SetClock:
    """Time that passes when the test says so."""

    def __init__(self):
        self.time = 0.0
        self.waits = threading.Semaphore(0)
        self._wakers = []

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        end, wake = self.time + duration, threading.Event()
        self._wakers.append(wake)
        self.waits.release()
        with interrupt.waking(wake.set):
            while self.time < end and not interrupt.is_set():
                assert wake.wait(10.0), "nobody let time pass"
                wake.clear()
        return not interrupt.is_set()

    def advance(self, seconds):
        self.time += seconds
        for wake in list(self._wakers):
            wake.set()
