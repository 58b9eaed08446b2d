"""A cycle that keeps its period, on a clock that the test turns."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.pacer import Pacer
from nao_library_modules.interrupt import Interrupt


class TurnedClock:
    """Time that passes by waiting only, and by the test."""

    def __init__(self):
        self.time = 100.0

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.time += duration
        return not interrupt.is_set()


@pytest.fixture
def clock():
    return TurnedClock()


def test_work_and_delays_do_not_add_up(clock):
    pacer = Pacer(clock, 0.02, 0.0, Interrupt())
    moments = []
    for work in (0.0, 0.013, 0.004, 0.019, 0.001):
        assert pacer.wait()
        moments.append(clock.time)
        clock.time += work
    assert moments == pytest.approx([100.0 + 0.02 * i for i in range(5)])


def test_a_round_that_takes_too_long_is_made_up_for_once(clock):
    pacer = Pacer(clock, 0.02, 0.0, Interrupt())
    pacer.wait()
    clock.time += 0.03
    pacer.wait()
    assert clock.time == pytest.approx(100.03)
    pacer.wait()
    assert clock.time == pytest.approx(100.04)


@pytest.mark.parametrize("jump", [5.0, -50.0])
def test_after_a_break_or_a_clock_set_back_it_begins_anew(clock, jump):
    pacer = Pacer(clock, 0.02, 0.0, Interrupt())
    pacer.wait()
    clock.time += jump
    now = clock.time
    pacer.wait()
    assert clock.time == now
    pacer.wait()
    assert clock.time == pytest.approx(now + 0.02)


def test_an_interrupt_ends_the_wait(clock):
    interrupt = Interrupt()
    pacer = Pacer(clock, 0.02, 0.0, interrupt)
    assert pacer.wait()
    interrupt.trigger()
    assert not pacer.wait()


def test_fast_simulated_time_does_not_shorten_the_rest():
    """Rounds of simulated time that pass at once still leave real time between them."""
    clock = TurnedClock()
    pacer = Pacer(clock, 0.02, 0.01, Interrupt())
    from nao_library_modules.clock import WallClock

    wall = WallClock()
    pacer.wait()
    began = wall.now()
    for _ in range(5):
        pacer.wait()
    assert wall.now() - began >= 0.049
