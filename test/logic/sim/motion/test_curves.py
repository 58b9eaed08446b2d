"""Curves of one joint: ramps, smooth curves through key points, and Bezier curves with handles."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.control.joints.bezier import BezierCurve, Handle, Interpolation, KeyPoint
from nao_sim_bridge.control.joints.curves import Ramp, SmoothCurve

CONSTANT, LINEAR, SMOOTH, BEZIER = Interpolation


def test_a_ramp_is_linear_and_holds_its_ends():
    ramp = Ramp(start=0.2, target=0.7, speed=0.5)
    assert [ramp.value(t) for t in (-1.0, 0.0, 0.5, 1.0, 9.0)] == pytest.approx([0.2, 0.2, 0.45, 0.7, 0.7])
    down, nothing = Ramp(start=0.7, target=0.2, speed=0.5), Ramp(start=0.3, target=0.3, speed=1.0)
    assert (down.duration, down.value(0.25)) == pytest.approx((1.0, 0.575))
    assert nothing.duration == 0.0 and {nothing.value(t) for t in (-1.0, 0.0, 1.0)} == {0.3}


@given(st.lists(st.tuples(st.floats(0.05, 2.0), st.floats(-2.0, 2.0)), min_size=2, max_size=7))
@settings(max_examples=50)
def test_a_smooth_curve_meets_its_points_and_stays_between_each_two(points):
    times, values = [0.0], [0.1]
    for step, value in points:
        times.append(times[-1] + step)
        values.append(value)
    curve = SmoothCurve(times, values)
    assert [curve.value(time) for time in times] == pytest.approx(values)
    assert (curve.duration, curve.value(-3.0), curve.value(99.0)) == (times[-1], 0.1, values[-1])
    for i in range(len(times) - 1):
        low, high = sorted(values[i : i + 2])
        inner = [curve.value(times[i] + k / 50 * (times[i + 1] - times[i])) for k in range(51)]
        assert low - 1e-9 <= min(inner) and max(inner) <= high + 1e-9
        steps = [abs(b - a) * 50 / (times[i + 1] - times[i]) for a, b in zip(inner, inner[1:])]
        assert max(steps) <= curve.peak_speed() * 1.02 + 1e-9


def test_between_two_points_it_is_the_cubic_at_rest_at_both_ends():
    curve = SmoothCurve((0.0, 2.0), (1.0, 3.0))
    for share in (1e-4, 0.1, 0.25, 0.5, 0.9, 0.9999):
        assert curve.value(2.0 * share) == pytest.approx(1.0 + 2.0 * share * share * (3.0 - 2.0 * share))
    assert curve.peak_speed() == pytest.approx(1.5)


@pytest.mark.parametrize(
    "times, values, slope",
    [
        ((0.0, 1.0, 2.0), (0.0, 1.0, 2.0), 1.0),
        ((0.0, 1.0, 2.0), (0.0, 1.0, 0.0), 0.0),
        # The harmonic mean of the two chords.
        ((0.0, 0.3, 2.0), (0.0, 1.0, 1.5), 2.0 / (0.3 + 1.7 / 0.5)),
    ],
)
def test_it_passes_points_on_its_way_without_a_stop_or_kink_and_rests_at_turning_points(times, values, slope):
    curve, step, at = SmoothCurve(times, values), 1e-6, times[1]
    for a, b in ((at - step, at), (at, at + step)):
        assert (curve.value(b) - curve.value(a)) / step == pytest.approx(slope, abs=1e-3)


def rise(after, before):
    """From (0 s, 0 rad) to (1 s, 1 rad)."""
    return BezierCurve([KeyPoint(0.0, 0.0, after=after), KeyPoint(1.0, 1.0, before=before)])


@pytest.mark.parametrize("kind", [SMOOTH, BEZIER])
def test_with_time_handles_of_a_third_the_angle_is_the_known_cubic(kind):
    eased = rise(Handle(kind, 1 / 3, 0.0), Handle(kind, -1 / 3, 0.0))
    for t in (0.0, 0.1, 0.25, 0.5, 0.8, 1.0):
        assert eased.value(t) == pytest.approx(3 * t**2 - 2 * t**3, abs=1e-9)
    assert eased.peak_speed() == pytest.approx(1.5, rel=1e-2)
    straight = rise(Handle(kind, 0.2, 0.2), Handle(kind, -0.4, -0.4))
    for t in (0.1, 0.3, 0.7, 0.95):
        assert straight.value(t) == pytest.approx(t, abs=1e-8), "along the chord"


def test_angle_offsets_of_handles_pull_the_curve():
    pulled, t = rise(Handle(BEZIER, 1 / 3, 1.5), Handle(BEZIER, -1 / 3, 0.5)), 0.5
    assert pulled.value(t) == pytest.approx(3 * t * (1 - t) ** 2 * 1.5 + 3 * t**2 * (1 - t) * 1.5 + t**3)
    low, high = pulled.extremes
    assert low == 0.0 and high > 1.1
    assert high == pytest.approx(max(pulled.value(k / 200) for k in range(201)), abs=5e-3)


def test_time_runs_forward_and_handles_longer_than_their_segment_are_shortened():
    """Handles as long as the segment itself: time stands nearly still in the middle, and is found all the same."""
    steep, long = (rise(Handle(BEZIER, size, 0.0), Handle(BEZIER, -size, 0.0)) for size in (1.0, 4.0))
    values = [steep.value(k / 100) for k in range(101)]
    assert all(b >= a - 1e-9 for a, b in zip(values, values[1:]))
    assert steep.value(0.5) == pytest.approx(0.5, abs=1e-3)
    assert [long.value(k / 100) for k in range(101)] == pytest.approx(values)


def test_linear_and_constant_segments():
    linear = rise(Handle(LINEAR, 0.3, 5.0), Handle(LINEAR, -0.3, 5.0))
    assert [linear.value(t) for t in (0.25, 0.5, 0.75)] == pytest.approx([0.25, 0.5, 0.75])
    assert linear.peak_speed() == pytest.approx(1.0)
    jump = rise(Handle(CONSTANT), Handle(CONSTANT))
    assert (jump.value(0.999), jump.value(1.0), jump.extremes, jump.peak_speed()) == (0.0, 1.0, (0.0, 1.0), 0.0)
    half = rise(Handle(BEZIER, 1 / 3, 0.0), Handle(LINEAR, -1 / 3, 7.0))
    assert 0.0 < half.value(0.5) < 1.0 == max(half.extremes), "a segment may end without a handle"


def test_segments_follow_each_other_and_the_ends_hold():
    first, last = KeyPoint(0.0, 0.5, after=Handle(LINEAR)), KeyPoint(3.0, -1.0, before=Handle(BEZIER, -1 / 3, 0.0))
    both = BezierCurve([first, KeyPoint(1.0, 1.0, after=Handle(BEZIER, 1 / 3, 0.0)), last])
    assert both.duration == 3.0
    found = [both.value(t) for t in (-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0)]
    assert found == pytest.approx([0.5, 0.5, 0.75, 1.0, 0.0, -1.0, -1.0])
