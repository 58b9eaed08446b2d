"""Times of pictures: which are passed on, where they stand in a video, and what they are in ROS time."""

from __future__ import annotations

import random

import pytest

from nao_library_modules.core.robot_events import ImageClock
from nao_library_modules.vision.pictures import RateLimit, VideoTimes


def passed(rate, stamps):
    limit = RateLimit(rate)
    return [stamp for stamp in stamps if limit.passes(stamp)]


def test_so_many_frames_are_passed_on():
    stamps = [100.0 + k / 30.0 for k in range(90)]
    for rate, count in ((0.0, 90), (30.0, 90), (15.0, 45), (10.0, 30), (5.0, 15), (1.0, 3), (20.0, 60)):
        assert len(passed(rate, stamps)) == pytest.approx(count, abs=1)
    uneven = [k / 10.0 + (0.004 if k % 2 else -0.004) for k in range(100)]
    assert len(passed(10.0, uneven)) == 100
    assert passed(1.0, [0.0, 0.5, 1.0, 10.0, 10.5, 11.0]) == [0.0, 1.0, 10.0, 11.0], "not all at once after a gap"
    assert passed(1.0, [50.0, 51.0, 0.5, 1.0, 1.5]) == [50.0, 51.0, 0.5, 1.5], "a clock may be set back"


def test_times_in_a_video_are_those_of_the_camera_whichever_clock_it_has():
    def places(*stamps):
        times = VideoTimes(0.001)
        return [times.place(stamp) for stamp in stamps]

    assert places(7.0, 7.033, 7.5, 9.0) == pytest.approx([0.0, 0.033, 0.5, 2.0])
    twice = places(7.0, 7.1, 7.1, 7.05, 7.2)
    assert twice == [0.0, pytest.approx(0.1), None, None, pytest.approx(0.2)]
    for other in (0.0, 1.6e9):
        stamps = 700.0, 700.1, other, other + 0.1, other + 0.3
        assert places(*stamps) == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.5], abs=1e-6)


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


@pytest.mark.parametrize("taken, arrived", [(1.0, 210.0), (90.0, 210.0), (10.1, 5.0), (300.0, 210.0)])
def test_a_clock_that_was_set_begins_anew(taken, arrived):
    clock = ImageClock()
    clock.take(10.0, 200.0)
    assert clock.take(taken, arrived) <= arrived
    assert clock.take(taken + 0.1, arrived + 0.1) == pytest.approx(arrived + 0.1, abs=1e-4)
