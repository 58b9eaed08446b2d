"""When frames are passed on, and where they stand in a video."""

from __future__ import annotations

import pytest

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
