"""Timed Bezier curves: known shapes, handles, kinds of segments, and errors."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.motion.bezier import BezierCurve, Handle, Interpolation, KeyPoint

CONSTANT, LINEAR, SMOOTH, BEZIER = Interpolation


def curve(*points):
    return BezierCurve(points)


def rise(after, before):
    """From (0 s, 0 rad) to (1 s, 1 rad)."""
    return curve(KeyPoint(0.0, 0.0, after=after), KeyPoint(1.0, 1.0, before=before))


@pytest.mark.parametrize("kind", [SMOOTH, BEZIER])
def test_flat_handles_of_a_third_ease_in_and_out(kind):
    """With time handles of a third, time is the parameter itself and the angle the known cubic."""
    eased = rise(Handle(kind, 1 / 3, 0.0), Handle(kind, -1 / 3, 0.0))
    for t in (0.0, 0.1, 0.25, 0.5, 0.8, 1.0):
        assert eased.value(t) == pytest.approx(3 * t**2 - 2 * t**3, abs=1e-9)
    assert eased.peak_speed() == pytest.approx(1.5, rel=1e-2)


def test_handles_along_the_chord_make_a_straight_line():
    straight = rise(Handle(BEZIER, 0.2, 0.2), Handle(BEZIER, -0.4, -0.4))
    for t in (0.1, 0.3, 0.7, 0.95):
        assert straight.value(t) == pytest.approx(t, abs=1e-8)


def test_angle_offsets_of_handles_pull_the_curve():
    overshooting = rise(Handle(BEZIER, 1 / 3, 1.5), Handle(BEZIER, -1 / 3, 0.5))
    t = 0.5
    expected = 3 * t * (1 - t) ** 2 * 1.5 + 3 * t**2 * (1 - t) * 1.5 + t**3
    assert overshooting.value(t) == pytest.approx(expected)
    low, high = overshooting.extremes
    assert low == 0.0
    assert high == pytest.approx(max(overshooting.value(k / 200) for k in range(201)), abs=5e-3)
    assert high > 1.1


def test_steep_handles_keep_time_running_forward():
    """Handles as long as the segment itself: time stands nearly still in the middle, and is found all the same."""
    steep = rise(Handle(BEZIER, 1.0, 0.0), Handle(BEZIER, -1.0, 0.0))
    values = [steep.value(k / 100) for k in range(101)]
    assert all(b >= a - 1e-9 for a, b in zip(values, values[1:]))
    assert steep.value(0.5) == pytest.approx(0.5, abs=1e-3)


def test_handles_longer_than_their_segment_are_shortened():
    long = rise(Handle(BEZIER, 4.0, 0.0), Handle(BEZIER, -4.0, 0.0))
    limit = rise(Handle(BEZIER, 1.0, 0.0), Handle(BEZIER, -1.0, 0.0))
    assert [long.value(k / 20) for k in range(21)] == pytest.approx([limit.value(k / 20) for k in range(21)])


def test_linear_segments_ignore_handles():
    linear = rise(Handle(LINEAR, 0.3, 5.0), Handle(LINEAR, -0.3, 5.0))
    assert [linear.value(t) for t in (0.25, 0.5, 0.75)] == pytest.approx([0.25, 0.5, 0.75])
    assert linear.peak_speed() == pytest.approx(1.0)


def test_a_constant_segment_stays_and_jumps_at_its_end():
    jump = rise(Handle(CONSTANT), Handle(CONSTANT))
    assert jump.value(0.999) == 0.0
    assert jump.value(1.0) == 1.0
    assert jump.extremes == (0.0, 1.0)
    assert jump.peak_speed() == 0.0


def test_a_bezier_segment_may_end_without_a_handle():
    """The angle leaves flat and arrives along the line to the control point before."""
    half = rise(Handle(BEZIER, 1 / 3, 0.0), Handle(LINEAR, -1 / 3, 7.0))
    assert 0.0 < half.value(0.5) < 1.0
    assert max(half.extremes) == 1.0


def test_segments_follow_each_other_and_the_ends_hold():
    both = curve(
        KeyPoint(0.0, 0.5, after=Handle(LINEAR)),
        KeyPoint(1.0, 1.0, after=Handle(BEZIER, 1 / 3, 0.0)),
        KeyPoint(3.0, -1.0, before=Handle(BEZIER, -1 / 3, 0.0)),
    )
    assert both.duration == 3.0
    assert [both.value(t) for t in (-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0)] == pytest.approx(
        [0.5, 0.5, 0.75, 1.0, 0.0, -1.0, -1.0]
    )


@pytest.mark.parametrize("times, message", [([0.0], "1 key points"), ([0.0, 1.0, 1.0], "do not rise")])
def test_points_that_make_no_curve_are_refused(times, message):
    with pytest.raises(ValueError, match=message):
        BezierCurve([KeyPoint(t, 0.0) for t in times])
