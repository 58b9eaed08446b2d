"""The divergent component of motion: closed form against its differential equation."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.walk.pattern import Segment, divergent_component

OMEGA = 6.1
PLAN = [
    Segment(0.3, (0.0, 0.0), (0.02, -0.05)),
    Segment(0.33, (0.02, -0.05), (0.02, -0.05)),
    Segment(0.09, (0.02, -0.05), (0.06, 0.05)),
    Segment(0.33, (0.06, 0.05), (0.06, 0.05)),
    Segment(0.3, (0.06, 0.05), (0.06, 0.0)),
]
END = (0.06, 0.0)


def test_at_rest_it_stays_where_it_is():
    assert divergent_component([Segment(1.0, END, END)], END, OMEGA) == pytest.approx(END)
    assert divergent_component([], END, OMEGA) == END


def test_a_point_that_stands_pushes_it_away_exponentially():
    x, y = divergent_component([Segment(0.4, (0.0, 0.0), (0.0, 0.0))], (0.05, -0.02), OMEGA)
    assert (x, y) == pytest.approx((0.05 * math.exp(-OMEGA * 0.4), -0.02 * math.exp(-OMEGA * 0.4)))


def test_followed_through_the_plan_it_comes_to_rest_at_the_end():
    x, y = divergent_component(PLAN, END, OMEGA)
    step = 1e-5
    for duration, (ax, ay), (bx, by) in PLAN:
        count = round(duration / step)
        for i in range(count):
            share = (i + 0.5) / count
            x += step * OMEGA * (x - ax - share * (bx - ax))
            y += step * OMEGA * (y - ay - share * (by - ay))
    assert (x, y) == pytest.approx(END, abs=1e-3)


def test_a_segment_cut_in_two_changes_nothing():
    first = PLAN[0]
    middle = tuple((a + b) / 2 for a, b in zip(first.start, first.end))
    halves = [Segment(0.15, first.start, middle), Segment(0.15, middle, first.end)]
    assert divergent_component([*halves, *PLAN[1:]], END, OMEGA) == pytest.approx(divergent_component(PLAN, END, OMEGA))


def test_no_time_is_no_segment():
    assert divergent_component([Segment(0.0, (1.0, 1.0), (2.0, 2.0)), *PLAN], END, OMEGA) == pytest.approx(
        divergent_component(PLAN, END, OMEGA)
    )
