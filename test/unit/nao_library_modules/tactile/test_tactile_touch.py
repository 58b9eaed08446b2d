"""When a touch is the one that is waited for. Times are passed in."""

from __future__ import annotations

import pytest

from nao_library_modules.tactile_touch import COUNT, HOLD, PRESS, RELEASE, TouchWatch, Wanted


def test_a_press_is_told_and_a_release_is_not():
    watch = TouchWatch(Wanted(PRESS), [], 0.0)
    assert watch.tell("chest", True, 1.0) == ["chest"]
    assert watch.tell("chest", False, 1.5) == []
    assert watch.pressed == []


def test_what_is_pressed_already_is_no_press_unless_it_is_told_of():
    watch = TouchWatch(Wanted(PRESS), ["chest"], 0.0)
    assert watch.pressed == ["chest"]
    assert watch.tell("chest", False, 0.5) == []
    watch = TouchWatch(Wanted(PRESS), ["chest"], 0.0)
    assert watch.tell("chest", True, 0.1) == ["chest"]
    assert watch.tell("chest", True, 0.2) == []


def test_a_release_counts_for_what_was_pressed_before():
    watch = TouchWatch(Wanted(RELEASE), ["chest"], 0.0)
    assert watch.tell("left bumper", False, 0.1) == []
    assert watch.tell("chest", False, 0.2) == ["chest"]


def test_a_hold_is_due_after_its_duration_and_is_told_once():
    watch = TouchWatch(Wanted(HOLD, duration=1.0), [], 0.0)
    assert watch.due is None
    watch.tell("chest", True, 2.0)
    assert watch.due == pytest.approx(3.0)
    assert watch.look(2.9) == []
    assert watch.look(3.0) == ["chest"]
    assert watch.look(4.0) == [] and watch.due is None
    watch.tell("chest", False, 5.0)
    watch.tell("chest", True, 6.0)
    assert watch.due == pytest.approx(7.0)


def test_a_hold_that_ends_too_early_is_none():
    watch = TouchWatch(Wanted(HOLD, duration=1.0), [], 0.0)
    watch.tell("chest", True, 0.0)
    assert watch.tell("chest", False, 0.9) == []
    assert watch.due is None and watch.look(5.0) == []


def test_a_count_needs_its_presses_within_its_time():
    watch = TouchWatch(Wanted(COUNT, count=3, duration=1.0), [], 0.0)
    told = []
    for time in (0.0, 0.8, 1.6, 1.7, 1.75):
        told.append(watch.tell("chest", True, time))
        watch.tell("chest", False, time + 0.02)
    # 0.0 is too old for 1.6; then the counting begins anew.
    assert told == [[], [], [], ["chest"], []]


def test_a_count_tells_every_sensor_that_was_pressed_for_it():
    watch = TouchWatch(Wanted(COUNT, count=2, duration=1.0), [], 0.0)
    assert watch.tell("rear head", True, 0.1) == []
    assert watch.tell("front head", True, 0.4) == ["rear head", "front head"]
