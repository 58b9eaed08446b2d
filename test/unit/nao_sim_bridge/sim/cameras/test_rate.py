"""When frames fall due."""

from __future__ import annotations

from fractions import Fraction

import pytest

from nao_sim_bridge.sim.cameras.rate import Share, Shutter, exact_rate

TICKS = Fraction(120)


def ticks_of(shutter, count):
    """The ticks of the next frames."""
    found = []
    for _ in range(count):
        found.append(shutter.next_tick)
        shutter.advance(shutter.next_tick)
    return found


@pytest.mark.parametrize("rate, meant", [(30, Fraction(30)), (0.1, Fraction(1, 10)), (1000 / 300, Fraction(10, 3))])
def test_what_was_meant_by_a_rate(rate, meant):
    assert exact_rate(rate) == meant


@pytest.mark.parametrize("rate", [1, 5, 7, 15, 24, 25, 29, 30])
def test_rates_do_not_drift(rate):
    shutter = Shutter(TICKS)
    shutter.set_rate(Fraction(rate), 0)
    ticks = ticks_of(shutter, 100 * rate + 1)
    for index, tick in enumerate(ticks):
        assert abs(tick - 1 - Fraction(index * 120, rate)) <= Fraction(1, 2)
    assert ticks[-1] == 1 + 100 * 120


def test_a_camera_that_begins_to_run_has_its_first_frame_at_the_next_tick():
    shutter = Shutter(TICKS)
    assert shutter.next_tick == Shutter.NEVER
    shutter.set_rate(Fraction(1, 10), 500)
    assert ticks_of(shutter, 2) == [501, 501 + 1200]
    shutter.set_rate(Fraction(0), 600)
    assert shutter.next_tick == Shutter.NEVER


def test_a_faster_rate_goes_on_from_the_last_frame():
    shutter = Shutter(TICKS)
    shutter.set_rate(Fraction(5), 0)
    assert ticks_of(shutter, 2) == [1, 25]
    shutter.set_rate(Fraction(30), 31)
    assert ticks_of(shutter, 3) == [33, 37, 41]
    shutter.set_rate(Fraction(5), 42)
    assert ticks_of(shutter, 2) == [65, 89]


def test_ticks_that_nobody_looked_at_are_left_out():
    shutter = Shutter(TICKS)
    shutter.set_rate(Fraction(30), 0)
    shutter.advance(50)
    assert shutter.next_tick == 53


def test_a_stream_gets_its_share_of_the_frames():
    fast, slow, odd = (Share(Fraction(rate), TICKS) for rate in (30, 5, 20))
    times = [Fraction(7 + 4 * index) for index in range(30)]
    assert all(fast.takes(time) for time in times)
    assert [time for time in times if slow.takes(time)] == [7, 31, 55, 79, 103]
    assert [time for time in times if odd.takes(time)][:5] == [7, 15, 19, 27, 31]
