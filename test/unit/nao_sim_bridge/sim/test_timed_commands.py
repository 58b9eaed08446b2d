"""Timed commands: how new ones join old ones, and the way they make."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.timed_commands import AT_ONCE, merged, polyline

OLD = ((0.1, 100), (0.2, 200), (0.3, 300))
NEW = ((0.5, 250), (0.6, 200))


@pytest.mark.parametrize(
    "update, result",
    [
        ("Merge", ((0.1, 100), (0.6, 200), (0.5, 250), (0.3, 300))),
        ("ClearAll", ((0.6, 200), (0.5, 250))),
        ("ClearAfter", ((0.1, 100), (0.6, 200), (0.5, 250))),
        ("ClearBefore", ((0.6, 200), (0.5, 250), (0.3, 300))),
    ],
)
def test_updates(update, result):
    assert merged(OLD, NEW, update) == result


def test_an_unknown_update_is_named():
    with pytest.raises(BadValue, match="update type is 'Clear', allowed is Merge, ClearAll, ClearAfter, ClearBefore"):
        merged(OLD, NEW, "Clear")


def test_only_clear_all_drops_without_new_ones():
    assert merged(OLD, (), "Merge") == OLD
    assert merged(OLD, (), "ClearAll") == ()


@pytest.mark.parametrize("elapsed, value", [(-1.0, 0.0), (0.0, 0.0), (0.5, 0.25), (1.0, 0.5), (1.5, 0.0), (9.0, -0.5)])
def test_the_way_is_straight_between_moments(elapsed, value):
    way = polyline(((0.5, 3000), (-0.5, 4000)), now=2000, start=0.0)
    assert way.value(elapsed) == pytest.approx(value)
    assert way.duration == 2.0


def test_what_is_past_is_done_at_once():
    way = polyline(((0.1, 100), (0.4, 900), (0.8, 2000)), now=1000, start=0.0)
    assert way.value(AT_ONCE) == 0.4
    assert way.value(1.0) == 0.8
    assert polyline(((0.7, 10),), now=1000, start=0.0).value(AT_ONCE) == 0.7


def test_no_commands_make_no_way():
    assert polyline((), now=0, start=0.0) is None
