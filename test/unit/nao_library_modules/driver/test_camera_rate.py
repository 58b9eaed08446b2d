"""Rates of pictures, and how many are missing."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.camera_rate import RateMeter


def test_the_rate_is_that_of_the_last_seconds():
    meter = RateMeter()
    for number in range(100):
        meter.note(number / 30.0, 1 / 30.0)
    for number in range(1, 61):
        meter.note(99 / 30.0 + number / 15.0, 1 / 15.0)
    assert meter.rate == pytest.approx(15.0, abs=0.01)
    assert (meter.count, meter.missed) == (160, 0)


def test_there_is_no_rate_before_a_second():
    meter = RateMeter()
    assert meter.rate is None
    meter.note(5.0, 0.1)
    meter.note(5.9, 0.1)
    assert meter.rate is None


def test_gaps_are_missing_pictures_but_not_before_the_first():
    meter = RateMeter()
    for time in (0.0, 0.1, 0.4, 0.5):
        meter.note(time, 0.1)
    meter.restart()
    meter.note(9.0, 0.1)
    assert meter.missed == 2


def test_a_clock_that_was_set_back_is_no_gap():
    meter = RateMeter()
    for time in (50.0, 50.1, 1.0, 1.1):
        meter.note(time, 0.1)
    assert (meter.missed, meter.count) == (0, 4)
