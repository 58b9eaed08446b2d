"""Times of pictures: which are passed on, where they stand in a video, and what they are in ROS time."""

from __future__ import annotations

import random

import pytest

from nao_library_modules.image_clock import ImageClock
from nao_library_modules.vision_times import RateLimit, RateMeter, VideoTimes


def passed(rate, stamps):
    limit = RateLimit(rate)
    return [stamp for stamp in stamps if limit.passes(stamp)]


@pytest.mark.parametrize(
    "rate, count", [(0.0, 90), (30.0, 90), (15.0, 45), (10.0, 30), (5.0, 15), (1.0, 3), (20.0, 60)]
)
def test_of_thirty_frames_a_second_so_many_are_passed_on(rate, count):
    stamps = [100.0 + k / 30.0 for k in range(90)]
    assert len(passed(rate, stamps)) == pytest.approx(count, abs=1)


def test_stamps_need_not_be_even():
    stamps = [k / 10.0 + (0.004 if k % 2 else -0.004) for k in range(100)]
    assert len(passed(10.0, stamps)) == 100


def test_after_a_gap_frames_do_not_come_all_at_once():
    assert passed(1.0, [0.0, 0.5, 1.0, 10.0, 10.5, 11.0]) == [0.0, 1.0, 10.0, 11.0]


def test_a_clock_that_is_set_back_does_not_end_the_frames():
    assert passed(1.0, [50.0, 51.0, 0.5, 1.0, 1.5]) == [50.0, 51.0, 0.5, 1.5]


def test_times_in_a_video_are_those_of_the_camera():
    times = VideoTimes(0.001)
    assert [times.place(stamp) for stamp in (7.0, 7.033, 7.5, 9.0)] == pytest.approx([0.0, 0.033, 0.5, 2.0])


def test_a_frame_that_comes_twice_has_no_second_place():
    times = VideoTimes(0.001)
    assert [times.place(stamp) for stamp in (7.0, 7.1, 7.1, 7.05, 7.2)] == [
        0.0, pytest.approx(0.1), None, None, pytest.approx(0.2),
    ]  # fmt: skip


@pytest.mark.parametrize("other", [0.0, 1.6e9])
def test_another_clock_goes_on_where_the_old_one_ended(other):
    times = VideoTimes(0.001)
    stamps = [700.0, 700.1, other, other + 0.1, other + 0.3]
    assert [times.place(stamp) for stamp in stamps] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.5], abs=1e-6)


def test_rate_of_late():
    meter = RateMeter(4)
    assert meter.rate == 0.0
    for stamp in (0.0, 1.0, 2.0, 2.1, 2.2, 2.3):
        meter.count(stamp)
    assert meter.rate == pytest.approx(10.0)
    meter.count(0.5)  # set back
    assert meter.rate == 0.0


# Pictures of a clock of their own


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
