"""The way of a foot through the air."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.swing import swing

START, END = FootPose(0.0, 0.1, 3.0), FootPose(0.08, 0.12, -3.0)
LIFT = 0.025
SHARES = [i / 200 for i in range(201)]


def test_it_begins_and_ends_where_the_foot_stands():
    assert swing(START, END, 0.0, LIFT) == (START, 0.0)
    landed = swing(START, END, 1.0, LIFT)
    assert landed.pose[:2] == pytest.approx(END[:2])
    assert landed.height == pytest.approx(0.0)


@pytest.mark.parametrize("share, same", [(-0.5, 0.0), (1.5, 1.0)])
def test_before_and_after_its_way_it_stands_still(share, same):
    assert swing(START, END, share, LIFT) == swing(START, END, same, LIFT)


def test_half_way_it_is_in_the_middle_and_highest():
    half = swing(START, END, 0.5, LIFT)
    assert half.pose[:2] == pytest.approx((0.04, 0.11))
    assert half.height == pytest.approx(LIFT)
    assert max(swing(START, END, share, LIFT).height for share in SHARES) == pytest.approx(LIFT)


def test_it_turns_the_short_way():
    yaws = [swing(START, END, share, LIFT).pose.yaw for share in SHARES]
    assert yaws == sorted(yaws)
    assert yaws[-1] - yaws[0] == pytest.approx(2 * math.pi - 6.0)


def test_it_only_goes_forward_and_rests_at_both_ends():
    way = [swing(START, END, share, LIFT) for share in SHARES]
    xs, heights = [at.pose.x for at in way], [at.height for at in way]
    assert xs == sorted(xs)
    steps = [b - a for a, b in zip(xs, xs[1:])]
    assert max(steps[0], steps[-1]) < 1e-3 * max(steps)
    assert max(abs(heights[1]), abs(heights[-2])) < 1e-3 * LIFT
    assert min(heights) >= 0.0
