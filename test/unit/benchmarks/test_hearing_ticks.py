"""The program that times hearing must time a robot that is heard, next to one in silence."""

from __future__ import annotations

import pytest
from nao_benchmarks.errors import BenchmarkError


def test_both_robots_are_timed_equally_often(program):
    times = program.time_stretches(2)
    assert len(times["ours"]) == len(times["reference"]) == 2
    assert min(times["ours"] + times["reference"]) > 0.0


def test_a_robot_that_is_silent_is_no_measurement(program, monkeypatch):
    sound = program.Sound
    monkeypatch.setattr(program, "Sound", lambda samples: sound(0.0 * samples))
    with pytest.raises(BenchmarkError, match=r"ears heard 0 blocks with sound, of \d+"):
        program.time_stretches(2)
