"""What the robot notices of its surroundings: walls, boxes, fingers, things that fall on it."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.sensors.sonar import NO_ECHO
from nao_sim_bridge.sim.walk.gait import feet_gait

RAMP = "{name: ramp, box: [0.3, 1.0, 0.02], position: [0.27, 0, 0.018], rpy: [0, -0.2, 0], friction: 0}"
BUMPERS = {f"{side}Foot/Bumper/{half}" for side in "LR" for half in ("Left", "Right")}


def cart(y, width):
    """Slides down the ramp against the toes, in m left of the middle."""
    return (
        f"{{name: cart, box: [0.05, {width}, 0.05], position: [0.2, {y}, 0.06], rpy: [0, -0.2, 0], mass: 0.6, "
        "friction: 0}"
    )


@pytest.mark.parametrize(
    "y, width, pressed",
    [
        (0.0, 0.4, BUMPERS),
        (0.09, 0.02, {"LFoot/Bumper/Left", "LFoot/Bumper/Right"}),
        (-0.05, 0.02, {"RFoot/Bumper/Left"}),
        (0.3, 0.05, set()),
    ],
)
def test_bumpers_feel_what_is_in_front_of_them(bench, world_file, y, width, pressed):
    one = bench(world=world_file(RAMP, cart(y, width)))
    assert not one.run(0.05).touched
    assert one.run(1.0).touched == pressed


def test_a_bumper_is_released_when_the_box_is_gone(bench, world_file):
    one = bench(world=world_file(RAMP, cart(0.0, 0.4)))
    assert one.run(1.0).touched == BUMPERS
    one.simulation.reset()
    assert one.now.touched == frozenset()


def test_a_ball_on_the_head_is_felt_where_it_lies(bench, world_file):
    one = bench(world=world_file("{name: ball, sphere: 0.02, position: [0, 0, 0.55], mass: 0.05}"))
    felt = set().union(*(snapshot.touched for snapshot in one.watch(0.6)))
    assert felt and felt <= {f"Head/Touch/{place}" for place in ("Front", "Middle", "Rear")}


def test_fingers_stay_until_they_are_taken_away(bench):
    one = bench()
    one.robot.press(["Head/Touch/Front", "RHand/Touch/Back"])
    assert one.run(0.2).touched == {"Head/Touch/Front", "RHand/Touch/Back"}
    one.robot.press(["ChestBoard/Button"])
    assert one.simulation.tick().touched == {"ChestBoard/Button"}
    one.robot.press([])
    assert one.simulation.tick().touched == frozenset()


# --- sonar ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("distance", [0.25, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 2.5])
def test_both_sonars_measure_the_distance_of_a_wall(bench, world_file, distance):
    one = bench(world=world_file(f"{{name: wall, box: [0.1, 4, 2], position: [{distance + 0.05}, 0, 1]}}"))
    sonar = one.model.sonars[0].position[0] + one.run(0.2).torso.position[0]
    assert one.now.sonars == pytest.approx((distance - sonar,) * 2, abs=0.003)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("distance", [0.3, 0.5, 1.0, 1.5, 2.0, 2.5])
def test_a_slanting_wall_is_heard_by_the_sonar_that_it_faces(bench, world_file, distance, side):
    """Turned by 30 degrees, `distance` from the origin; the other sonar gets nothing back from this mirror."""
    turn = side * math.pi / 6.0
    x, y = ((distance + 0.05) * f(turn) for f in (math.cos, math.sin))
    one = bench(world=world_file(f"{{name: wall, box: [0.1, 8, 2], position: [{x}, {y}, 1], rpy: [0, 0, {turn}]}}"))
    near, far = one.run(0.2).sonars[:: int(side)]
    place = one.model.sonars[0 if side > 0.0 else 1].position + one.now.torso.position
    assert near == pytest.approx(distance - (place[0] * math.cos(turn) + place[1] * math.sin(turn)), abs=0.003)
    assert far == NO_ECHO


@pytest.mark.parametrize("world", ["empty", "uneven"])
@pytest.mark.parametrize("posture", ["Stand", "StandInit", "Crouch", "Sit"])
def test_no_floor_is_heard_by_a_robot_that_is_not_lying(bench, posture, world):
    assert bench(posture, world=world).run(0.5).sonars == (NO_ECHO, NO_ECHO)


def test_a_robot_on_its_belly_hears_the_floor(bench):
    assert max(bench("LyingBelly").run(0.5).sonars) < 0.3


def test_a_walking_robot_hears_no_floor(bench):
    one = bench("StandInit")
    one.run(0.3)
    one.robot.locomotion.move(0.06, 0.0, 0.0, feet_gait({}))
    assert {snapshot.sonars for snapshot in one.watch(3.0)} == {(NO_ECHO, NO_ECHO)}


@pytest.mark.parametrize(
    "what, distance, gap",
    [
        ("{name: p, person: anna, position: [1.5, 0, 0], heading: 3.14}", 1.5, 0.25),
        ("{name: p, person: ben, position: [2.2, 0, 0], heading: 3.14}", 2.2, 0.25),
        ("{name: n, nao: Stand, position: [1.0, 0, 0], heading: 3.14}", 1.0, 0.15),
        ("{name: box, box: [0.2, 0.3, 0.3], position: [0.7, 0, 0.15]}", 0.7, 0.12),
        ("{name: pole, cylinder: [0.03, 1.0], position: [0.8, 0, 0.5]}", 0.8, 0.04),
    ],
)
def test_people_robots_and_things_are_heard(bench, world_file, what, distance, gap):
    sonars = bench(world=world_file(what)).run(0.2).sonars
    assert all(distance - gap <= echo <= distance for echo in sonars), sonars


def test_a_ball_on_the_floor_is_too_low_to_be_heard(bench, world_file):
    path = world_file("{name: ball, ball: 0.03, position: [0.4, 0, 0.03]}")
    assert bench(world=path).run(0.2).sonars == (NO_ECHO, NO_ECHO)


@pytest.mark.parametrize("side, y", [("left", 0.3), ("right", -0.3)])
def test_a_post_beside_the_way_is_heard_on_its_side_only(bench, world_file, side, y):
    path = world_file(f"{{name: post, cylinder: [0.05, 1.0], position: [0.5, {y}, 0.5]}}")
    alone, beside = bench().run(0.2).sonars, bench(world=path).run(0.2).sonars
    near, far = (0, 1) if side == "left" else (1, 0)
    assert beside[near] == pytest.approx(0.53, abs=0.05)
    assert beside[near] < alone[near] - 0.2
    assert beside[far] == pytest.approx(alone[far], abs=0.01)


def test_a_box_behind_it_is_not_heard(bench, world_file):
    path = world_file("{name: box, box: [0.2, 0.4, 0.8], position: [-0.4, 0, 0.4]}")
    assert bench(world=path).run(0.2).sonars == bench().run(0.2).sonars


def test_the_robot_does_not_hear_its_own_arm(bench):
    one = bench()
    before = one.run(0.2).sonars
    one.aim(3.0, LShoulderPitch=0.6, LElbowRoll=-1.5, LElbowYaw=-1.2)
    after = one.run(1.2).sonars
    assert min(after) >= min(before) - 0.05


def test_foot_loads_are_about_the_totals_of_the_foot_sensors(bench):
    one = bench("StandInit")
    one.run(0.5)
    left, right = one.now.foot_loads
    assert left == pytest.approx(one.now.left_foot.total, rel=0.01)
    assert right == pytest.approx(one.now.right_foot.total, rel=0.01)
    assert left + right == pytest.approx(one.model.total_mass * 9.81, rel=0.05)
