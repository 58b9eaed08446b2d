"""Clicks of a button: what belongs together, and what is no click."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.touch_clicks import LONGEST_CLICK, LONGEST_PAUSE, ClickCounter

TICK = 1.0 / 120.0


def told(*presses, until=6.0):
    """(time, clicks) that are told, for presses (from, to) in s."""
    counter, news = ClickCounter(), []
    for tick in range(round(until / TICK)):
        now = tick * TICK
        clicks = counter.feed(any(begin <= now < end for begin, end in presses), now)
        if clicks:
            news.append((now, clicks))
    return news


def test_nothing_pressed_is_nothing_to_tell():
    assert told() == []


@pytest.mark.parametrize("count", [1, 2])
def test_clicks_are_told_when_no_further_one_follows(count):
    presses = [(1.0 + 0.3 * n, 1.1 + 0.3 * n) for n in range(count)]
    ((when, clicks),) = told(*presses)
    assert clicks == count
    assert when == pytest.approx(presses[-1][1] + LONGEST_PAUSE, abs=2 * TICK)


def test_the_third_click_is_told_at_once():
    ((when, clicks),) = told((1.0, 1.1), (1.3, 1.4), (1.6, 1.7))
    assert clicks == 3
    assert when == pytest.approx(1.7, abs=TICK)


def test_the_fourth_click_begins_anew():
    assert [clicks for _, clicks in told((1.0, 1.1), (1.3, 1.4), (1.6, 1.7), (1.9, 2.0))] == [3, 1]


def test_clicks_with_a_long_pause_are_told_one_by_one():
    pause = LONGEST_PAUSE + 0.05
    assert [clicks for _, clicks in told((1.0, 1.1), (1.1 + pause, 1.2 + pause))] == [1, 1]


def test_a_slow_click_after_a_quick_pause_still_belongs_to_the_series():
    """The pause counts, not the time from press to press."""
    assert [clicks for _, clicks in told((1.0, 1.6), (2.0, 2.6))] == [2]


def test_what_is_held_long_is_no_click_and_ends_a_series():
    assert told((1.0, 1.1 + LONGEST_CLICK)) == []
    assert told((1.0, 1.1), (1.3, 1.4 + LONGEST_CLICK)) == []
