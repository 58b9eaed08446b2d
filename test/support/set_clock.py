"""Clocks for tests."""

from __future__ import annotations

import threading
from collections import Counter

LIMIT = 60.0


class CalledClock:
    """Tells the time that the test has set, to who calls it."""

    def __init__(self, now):
        self.now = now

    def __call__(self):
        return self.now


class SetClock:
    """Time that passes when the test says so."""

    def __init__(self):
        self.time = 0.0
        self._changed = threading.Condition()
        self._waits = []

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        end, wake = self.time + duration, threading.Event()
        with self._changed:
            self._waits.append((end, wake))
            self._changed.notify_all()
        try:
            with interrupt.waking(wake.set):
                while self.time < end and not interrupt.is_set():
                    assert wake.wait(LIMIT), "nobody let time pass"
                    wake.clear()
        finally:
            with self._changed:
                self._waits.remove((end, wake))
        return not interrupt.is_set()

    def somebody_waits(self, *ends):
        """Wait until there is one who waits for each of these times; a time that stands here twice has two."""

        def all_of_them():
            there = Counter(round(end, 6) for end, _ in self._waits)
            return Counter(round(end, 6) for end in ends) <= there

        with self._changed:
            assert self._changed.wait_for(all_of_them, LIMIT), f"nobody waits for {ends}: {self._waits}"

    def advance(self, seconds):
        self.time += seconds
        with self._changed:
            for _, wake in self._waits:
                wake.set()
