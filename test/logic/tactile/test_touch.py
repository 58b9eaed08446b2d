"""Names of what can be touched, when a touch is the one that is waited for, and keys of the body's devices."""

from __future__ import annotations

import math

import pytest

from nao_library_modules import body_devices as devices
from nao_library_modules.errors import BadGoal
from nao_library_modules.tactile_names import GROUPS, SENSORS, names_of, sensors_of
from nao_library_modules.tactile_touch import COUNT, HOLD, PRESS, TouchWatch, Wanted

HEAD, LEFT_HAND = ["front head", "middle head", "rear head"], ["left hand back", "left hand left", "left hand right"]


def test_sensors_are_known_by_short_names_events_devices_and_groups():
    for words, names in (
        (["front head"], HEAD[:1]), (["FrontTactilTouched"], HEAD[:1]), (["Head/Touch/Front"], HEAD[:1]),
        (["front_head", " Front  Head "], HEAD[:1]), (["head"], HEAD), (["bumpers"], ["left bumper", "right bumper"]),
        (["chest", "left hand"], [*LEFT_HAND, "chest"]), (["LFoot/Bumper/Right"], ["left bumper"]),
    ):  # fmt: skip
        assert names_of(sensors_of(words)) == names
    assert sensors_of([]) == SENSORS == sensors_of(["any"]) and len(SENSORS) == 12
    assert all(sensors_of([group]) for group in GROUPS) and not set(GROUPS) & set(names_of(SENSORS))
    with pytest.raises(BadGoal, match="'frot head' is nothing that can be touched: did you mean 'front head'"):
        sensors_of(["head", "frot head"])


def test_what_is_pressed_already_is_no_press_and_a_hold_is_told_once():
    watch = TouchWatch(Wanted(PRESS), ["chest"], 0.0)
    assert watch.pressed == ["chest"] and watch.tell("chest", False, 0.5) == []
    watch = TouchWatch(Wanted(HOLD, duration=1.0), [], 0.0)
    assert watch.due is None
    watch.tell("chest", True, 2.0)
    assert watch.due == pytest.approx(3.0) and watch.look(2.9) == []
    assert watch.look(3.0) == ["chest"]
    assert watch.look(4.0) == [] and watch.due is None


def test_a_count_needs_its_presses_within_its_time_and_tells_every_sensor():
    watch, told = TouchWatch(Wanted(COUNT, count=3, duration=1.0), [], 0.0), []
    for time in (0.0, 0.8, 1.6, 1.7, 1.75):
        told.append(watch.tell("chest", True, time))
        watch.tell("chest", False, time + 0.02)
    assert told == [[], [], [], ["chest"], []], "0.0 is too old for 1.6; then the counting begins anew"
    watch = TouchWatch(Wanted(COUNT, count=2, duration=1.0), [], 0.0)
    assert (watch.tell("rear head", True, 0.1), watch.tell("front head", True, 0.4)) == (
        [],
        ["rear head", "front head"],
    )


def test_what_does_not_echo_is_infinitely_far_and_a_sonar_that_failed_tells_no_distance():
    for value, distance in ((0.8, 0.8), (0.1, 0.1), (2.54, 2.54), (2.55, math.inf), (5.0, math.inf)):
        assert devices.echo_of(value) == distance
    assert all(math.isnan(devices.echo_of(value)) for value in (0.0, -1.0, math.nan, None, "far", True))
