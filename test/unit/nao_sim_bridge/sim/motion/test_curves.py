"""Curves of one joint: ramps and smooth curves through key points."""

from __future__ import annotations

import random

import pytest

from nao_sim_bridge.sim.motion.curves import Ramp, SmoothCurve


def sampled(curve, count=2001):
    """Values at `count` even times from start to end."""
    return [curve.value(curve.duration * k / (count - 1)) for k in range(count)]


@pytest.mark.parametrize("elapsed, angle", [(-1.0, 0.2), (0.0, 0.2), (0.5, 0.45), (1.0, 0.7), (9.0, 0.7)])
def test_a_ramp_is_linear_and_holds_its_ends(elapsed, angle):
    assert Ramp(start=0.2, target=0.7, speed=0.5).value(elapsed) == pytest.approx(angle)


def test_a_ramp_downwards_takes_as_long():
    ramp = Ramp(start=0.7, target=0.2, speed=0.5)
    assert ramp.duration == pytest.approx(1.0)
    assert ramp.value(0.25) == pytest.approx(0.575)


@pytest.mark.parametrize("elapsed", [-1.0, 0.0, 1.0])
def test_a_ramp_to_where_it_is_takes_no_time(elapsed):
    ramp = Ramp(start=0.3, target=0.3, speed=1.0)
    assert ramp.duration == 0.0
    assert ramp.value(elapsed) == 0.3


def test_a_smooth_curve_meets_its_points_and_holds_the_ends():
    curve = SmoothCurve((0.0, 0.5, 2.0, 2.5), (0.1, 0.6, -0.4, -0.3))
    assert [curve.value(time) for time in curve.times] == pytest.approx(curve.values)
    assert curve.value(-3.0) == 0.1
    assert curve.value(99.0) == -0.3
    assert curve.duration == 2.5


def test_between_two_points_it_is_the_cubic_at_rest_at_both_ends():
    curve = SmoothCurve((0.0, 2.0), (1.0, 3.0))
    for share in (0.1, 0.25, 0.5, 0.9):
        assert curve.value(2.0 * share) == pytest.approx(1.0 + 2.0 * share * share * (3.0 - 2.0 * share))
    assert curve.peak_speed() == pytest.approx(1.5)


def test_it_starts_and_ends_at_rest():
    curve = SmoothCurve((0.0, 1.0, 2.0), (0.0, 1.0, 3.0))
    step = 1e-4
    assert (curve.value(step) - curve.value(0.0)) / step == pytest.approx(0.0, abs=1e-3)
    assert (curve.value(2.0) - curve.value(2.0 - step)) / step == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("seed", range(8))
def test_it_never_leaves_the_range_between_two_points(seed):
    chance = random.Random(seed)
    times = [0.0]
    for _ in range(6):
        times.append(times[-1] + chance.uniform(0.05, 2.0))
    curve = SmoothCurve(times, [chance.uniform(-2.0, 2.0) for _ in times])
    for i in range(len(times) - 1):
        low, high = sorted(curve.values[i : i + 2])
        for k in range(51):
            value = curve.value(times[i] + k / 50 * (times[i + 1] - times[i]))
            assert low - 1e-9 <= value <= high + 1e-9


def test_it_does_not_stop_at_a_point_on_the_way_but_at_a_turning_point():
    step = 1e-5
    passing = SmoothCurve((0.0, 1.0, 2.0), (0.0, 1.0, 2.0))
    assert (passing.value(1.0 + step) - passing.value(1.0 - step)) / (2 * step) == pytest.approx(1.0, abs=1e-3)
    turning = SmoothCurve((0.0, 1.0, 2.0), (0.0, 1.0, 0.0))
    assert (turning.value(1.0 + step) - turning.value(1.0 - step)) / (2 * step) == pytest.approx(0.0, abs=1e-3)


def test_slopes_agree_where_two_segments_meet():
    curve = SmoothCurve((0.0, 0.3, 2.0), (0.0, 1.0, 1.5))
    step = 1e-6
    before = (curve.value(0.3) - curve.value(0.3 - step)) / step
    after = (curve.value(0.3 + step) - curve.value(0.3)) / step
    # The harmonic mean of the two chords.
    chords = (1.0 / 0.3, 0.5 / 1.7)
    assert before == pytest.approx(after, rel=1e-3) == pytest.approx(2.0 / (1 / chords[0] + 1 / chords[1]), rel=1e-3)


def test_peak_speed_bounds_every_step():
    curve = SmoothCurve((0.0, 0.2, 1.0, 1.1), (0.0, 0.5, -0.7, -0.6))
    values = sampled(curve)
    step = curve.duration / (len(values) - 1)
    fastest = max(abs(b - a) / step for a, b in zip(values, values[1:]))
    assert curve.peak_speed() == pytest.approx(fastest, rel=0.02)


@pytest.mark.parametrize(
    "times, values, message",
    [
        ((0.0, 1.0), (0.0,), "2 times and 1 values"),
        ((0.0,), (0.0,), "at least 2"),
        ((0.0, 1.0, 1.0), (0.0, 1.0, 2.0), "do not rise strictly"),
        ((0.0, -1.0), (0.0, 1.0), "do not rise strictly"),
    ],
)
def test_impossible_points_are_refused(times, values, message):
    with pytest.raises(ValueError, match=message):
        SmoothCurve(times, values)
