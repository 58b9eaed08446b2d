"""Velocities from uneven samples."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.slope import SlopeEstimator


def test_even_motion_has_its_speed_whatever_the_times():
    slopes = SlopeEstimator()
    for time in (0.0, 0.02, 0.037, 0.061, 0.08, 0.1):
        found = slopes.add(time, [0.5 * time, 1.0 - 2.0 * time])
    assert found == pytest.approx([0.5, -2.0])


def test_readings_of_a_slower_cycle_do_not_upset_it():
    slopes, cycle, period = SlopeEstimator(), 0.012, 0.02
    worst = 0.0
    for i in range(200):
        time = 100.0 + i * period
        (found,) = slopes.add(time, [cycle * (time // cycle)])  # 1 rad/s, seen in steps
        if i >= 5:
            worst = max(worst, abs(found - 1.0))
    assert worst < 0.15  # of two samples each: 0.4


def test_the_first_sample_tells_nothing():
    assert SlopeEstimator().add(3.0, [1.0, 2.0]) == [0.0, 0.0]


@pytest.mark.parametrize("time", [1.0, 20.0])
def test_it_starts_anew_when_time_jumps(time):
    slopes = SlopeEstimator()
    slopes.add(10.0, [0.0])
    slopes.add(10.02, [0.1])
    assert slopes.add(time, [5.0]) == [0.0]


def test_two_samples_of_one_moment_are_one():
    slopes = SlopeEstimator()
    slopes.add(0.0, [0.0])
    slopes.add(0.1, [7.0])
    assert slopes.add(0.1, [1.0]) == pytest.approx([10.0])
