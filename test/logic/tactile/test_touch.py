"""Names of what can be touched, when a touch is the one that is waited for, and keys of the body's devices."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeActionClient

from nao_library_modules.core import nao_facts as devices
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.fields import fields_of
from nao_library_modules.core.nao_facts import GROUPS, SENSORS, names_of, sensors_of
from nao_library_modules.ros.behavior_client import BehaviorClient
from nao_library_modules.ros.goal_client import GoalTracker
from nao_library_modules.tactile.readings import WaitingFunctions
from nao_library_modules.tactile.tactile_fields import (
    COUNT,
    HOLD,
    PRESS,
    RELEASE,
    TouchWatch,
    WantedTouch,
    require_touch,
)

HEAD, LEFT_HAND = ["front head", "middle head", "rear head"], ["left hand back", "left hand left", "left hand right"]


def test_sensors_are_known_by_short_names_events_devices_and_groups():
    for words, names in (
        (["front head"], HEAD[:1]), (["FrontTactilTouched"], HEAD[:1]), (["Head/Touch/Front"], HEAD[:1]),
        (["front_head", " Front  Head ", "head front"], HEAD[:1]), (["head"], HEAD),
        (["bumpers"], ["left bumper", "right bumper"]),
        (["chest", "left hand"], [*LEFT_HAND, "chest"]), (["LFoot/Bumper/Right"], ["left bumper"]),
    ):  # fmt: skip
        assert names_of(sensors_of(words)) == names
    assert sensors_of([]) == SENSORS == sensors_of(["any"]) and len(SENSORS) == 12
    assert all(sensors_of([group]) for group in GROUPS) and not set(GROUPS) & set(names_of(SENSORS))
    with pytest.raises(BadGoal, match="'frot head' is nothing that can be touched: did you mean 'front head'"):
        sensors_of(["head", "frot head"])


def test_what_is_pressed_already_is_no_press_and_a_hold_is_told_once():
    watch = TouchWatch(WantedTouch(PRESS), {"chest": -3.0}, 0.0)
    assert watch.pressed == ["chest"] and watch.tell("chest", False, 0.5) == []
    watch = TouchWatch(WantedTouch(HOLD, duration=1.0), {}, 0.0)
    assert watch.due is None
    watch.tell("chest", True, 2.0)
    assert watch.due == pytest.approx(3.0) and watch.look(2.9) == []
    assert watch.look(3.0) == [("chest", 2.0, 0.0)]
    assert watch.look(4.0) == [] and watch.due is None


def test_a_touch_that_began_before_is_held_from_now_on_and_its_first_contact_is_told():
    watch = TouchWatch(WantedTouch(HOLD, duration=1.0), {"chest": -3.0}, 0.0)
    assert watch.due == pytest.approx(1.0) and watch.look(0.5) == []
    assert watch.look(1.0) == [("chest", -3.0, 0.0)]
    watch = TouchWatch(WantedTouch(RELEASE), {"chest": -3.0}, 0.0)
    assert watch.tell("chest", False, 0.5) == [("chest", -3.0, 0.5)]


def test_a_hold_lasts_as_long_as_the_sensor_says_however_late_that_is_heard_of():
    for let_go, held in ((2.99, []), (3.25, [("chest", 2.0, 3.25)])):
        watch = TouchWatch(WantedTouch(HOLD, duration=1.0), {}, 0.0)
        watch.tell("chest", True, 2.0)
        assert watch.tell("chest", False, let_go) == held


def test_a_count_needs_its_presses_within_its_time_and_tells_every_sensor():
    watch, told = TouchWatch(WantedTouch(COUNT, count=3, duration=1.0), {}, 0.0), []
    for time in (0.0, 0.8, 1.6, 1.7, 1.75):
        told.append(watch.tell("chest", True, time))
        watch.tell("chest", False, time + 0.02)
    assert told == [[], [], [], [("chest", 0.8, 0.0)], []], "0.0 is too old for 1.6; then the counting begins anew"
    watch = TouchWatch(WantedTouch(COUNT, count=2, duration=1.0), {}, 0.0)
    assert watch.tell("rear head", True, 0.1) == []
    assert watch.tell("front head", True, 0.4) == [("rear head", 0.1, 0.0), ("front head", 0.4, 0.0)]


@pytest.mark.parametrize("kind", [PRESS, RELEASE, COUNT])
def test_a_touch_counts_whose_release_comes_before_its_press_and_the_next_one_as_well(kind):
    watch = TouchWatch(WantedTouch(kind, count=1), {}, 10.0)
    for begin, lasts in ((11.0, 0.004), (12.0, 0.3)):
        assert watch.tell("front head", False, begin + lasts) == []
        (contact,) = watch.tell("front head", True, begin)
        assert contact.name == "front head" and watch.pressed == []
    watch.tell("front head", False, 20.0)
    watch.tell("front head", True, 20.2)
    assert watch.pressed == ["front head"], "a release long before the press was of another touch"


def test_what_does_not_echo_is_infinitely_far_and_a_sonar_that_failed_tells_no_distance():
    for value, distance in ((0.8, 0.8), (0.1, 0.1), (2.54, 2.54), (2.55, math.inf), (5.0, math.inf)):
        assert devices.echo_of(value) == distance
    assert all(math.isnan(devices.echo_of(value)) for value in (0.0, -1.0, math.nan, None, "far", True))


def test_numbers_are_looked_at_for_the_kinds_of_touch_that_have_them():
    declared = fields_of(WaitingFunctions.wait_for_touch, ("count", "duration"))
    assert (declared["count"].maximum, declared["duration"].maximum) == (20, 60.0)
    for kind in ("", PRESS, RELEASE):
        require_touch(kind, 21, 61.0)
    require_touch(HOLD, 21, 60.0)
    for kind, count, duration, told in (
        (COUNT, 21, 0.0, "0..20"),
        (COUNT, 2, 61.0, "0..60 s"),
        (HOLD, 0, -1.0, "0..60"),
    ):
        with pytest.raises(BadGoal, match=told):
            require_touch(kind, count, duration)


# --- goals of behaviours ----------------------------------------------------------------------------------------------


@pytest.fixture
def wave():
    """A behaviour whose goal was sent: its client, its goal, and what was said of its end."""
    client, ends = BehaviorClient(), []
    client._client = FakeActionClient(lambda goal: None)
    client.run("wave", (), lambda end, text: ends.append(end))
    (goal,) = client._client.goals
    return SimpleNamespace(client=client, goal=goal, ends=ends)


def test_a_behaviour_is_cancelled_when_its_server_has_told_of_it(wave, monkeypatch):
    wait = GoalTracker.cancel

    def cancel(watch, handle, limit):
        wave.goal.tell(GoalStatus.ACTIVE)  # the server is later than the end of this one
        return wait(watch, handle, limit)

    monkeypatch.setattr(GoalTracker, "cancel", cancel)
    wave.client.close()
    assert wave.goal.cancelled == [CommState.ACTIVE]


def test_a_behaviour_that_ends_just_before_it_is_cancelled_is_not(wave):
    wave.goal.tell(GoalStatus.ACTIVE)
    wave.goal.just_before_the_cancel(lambda: wave.goal.end(GoalStatus.SUCCEEDED))
    wave.client.close()
    assert (wave.goal.cancelled, wave.ends) == ([], ["succeeded"])
