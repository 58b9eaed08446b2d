"""Simulated hands: they are felt where they touch, wherever the robot goes, and leave it standing."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.errors import BadValue, NotAllowed, SimulationError, UnknownName
from nao_sim_bridge.sim.hand_path import AWAY, HandPath
from nao_sim_bridge.sim.hands import COME_TIME, LEAVE_TIME, PATIENCE
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.touch_gestures import GestureBook, GestureRecogniser, Times
from nao_sim_bridge.sim.touch_names import CHEST_BUTTON, EVENTS, HEAD, SENSORS, sensor_of

ALL = (*SENSORS, CHEST_BUTTON)
BOTH_WAYS = COME_TIME + LEAVE_TIME
FEET = ("l_ankle", "r_ankle")


def touch(one, sensors, duration, limit=3.0):
    """Touch, and the snapshots until the hand has gone."""
    task = one.simulation.hands.touch(sensors, duration)
    seen = []
    while not task.finished and len(seen) < limit * 120:
        seen.append(one.simulation.tick())
    assert task.result(0) is None and not task.killed
    return seen


def gestures(seen):
    """Gestures that the head feels."""
    recogniser = GestureRecogniser(GestureBook(), Times())
    told = []
    for snapshot in seen:
        pattern = "".join("1" if sensor in snapshot.touched else "0" for sensor in HEAD)
        told.append(recogniser.feed(pattern, snapshot.time).gesture)
    return [name for name in told if name]


def tilt(snapshot):
    return math.hypot(*snapshot.imu.angles[:2])


@pytest.mark.parametrize("posture, stiffness", [("Stand", 1.0), ("Stand", 0.0), ("Crouch", 1.0)])
def test_each_sensor_feels_a_hand_and_the_robot_keeps_still(bench, posture, stiffness):
    one = bench(posture, stiffness)
    start = one.run(0.3)
    for name in ALL:
        seen = touch(one, [name], 0.3)
        felt = [snapshot for snapshot in seen if name in snapshot.touched]
        assert felt[0].time - seen[0].time == pytest.approx(COME_TIME, abs=0.05), name
        assert felt[-1].time - felt[0].time == pytest.approx(0.3, abs=0.05), name
        # A finger between two sensors of one part may touch both.
        beside = {other for snapshot in seen for other in snapshot.touched} - {name}
        assert {other.rsplit("/", 1)[0] for other in beside} <= {name.rsplit("/", 1)[0]}, name
        pressed = [c.force for s in seen for c in s.contacts if one.robot.link_name(c.link) not in FEET]
        assert max(pressed, default=0.0) < 8.0, name
    assert tilt(one.now) == pytest.approx(tilt(start), abs=0.02)
    assert math.dist(start.torso.position, one.now.torso.position) < 0.005
    assert "hand" not in one.now.objects and one.now.placed == ()


def test_a_hand_stays_until_it_is_released(bench):
    one = bench()
    task = one.simulation.hands.touch(["MiddleTactilTouched"], 0.0)
    one.run(0.5)
    assert task.finished and HEAD[1] in one.run(2.0).touched
    one.simulation.hands.release([HEAD[1]])
    assert not one.run(LEAVE_TIME + 0.02).touched
    assert one.now.placed == ()


def test_a_hand_is_seen_where_it_is(bench):
    one = bench()
    one.simulation.hands.touch([HEAD[1]], 0.0)
    one.simulation.tick()
    (hand,) = one.now.placed
    assert hand.name == "hand" and "hand" in one.simulation.render_state(one.now).objects
    far = one.now.objects["hand"].position[2]
    assert far - one.run(0.5).objects["hand"].position[2] == pytest.approx(AWAY, abs=0.03)


def test_a_hand_goes_with_a_robot_that_moves(bench):
    one = bench()
    one.run(0.2)
    one.simulation.hands.touch(["Head/Touch/Front"], 0.0)
    one.run(0.5)
    one.aim(0.8, HeadYaw=0.7, HeadPitch=0.2)
    felt = [HEAD[0] in snapshot.touched for snapshot in one.watch(1.5)]
    assert sum(felt) > 0.98 * len(felt)


@pytest.mark.parametrize("duration", [0.3, 0.5, 0.8, 1.2])
@pytest.mark.parametrize("sensors, gesture", [(HEAD, "CaressFtoR"), (HEAD[::-1], "CaressRtoF")])
def test_a_stroke_over_the_head_is_a_caress(bench, sensors, gesture, duration):
    one = bench()
    one.run(0.2)
    assert gestures([*touch(one, sensors, duration), *one.watch(0.3)]) == [gesture]


def test_several_hands_touch_at_once(bench):
    one = bench()
    for sensor in (HEAD[0], HEAD[2], CHEST_BUTTON):
        one.simulation.hands.touch([sensor], 0.0)
    assert one.run(0.6).touched == {HEAD[0], HEAD[2], CHEST_BUTTON}
    assert set(one.now.objects) == {"hand", "hand_2", "hand_3"}
    one.simulation.hands.release()
    assert one.run(0.3).touched == frozenset()


def test_hands_pass_through_what_is_in_their_way(bench, world_file):
    """A shelf over the head does not keep them away, and they do not push it."""
    path = world_file("{name: box, box: [0.2, 0.2, 0.03], position: [0.35, 0, 0.42]}")
    one = bench(world=path)
    seen = touch(one, [CHEST_BUTTON], 0.2)
    assert any(CHEST_BUTTON in snapshot.touched for snapshot in seen)


def test_a_hand_that_is_not_felt_says_so(bench):
    one = bench()
    one.robot.faults.break_device(HEAD[0]) if hasattr(one.robot, "faults") else pytest.skip("nothing breaks")
    task = one.simulation.hands.touch([HEAD[0]], 0.2)
    one.run(COME_TIME + PATIENCE + 0.1)
    with pytest.raises(SimulationError, match="the hand is not felt at Head/Touch/Front"):
        task.result(0)
    one.run(LEAVE_TIME + 0.1)
    assert one.now.placed == ()


def test_a_touch_that_is_killed_sends_the_hand_away(bench):
    one = bench()
    task = one.simulation.hands.touch([HEAD[0]], 5.0)
    assert HEAD[0] in one.run(0.5).touched
    task.kill()
    assert not one.run(0.3).touched and one.now.placed == ()


def test_a_reset_takes_hands_away(bench):
    one = bench()
    task = one.simulation.hands.touch([HEAD[0]], 5.0)
    one.run(0.5)
    one.simulation.reset()
    assert task.killed and one.run(0.5).touched == frozenset() and one.now.placed == ()
    assert touch(one, [HEAD[0]], 0.1)


def test_somebody_may_remove_a_hand_like_a_thing(bench):
    one = bench()
    task = one.simulation.hands.touch([HEAD[0]], 5.0)
    one.run(0.5)
    one.simulation.things.remove("hand")
    assert one.run(0.1).touched == frozenset() and task.killed
    one.simulation.hands.release()
    assert touch(one, [HEAD[0]], 0.1)


def test_touches_are_the_same_in_every_run(bench):
    def run():
        one = bench()
        touch(one, HEAD, 0.4)
        return one.now.positions, one.now.torso

    assert run() == run()


# --- names and errors -------------------------------------------------------------------------------------------------


def test_events_stand_for_their_sensors():
    assert sensor_of("Head/Touch/Rear") == "Head/Touch/Rear"
    assert {
        event: sensor_of(event) for event in ("RightBumperPressed", "ChestButtonPressed", "HandLeftBackTouched")
    } == {
        "RightBumperPressed": "RFoot/Bumper/Right",
        "ChestButtonPressed": CHEST_BUTTON,
        "HandLeftBackTouched": "LHand/Touch/Back",
    }
    assert {sensor for sensors in EVENTS.values() for sensor in sensors} == set(ALL)


@pytest.mark.parametrize("name", ALL)
def test_a_hand_comes_from_outside(name):
    path = HandPath(load_model(), [name])
    (near, _), (far, _) = path.at(0.0, 0.0), path.at(0.0, AWAY)
    # Further from the middle of the part than the sensor.
    assert math.dist(far, near) == pytest.approx(AWAY)
    assert math.hypot(*far) > math.hypot(*near)


@pytest.mark.parametrize(
    "sensors, duration, error, text",
    [
        (["Head/Touch/Fron"], 1.0, UnknownName, "did you mean 'Head/Touch/Front'"),
        ([], 1.0, BadValue, "number of sensors is 0, allowed is 1 to 8"),
        ([HEAD[0], CHEST_BUTTON], 1.0, BadValue, "sensors of one part of the robot"),
        (HEAD, 0.0, BadValue, "duration is 0.0, allowed is above 0 for a stroke"),
        ([HEAD[0]], -1.0, BadValue, "duration is -1.0"),
        ([HEAD[0]], math.nan, BadValue, "duration is nan"),
    ],
)
def test_what_no_hand_can_do_is_refused(bench, sensors, duration, error, text):
    one = bench()
    with pytest.raises(error, match=text):
        one.simulation.hands.touch(sensors, duration)
    assert one.simulation.tick().placed == ()


def test_a_sensor_is_touched_by_one_hand_at_a_time(bench):
    one = bench()
    one.simulation.hands.touch([HEAD[0]], 0.0)
    with pytest.raises(NotAllowed, match="a hand touches Head/Touch/Front already: release it first"):
        one.simulation.hands.touch(HEAD, 1.0)
