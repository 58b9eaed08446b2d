"""Gestures on the head: sequences of touches in time."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.touch_gestures import (
    FREE,
    GESTURES,
    HOLD_TIME,
    SEQUENCE_TIME,
    SETTLE_TIME,
    GestureBook,
    GestureRecogniser,
    Seen,
    Times,
)

TICK = 1.0 / 120.0


@pytest.fixture
def book():
    return GestureBook()


def run(book, *touches, times=None):
    """[(time, seen)] of touches, each a pattern and how long it lasts, s."""
    recogniser, news, now = GestureRecogniser(book, times or Times()), [], 0.0
    for pattern, duration in touches:
        for _ in range(round(duration / TICK)):
            now += TICK
            seen = recogniser.feed(pattern, now)
            if seen != Seen():
                news.append((now, seen))
    return news


def names(news):
    return [seen.gesture for _, seen in news if seen.gesture]


@pytest.mark.parametrize("name", [name for name, sequence in GESTURES.items() if sequence[-1] == FREE])
def test_a_gesture_is_recognised_when_it_is_over(book, name):
    touches = [(pattern, 0.12) for pattern in GESTURES[name][:-1]]
    begin = sum(duration for _, duration in touches)
    ((when, seen),) = run(book, *touches, (FREE, 1.0))
    assert seen == Seen(name, released=True)
    assert when == pytest.approx(begin + SETTLE_TIME + SEQUENCE_TIME, abs=3 * TICK)


@pytest.mark.parametrize("name", [name for name, sequence in GESTURES.items() if sequence[-1] != FREE])
def test_what_is_held_is_told_again_and_again_until_it_is_released(book, name):
    news = run(book, (FREE, 0.2), (GESTURES[name][-1], 2.0), (FREE, 1.0))
    assert [seen for _, seen in news] == [Seen(name), Seen(name), Seen(released=True)]
    first = 0.2 + SETTLE_TIME + HOLD_TIME
    assert [when for when, _ in news] == pytest.approx([first, first + HOLD_TIME, 2.2 + SETTLE_TIME], abs=3 * TICK)


def test_fingers_need_not_land_at_once(book):
    """A tap with the flat hand: the sensors feel it one after the other, within the time to settle."""
    assert names(run(book, (FREE, 0.2), ("010", 0.015), ("110", 0.015), ("111", 0.2), (FREE, 1.0))) == ["SingleTap"]


def test_a_sensor_that_bounces_is_not_touched_twice(book):
    assert names(run(book, (FREE, 0.2), ("100", 0.2), (FREE, 0.017), ("100", 0.2), (FREE, 1.0))) == ["SingleFront"]


def test_touches_with_a_long_pause_are_two_gestures(book):
    pause = SETTLE_TIME + SEQUENCE_TIME + 0.05
    touches = [("100", 0.1), (FREE, pause), ("100", 0.1), (FREE, 1.0)]
    assert names(run(book, (FREE, 0.2), *touches)) == ["SingleFront", "SingleFront"]


def test_an_unknown_sequence_is_nobodys_gesture(book):
    assert run(book, (FREE, 0.2), ("100", 0.1), ("001", 0.1), (FREE, 1.0)) == []


def test_what_follows_something_held_is_a_gesture_of_its_own(book):
    news = run(book, (FREE, 0.2), ("100", 1.0), ("010", 0.1), (FREE, 1.0))
    assert [seen for _, seen in news] == [Seen("SingleFrontHold"), Seen(released=True), Seen("SingleMiddle", True)]


def test_times_can_be_changed(book):
    times = Times()
    times.hold, times.sequence = 0.2, 0.6
    assert names(run(book, (FREE, 0.2), ("100", 0.3), (FREE, 1.0), times=times)) == ["SingleFrontHold"]
    times.hold = 2.0
    slow = [("100", 0.1), (FREE, 0.5), ("100", 0.1), (FREE, 1.0)]
    assert names(run(book, (FREE, 0.2), *slow, times=times)) == ["DoubleFront"]


def test_new_gestures_are_recognised_by_the_name_that_they_get(book):
    triple = [FREE, "111", FREE, "111", FREE, "111", FREE]
    name = book.add(triple)
    assert book.add(triple) == name and book.sequence_of(name) == triple and book.name_of(triple) == name
    taps = [("111", 0.1), (FREE, 0.1)] * 3
    assert names(run(book, (FREE, 0.2), *taps, (FREE, 1.0))) == [name]
    assert book.add(GESTURES["ZoomIn"]) == "ZoomIn"


@pytest.mark.parametrize(
    "sequence",
    [
        [],
        [FREE],
        ["100", FREE],
        [FREE, "12", FREE],
        [FREE, "200"],
        [FREE, FREE],
        [FREE, 100],
        [FREE] + ["100", FREE] * 20,
    ],
)
def test_what_no_head_can_feel_is_refused(book, sequence):
    with pytest.raises(BadValue, match="sensor sequence"):
        book.add(sequence)
    assert book.all() == {name: list(gesture) for name, gesture in GESTURES.items()}
