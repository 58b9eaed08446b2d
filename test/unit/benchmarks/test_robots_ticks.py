"""The program that times several robots must time robots that all stand, or all walk."""

from __future__ import annotations

import pytest
from nao_benchmarks.errors import BenchmarkError


@pytest.fixture
def program(program, monkeypatch):
    monkeypatch.setattr(program, "SETTLE_S", 0.1)
    monkeypatch.setattr(program, "START_S", 0.2)
    return program


@pytest.mark.parametrize("walking", [False, True])
def test_both_worlds_are_timed_equally_often(program, walking):
    times = program.time_ticks(2, walking)
    assert len(times["ours"]) == len(times["reference"]) == 2
    assert min(times["ours"] + times["reference"]) > 0.0


def test_robots_that_do_not_walk_are_no_measurement(program, monkeypatch):
    monkeypatch.setattr(program, "walk", lambda robots: None)
    with pytest.raises(BenchmarkError, match="robot 1 of 3 does not walk"):
        program.time_ticks(2, True)
