from __future__ import annotations

import threading

import pytest
from nao_benchmarks.stats import Sample, interleave


class Clock:
    """Time that passes only when something is run, s."""

    def __init__(self):
        self.now = 0.0
        self.log = []

    def __call__(self):
        return self.now

    def taking(self, name, *seconds):
        """A run that takes these times, one after the other, then the last one for ever."""
        left = list(seconds)

        def run():
            self.log.append(name)
            self.now += left.pop(0) if len(left) > 1 else left[0]

        return run


def test_alternatives_take_turns_and_every_second_round_goes_backwards():
    clock = Clock()
    runs = [clock.taking("a", 1.0), clock.taking("b", 1.0), clock.taking("c", 1.0)]
    interleave(runs, rounds=3, clock=clock)
    assert clock.log == [*"abc", *"cba", *"abc"]


def test_each_alternative_has_its_own_times_in_the_order_of_its_runs():
    clock = Clock()
    runs = [clock.taking("a", 1.0, 2.0, 4.0), clock.taking("b", 8.0)]
    first, second = interleave(runs, rounds=3, clock=clock)
    assert first.seconds == (1.0, 2.0, 4.0)
    assert second.seconds == (8.0, 8.0, 8.0)


@pytest.mark.parametrize("warm_up", [1, 2])
def test_the_warm_up_runs_but_does_not_count(warm_up):
    clock = Clock()
    run = clock.taking("a", *[100.0] * warm_up, 1.0)
    (sample,) = interleave([run], rounds=2, warm_up=warm_up, clock=clock)
    assert clock.log == ["a"] * (warm_up + 2)
    assert sample.seconds == (1.0, 1.0)


@pytest.mark.parametrize("rounds, warm_up", [(0, 0), (1, -1)])
def test_without_a_round_there_is_nothing_to_measure(rounds, warm_up):
    with pytest.raises(ValueError, match=f"rounds is {rounds}, warm_up {warm_up}"):
        interleave([lambda: None], rounds=rounds, warm_up=warm_up)


def test_an_error_in_a_run_ends_the_measurement():
    with pytest.raises(ZeroDivisionError):
        interleave([lambda: 1 / 0], rounds=1)


def test_the_median_does_not_mind_a_disturbance():
    assert Sample((3.0, 1.0, 900.0, 2.0, 4.0)).median == 3.0
    assert Sample((1.0, 2.0)).median == 1.5


def test_quartiles_enclose_the_middle_half():
    assert Sample((5.0, 1.0, 4.0, 2.0, 3.0)).quartiles == (2.0, 4.0)
    assert Sample((7.0,)).quartiles == (7.0, 7.0)


def test_the_share_above_a_limit_leaves_the_limit_out():
    assert Sample((1.0, 2.0, 3.0, 4.0)).share_above(2.0) == 0.5
    assert Sample((1.0, 2.0)).share_above(5.0) == 0.0


def test_real_time_is_measured_in_seconds():
    """Two runs that wait for the same event limit differ only by what the machine adds."""
    never = threading.Event()
    short, long = interleave([lambda: never.wait(0.01), lambda: never.wait(0.05)], rounds=3)
    assert min(short.seconds) >= 0.01
    assert min(long.seconds) >= 0.05
    assert short.median < long.median
