"""Several robots in one world: they see, hear and touch each other, time is one, and each has its own ground."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nao_sim_bridge.base.errors import NotAllowed
from nao_sim_bridge.base.rotations import roll_pitch_yaw
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.world.objects import read_object
from nao_sim_bridge.world.places import on_circle, parse_places

SPEED_OF_SOUND = 343.0
PUSHED_AWAY = (0.0, 90.0, 0.0), 0.3


@pytest.fixture
def company():
    """Makes stiff robots in one world; the first one's `run` lets time pass for all."""
    worlds = []

    def make(places=None, **scene):
        start = Scene(**{"posture": "Stand", **scene})
        worlds.append(SharedWorld(start))
        where = enumerate(parse_places(places) if places else on_circle(3))
        robots = [Simulation(replace(start, seed=start.seed + n), shared=worlds[-1], place=place) for n, place in where]
        for one in robots:
            one.robot.joints.set_stiffness(dict.fromkeys(range(26), 1.0))
        return robots

    yield make
    for world in worlds:
        world.close()


def burst(seconds=0.1):
    return Sound(np.random.default_rng(1).normal(0.0, 0.2, round(seconds * RATE)).astype(np.float32))


def place(one, **entry):
    one.things.place(read_object(entry, "entry", Path))


def heard(one, sound, since):
    """When each microphone hears the beginning of a sound after a time, s, and how loud it is, RMS."""
    record, wanted = one.sound.microphones.heard(since, one.time), sound.samples[:, 0]
    starts = [int(np.argmax(np.correlate(record[:, i], wanted, "valid"))) for i in range(4)]
    loud = [float(np.sqrt(np.mean(record[s : s + len(wanted), i] ** 2))) for i, s in enumerate(starts)]
    return np.array(starts) / RATE, np.array(loud)


def resets(robots):
    """The robots that have been reset, from now on."""
    again = []
    for one in robots:
        one.after_reset.append(lambda one=one: again.append(one))
    return again


def test_robots_stand_on_a_circle_look_at_its_middle_and_reckon_from_their_own_start(company):
    robots = company()
    robots[1].run(0.5)
    assert {(one.ticks, one.time, one.snapshot.tick) for one in robots} == {(60, 0.5, 60)}
    assert len({one.task_ids.make("x").task_id for one in robots}) == len(robots)
    for now in (one.snapshot for one in robots):
        x, y, height = now.torso.position
        yaw = roll_pitch_yaw(now.torso.orientation)[2]
        assert math.hypot(x, y) == pytest.approx(1.0, abs=0.02) and height > 0.32
        assert max(map(abs, now.velocity_in_torso)) < 0.01, "at rest"
        assert -(x * math.cos(yaw) + y * math.sin(yaw)) == pytest.approx(1.0, abs=0.02)
        assert now.imu.angles[2] == pytest.approx(0.0, abs=0.01)
        assert now.odometry.position[:2] == pytest.approx((0.0, 0.0), abs=0.02)


def test_they_push_each_other_with_equal_forces_until_one_falls(company):
    standing, coming, third = company("0,0,0; 0.38,0,180; -2,0,0")

    def body(one):
        return [c for c in one.snapshot.contacts if "ankle" not in one.robot.link_name(c.link)]

    before = third.snapshot.torso.position
    coming.robot.push((-60.0, 0.0, 0.0), 0.5)
    while not body(standing) and standing.time < 2.0:
        standing.tick()
    felt, given = body(standing), body(coming)
    assert sum(c.force for c in felt) == pytest.approx(sum(c.force for c in given)) and felt[0].force > 1.0
    assert np.dot(felt[0].normal, given[0].normal) == pytest.approx(-1.0)
    assert felt[0].normal[0] < 0.0, "towards the robot that stands: away from the one that comes"
    assert standing.run(1.5).torso.position[2] < 0.25
    assert math.dist(before, third.snapshot.torso.position) < 0.02, "who is far is left alone"


def test_things_are_everybodys_and_nothing_is_placed_inside_any_robot(company):
    robots = company()
    place(robots[0], name="b", ball=0.04, position=[0.0, 0.0, 0.04])
    assert all("b" in one.snapshot.objects for one in robots), "also while time stands still"
    robots[2].things.move("b", (0.2, 0.1, 0.04), None)
    robots[1].run(0.1)
    assert {one.snapshot.objects["b"].position for one in robots} == {robots[0].snapshot.objects["b"].position}
    for one in robots:
        x, y, _ = one.snapshot.torso.position
        with pytest.raises(NotAllowed, match="inside the robot"):
            place(robots[0], name="c", ball=0.05, position=[x, y, 0.33])
    free, there = company("0,0,0; 1,0,180", world="lab")
    assert free.inside() == {} and list(there.inside()) == ["table"] and there.inside()["table"] > 0.01


