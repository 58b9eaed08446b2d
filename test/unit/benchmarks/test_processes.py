"""What rows read of processes in /proc, checked with the process that runs the tests."""

from __future__ import annotations

import mmap
import os
import resource
import time

import pytest
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.rows.memory import resident_kib
from nao_benchmarks.rows.real_time_factor import processor_time


def test_processor_time_is_what_the_system_charged_the_process():
    # The file counts in ticks of 10 ms.
    before = processor_time(os.getpid())
    deadline = time.process_time() + 0.2
    while time.process_time() < deadline:
        pass
    assert processor_time(os.getpid()) - before == pytest.approx(0.2, abs=0.05)


def test_processor_time_is_read_whatever_the_process_is_called(tmp_path, monkeypatch):
    stat = "42 (odd) name)) " + " ".join(["S", *["0"] * 10, "300", "200", *["0"] * 20])
    monkeypatch.setattr("pathlib.Path.read_text", lambda self, **_: stat)
    assert processor_time(42) == 500 / os.sysconf("SC_CLK_TCK")


def test_memory_grows_with_what_is_written():
    # Pages of its own: memory that the process had before and freed would be taken again without growing.
    mebibyte = 1024 * 1024
    with mmap.mmap(-1, 32 * mebibyte) as block:
        before = resident_kib(os.getpid(), "VmRSS")
        for start in range(0, len(block), mebibyte):
            block[start : start + mebibyte] = b"x" * mebibyte
        assert resident_kib(os.getpid(), "VmRSS") - before > 30 * 1024


def test_the_most_memory_so_far_is_that_of_the_system():
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # KiB on Linux
    assert resident_kib(os.getpid(), "VmHWM") == pytest.approx(most, rel=0.05)


def test_a_field_that_is_not_there_is_an_error():
    with pytest.raises(BenchmarkError, match="VmNothing of process"):
        resident_kib(os.getpid(), "VmNothing")
