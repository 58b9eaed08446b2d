"""Memory that long messages leave behind."""

from __future__ import annotations

import ctypes
from pathlib import Path

import pytest

from nao_library_modules.heap import PERIOD, Heap, trim_of_libc


class Wall:
    time = 100.0

    def __call__(self):
        return self.time


def test_memory_is_returned_at_once_and_then_now_and_then():
    clock, done = Wall(), []
    heap = Heap(lambda: done.append(clock.time), clock)
    for clock.time in (100.0, 101.0, 100.0 + PERIOD - 0.1, 100.0 + PERIOD, 101.0 + PERIOD):
        heap.tidy()
    assert done == [100.0, 100.0 + PERIOD]


def resident_mb():
    (line,) = [text for text in Path("/proc/self/status").read_text().splitlines() if text.startswith("VmRSS")]
    return int(line.split()[1]) / 1024.0


def test_the_system_gets_back_what_lies_below_what_is_kept():
    if not hasattr(ctypes.CDLL(None), "malloc_trim"):
        pytest.skip("this C library gives free memory back by itself")
    trim = trim_of_libc()
    blocks = [bytearray(60_000) for _ in range(1000)]
    kept = blocks.pop()
    del blocks
    before = resident_mb()
    trim()
    assert before - resident_mb() > 40.0
    assert len(kept) == 60_000


def test_a_library_without_a_trim_is_left_alone(monkeypatch):
    monkeypatch.setattr("ctypes.CDLL", lambda _: object())
    Heap().tidy()