def test_each_robot_sees_what_the_others_look_like_now(company):
    robots = company()
    robots[1].robot.leds.set({0: 0.25})
    robots[2].robot.push((0.0, 40.0, 0.0), 0.2)
    robots[0].run(0.3)
    seen = robots[0].render_state().others
    assert [look.base_position for look in seen] == [one.snapshot.torso.position for one in robots[1:]]
    assert [look.joint_positions for look in seen] == [one.snapshot.positions for one in robots[1:]]
    assert seen[0].led_values[0] == 0.25 and seen[0].led_values == robots[1].robot.leds.values


def test_a_voice_arrives_with_distance_delay_and_the_direction_of_the_head(company):
    speaker, near, far, turned = company("0,0,0; 0,1,-90; 0,-3,90; 1,0,180")
    yaw = turned.model.joint_index["HeadYaw"]
    for _ in range(60):
        turned.robot.joints.step({yaw: 1.2}, turned.settings.tick_s)
        turned.tick()
    began, sound = speaker.time, burst()
    speaker.sound.loudspeakers.play(sound, "burst")
    speaker.run(0.3)
    (near_delays, near_levels), (far_delays, far_levels) = heard(near, sound, began), heard(far, sound, began)
    assert near_delays * SPEED_OF_SOUND == pytest.approx([1.02] * 4, abs=0.03)
    assert (far_delays - near_delays).mean() * SPEED_OF_SOUND == pytest.approx(2.0, abs=0.02)
    assert near_levels.mean() / far_levels.mean() == pytest.approx(3.0, rel=0.03)
    left, right, front, _ = near_delays
    assert left == right and front < left, "the speaker is ahead"
    left, right, _, _ = heard(turned, sound, began)[0]
    assert right < left, "the head looks to the left, so the speaker is to its right"


def test_a_reset_puts_all_back_and_kills_what_runs(company):
    robots = company()
    starts = [one.snapshot.torso.position[:2] for one in robots]
    place(robots[0], name="b", ball=0.04, position=[0.0, 0.0, 0.04])
    playing = [one.sound.loudspeakers.play(burst(), "burst") for one in robots]
    robots[1].robot.push(*PUSHED_AWAY)
    again = resets(robots)
    robots[0].run(1.0)
    robots[2].reset()
    assert again == robots and robots[0].time == 1.0 and all(sound.ended for sound in playing)
    for one, start in zip(robots, starts):
        assert one.snapshot.torso.position[:2] == pytest.approx(start, abs=0.03) and "b" not in one.snapshot.objects


def test_a_reboot_puts_one_back_and_leaves_the_rest(company):
    robots = company()
    start = robots[1].snapshot.torso.position[:2]
    place(robots[0], name="b", ball=0.04, position=[0.0, 0.0, 0.04])
    for one in robots:
        one.robot.push(*PUSHED_AWAY)
    robots[0].run(1.0)
    fallen = [one.snapshot.torso for one in robots]
    playing = [one.sound.loudspeakers.play(burst(), "burst") for one in robots]
    again = resets(robots)
    robots[1].reboot()
    assert again == [robots[1]] and [sound.ended for sound in playing] == [False, True, False]
    assert robots[1].snapshot.torso.position[:2] == pytest.approx(start, abs=0.03)
    assert (robots[0].snapshot.torso, robots[2].snapshot.torso) == (fallen[0], fallen[2])
    assert "b" in robots[1].snapshot.objects
    stood = robots[1].run(0.5)
    assert stood.stiffnesses == (0.0,) * 26 and stood.odometry.position[:2] == pytest.approx((0.0, 0.0), abs=0.1)


def test_a_robot_whose_place_is_taken_reboots_beside_it(company):
    one, other = company("0,0,0; 0.45,0,180")
    other.robot.push((-60.0, 0.0, 0.0), 0.6)  # falls over the one that stands, and takes its place
    one.robot.push((-90.0, 0.0, 0.0), 0.6)
    one.run(2.0)
    place(one, name="post", box=[0.1, 0.1, 0.6], position=[0.0, 0.0, 0.3])
    one.reboot()
    assert one.inside() == {}
    x, y, _ = one.snapshot.torso.position
    assert 0.2 < math.hypot(x, y) < 0.9
