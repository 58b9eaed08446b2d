"""Times of pictures are those of their taking, in ROS time, and grow."""

from __future__ import annotations

import random

import pytest

from nao_library_modules.image_clock import ImageClock


def test_the_quickest_pictures_tell_how_the_clocks_go_together():
    clock, luck = ImageClock(), random.Random(1)
    times = []
    for number in range(300):
        taken = number / 30.0
        arrived = 1000.0 + taken + 0.02 + luck.random() * 0.05
        times.append((taken, clock.take(taken, arrived), arrived))
    assert all(before[1] < after[1] for before, after in zip(times, times[1:]))
    assert all(ros <= arrived for _, ros, arrived in times)
    late = [ros - 1000.0 - taken for taken, ros, _ in times[100:]]
    assert max(late) - min(late) < 0.012, "the jitter of the way is in the times"
    assert sum(late) / len(late) == pytest.approx(0.02, abs=0.003)


def test_a_clock_that_runs_away_is_followed():
    clock, ros = ImageClock(), 0.0
    for number in range(3000):
        taken = number / 10.0
        ros = clock.take(taken, 500.0 + taken * 1.00005)
    assert ros == pytest.approx(500.0 + 299.9 * 1.00005, abs=0.001)


@pytest.mark.parametrize("taken, arrived", [(1.0, 210.0), (90.0, 210.0), (10.1, 5.0), (300.0, 210.0)])
def test_a_clock_that_was_set_begins_anew(taken, arrived):
    clock = ImageClock()
    clock.take(10.0, 200.0)
    assert clock.take(taken, arrived) <= arrived
    again = clock.take(taken + 0.1, arrived + 0.1)
    assert again == pytest.approx(arrived + 0.1, abs=1e-4)


def test_time_stands_still_rather_than_going_back_when_a_picture_is_quick():
    clock = ImageClock()
    late = clock.take(10.0, 200.5)
    quick = clock.take(10.033, 200.04)
    assert quick <= 200.04 and late <= 200.5


def test_a_robot_whose_time_goes_slower_is_followed():
    """A simulation that does not keep real time: its pictures are not dated back further and further."""
    clock = ImageClock()
    for number in range(300):
        taken = number / 15.0
        arrived = 500.0 + taken / 0.5 + 0.02
        ros = clock.take(taken, arrived)
        assert arrived - ros < 0.6


def test_few_pictures_are_compared_as_well():
    clock = ImageClock()
    times = [clock.take(float(number), 100.0 + number + late) for number, late in enumerate((0.1, 0.5, 0.3))]
    assert times == pytest.approx([100.1, 101.1, 102.1])


def test_what_was_before_a_break_is_forgotten():
    """A simulation that stood still: its clock is behind by the break, and three old pictures do not hide that."""
    clock = ImageClock()
    for number in range(3):
        clock.take(number / 10.0, 500.0 + number / 10.0 + 0.02)
    assert clock.take(0.4, 520.4) == pytest.approx(520.4, abs=0.001)
    assert clock.take(0.5, 520.5) == pytest.approx(520.5, abs=0.001)
