"""Several robots in one world: they see, hear and touch each other, time is one, and each has its own ground."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nao_sim_bridge.sim.errors import NotAllowed
from nao_sim_bridge.sim.places import on_circle, parse_places
from nao_sim_bridge.sim.render.scene import Camera, preset_camera
from nao_sim_bridge.sim.scene import Scene
from nao_sim_bridge.sim.shared_world import SharedWorld
from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.sound.samples import RATE, Sound
from nao_sim_bridge.sim.world_objects import read_object

FACE_TO_FACE = "0,0,0; 0.6,0,180"
SPEED_OF_SOUND = 343.0


@pytest.fixture
def company():
    """Makes robots in one world, limp in a posture; the first one's `run` lets time pass for all."""
    worlds = []

    def make(places=None, stiffness=1.0, **scene):
        start = Scene(**{"posture": "Stand", **scene})
        worlds.append(SharedWorld(start))
        where = parse_places(places) if places else on_circle(3)
        robots = [
            Simulation(replace(start, seed=start.seed + number), shared=worlds[-1], place=place)
            for number, place in enumerate(where)
        ]
        for one in robots:
            one.robot.joints.set_stiffness(dict.fromkeys(range(len(one.model.joints)), stiffness))
        return robots

    yield make
    for world in worlds:
        world.close()


def burst(seed=1, seconds=0.1):
    return Sound(np.random.default_rng(seed).normal(0.0, 0.2, round(seconds * RATE)).astype(np.float32))


def place(one, **entry):
    one.things.place(read_object(entry, "entry", Path))


def heard(one, sound, since):
    """When each microphone hears the beginning of a sound after a time, s, and how loud it is, RMS."""
    record = one.sound.microphones.heard(since, one.time)
    wanted = sound.samples[:, 0]
    starts = [int(np.argmax(np.correlate(record[:, i], wanted, "valid"))) for i in range(4)]
    loud = [float(np.sqrt(np.mean(record[s : s + len(wanted), i] ** 2))) for i, s in enumerate(starts)]
    return np.array(starts) / RATE, np.array(loud)


# --- places and time


def test_robots_stand_on_a_circle_and_look_at_its_middle(company):
    robots = company()
    robots[0].run(1.0)
    for one in robots:
        x, y, height = one.snapshot.torso.position
        assert math.hypot(x, y) == pytest.approx(1.0, abs=0.02) and height > 0.32
        ahead = one.snapshot.velocity_in_torso  # at rest
        assert max(map(abs, ahead)) < 0.01
        cosine = -(x * math.cos(yaw_of(one)) + y * math.sin(yaw_of(one)))
        assert cosine == pytest.approx(1.0, abs=0.02)


def yaw_of(one):
    x, y, z, w = one.snapshot.torso.orientation
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def test_each_robot_reckons_from_its_own_start(company):
    robots = company()
    robots[0].run(0.5)
    for one in robots:
        assert one.snapshot.imu.angles[2] == pytest.approx(0.0, abs=0.01)
        assert one.snapshot.odometry.position[:2] == pytest.approx((0.0, 0.0), abs=0.02)


def test_time_and_task_numbers_are_one(company):
    robots = company()
    robots[1].run(0.25)
    assert {(one.ticks, one.time, one.snapshot.tick) for one in robots} == {(30, 0.25, 30)}
    numbers = [one.task_ids.make("x").task_id for one in robots]
    assert len(set(numbers)) == len(robots)


def test_the_same_seed_is_the_same_run_and_each_robot_has_noise_of_its_own(company):
    def run():
        robots = company(sensor_noise=1.0, seed=5)
        robots[0].robot.push((30.0, 10.0, 0.0), 0.1)
        robots[0].sound.loudspeakers.play(burst(), "burst")
        robots[0].run(0.5)
        sensed = [(one.snapshot.positions, one.snapshot.torso, one.snapshot.imu) for one in robots]
        return sensed, [one.sound.microphones.heard(0.2, 0.4).tobytes() for one in robots]

    first, second = run(), run()
    assert first == second
    assert len({repr(positions) for positions, _, _ in first[0]}) == 3
    assert len(set(first[1])) == 3


def test_a_robot_that_is_alone_does_not_notice_that_it_could_have_company(company):
    (one,) = company("0,0,0")
    alone = Simulation(Scene(posture="Stand"))
    try:
        alone.robot.joints.set_stiffness(dict.fromkeys(range(len(alone.model.joints)), 1.0))
        for simulation in (one, alone):
            simulation.robot.push((25.0, 5.0, 0.0), 0.2)
            simulation.run(1.0)
        assert one.snapshot == alone.snapshot
    finally:
        alone.close()


# --- touching


def test_what_one_robot_does_leaves_the_others_alone(company):
    robots = company()
    robots[0].run(0.2)
    before = [one.snapshot.torso.position for one in robots]
    robots[1].robot.push((0.0, -80.0, 0.0), 0.2)  # away from the others
    robots[0].run(0.8)
    moved = [math.dist(was, one.snapshot.torso.position) for was, one in zip(before, robots)]
    assert moved[1] > 0.1 and max(moved[0], moved[2]) < 0.02


def test_they_push_each_other_with_equal_forces_until_one_falls(company):
    standing, coming = company("0,0,0; 0.38,0,180")
    body = lambda one: [c for c in one.snapshot.contacts if "ankle" not in one.robot.link_name(c.link)]  # noqa: E731
    coming.robot.push((-60.0, 0.0, 0.0), 0.5)
    for _ in range(240):
        standing.tick()
        if body(standing):
            break
    felt, given = body(standing), body(coming)
    assert sum(c.force for c in felt) == pytest.approx(sum(c.force for c in given)) and felt[0].force > 1.0
    assert np.dot(felt[0].normal, given[0].normal) == pytest.approx(-1.0)
    assert felt[0].normal[0] < 0.0, "towards the robot that stands: away from the one that comes"
    assert standing.run(1.5).torso.position[2] < 0.25


def test_a_foot_of_another_robot_presses_a_bumper(company):
    walls, feet = company("0,0,0; 0.36,-0.1,180")
    assert not walls.snapshot.touched
    feet.robot.push((-45.0, 0.0, 0.0), 1.0, "l_ankle")
    feet.robot.push((-45.0, 0.0, 0.0), 1.0, "r_ankle")
    for _ in range(120):
        walls.tick()
        pressed = {name for name in walls.snapshot.touched if "Bumper" in name}
        if pressed:
            break
    assert pressed and all(name.startswith("RFoot") for name in pressed), "the other one stands to its right"


def test_sonars_hear_another_robot(company):
    one, other = company(FACE_TO_FACE)
    one.run(1.0)
    for robot in (one, other):
        assert robot.snapshot.sonars == pytest.approx((0.54, 0.54), abs=0.03)


# --- things


def test_things_are_everybodys(company):
    robots = company()
    place(robots[0], name="b", ball=0.04, position=[0.0, 0.0, 0.04])
    assert all("b" in one.snapshot.objects for one in robots), "also while time stands still"
    robots[2].things.move("b", (0.2, 0.1, 0.04), None)
    robots[1].run(0.1)
    assert {one.snapshot.objects["b"].position for one in robots} == {robots[0].snapshot.objects["b"].position}


def test_nothing_is_placed_inside_any_robot(company):
    robots = company()
    for one in robots:
        x, y, _ = one.snapshot.torso.position
        with pytest.raises(NotAllowed, match="inside the robot"):
            place(robots[0], name="b", ball=0.05, position=[x, y, 0.33])
    assert robots[0].things.placed == ()


# --- seeing


def test_each_robot_sees_what_the_others_look_like_now(company):
    robots = company()
    robots[1].robot.leds.set({0: 0.25})
    robots[2].robot.push((0.0, 40.0, 0.0), 0.2)
    robots[0].run(0.3)
    seen = robots[0].render_state(robots[0].snapshot).others
    assert [look.base_position for look in seen] == [one.snapshot.torso.position for one in robots[1:]]
    assert [look.joint_positions for look in seen] == [one.snapshot.positions for one in robots[1:]]
    assert seen[0].led_values[0] == 0.25 and seen[0].led_values == robots[1].robot.leds.values
    own = robots[1].render_state(robots[1].snapshot)
    assert (own.base_position, own.led_values) == (seen[0].base_position, seen[0].led_values)


# --- hearing


def test_a_voice_arrives_with_distance_delay_and_direction(company):
    speaker, near, far = company("0,0,0; 0,1,-90; 0,-3,90")
    speaker.run(0.5)
    began, sound = speaker.time, burst()
    speaker.sound.loudspeakers.play(sound, "burst")
    speaker.run(0.3)
    delays, levels = zip(*(heard(one, sound, began) for one in (near, far)))
    assert delays[0] * SPEED_OF_SOUND == pytest.approx([1.02] * 4, abs=0.03)
    assert (delays[1] - delays[0]).mean() * SPEED_OF_SOUND == pytest.approx(2.0, abs=0.02)
    assert levels[0].mean() / levels[1].mean() == pytest.approx(3.0, rel=0.03)
    left, right, front, rear = delays[0]
    assert left == right and front < left, "the speaker is ahead"


def test_the_direction_follows_the_head(company):
    speaker, listener = company("0,0,0; 1,0,180")
    joints = listener.robot.joints
    yaw = listener.model.joint_index["HeadYaw"]
    for _ in range(240):
        joints.step({yaw: 1.2}, listener.settings.tick_s)
        listener.tick()
    began, sound = speaker.time, burst()
    speaker.sound.loudspeakers.play(sound, "burst")
    speaker.run(0.3)
    left, right, _, _ = heard(listener, sound, began)[0]
    assert right < left, "the head looks to the left, so the speaker is to its right"


def test_what_the_ears_hear_is_the_same_whenever_they_hear_it(company):
    speaker, listener = company(FACE_TO_FACE)
    blocks = []
    ears = listener.sound.ears.listen("test", lambda block: blocks.append(block.samples), exact=True)
    speaker.sound.loudspeakers.play(burst(seconds=0.4), "burst")
    listener.robot.push((0.0, 30.0, 0.0), 0.3)
    listener.run(1.0)
    end = listener.time
    ears.close()
    at_once = np.concatenate(blocks)
    later = listener.sound.microphones.heard(0.0, end)
    assert np.abs(at_once / 32768.0 - later).max() < 2.0 / 32768.0
    assert np.abs(later).max() > 0.01


def test_sounds_of_the_world_are_everybodys_and_voices_are_not_sounds_of_the_world(company):
    robots = company()
    assert robots[0].sound.sources is robots[2].sound.sources
    robots[0].sound.loudspeakers.play(burst(), "burst")
    assert robots[1].sound.sources.names() == [] and not robots[1].sound.loudspeakers.playing


# --- starting again


def test_a_reset_puts_all_back_and_kills_what_runs(company):
    robots = company()
    place(robots[0], name="b", ball=0.04, position=[0.0, 0.0, 0.04])
    playing = [one.sound.loudspeakers.play(burst(), "burst") for one in robots]
    robots[1].robot.push((0.0, 80.0, 0.0), 0.3)
    again = []
    for one in robots:
        one.after_reset.append(lambda one=one: again.append(one))
    starts = [(round(math.cos(a), 3), round(math.sin(a), 3)) for a in (math.pi, -math.pi / 3, math.pi / 3)]
    robots[0].run(1.0)
    robots[2].reset()
    assert again == robots and robots[0].time == 1.0
    assert all(sound.ended for sound in playing)
    for one, start in zip(robots, starts):
        assert one.snapshot.torso.position[:2] == pytest.approx(start, abs=0.03)
        assert "b" not in one.snapshot.objects


def test_a_reboot_puts_one_back_and_leaves_the_rest(company):
    robots = company()
    place(robots[0], name="b", ball=0.04, position=[0.0, 0.0, 0.04])
    for one in robots:
        one.robot.push((0.0, 90.0, 0.0), 0.3)
    robots[0].run(1.0)
    fallen = [one.snapshot.torso for one in robots]
    playing = [one.sound.loudspeakers.play(burst(), "burst") for one in robots]
    again = []
    for one in robots:
        one.after_reset.append(lambda one=one: again.append(one))
    robots[1].reboot()
    assert again == [robots[1]] and [sound.ended for sound in playing] == [False, True, False]
    assert robots[1].snapshot.torso.position[:2] == pytest.approx((0.5, -math.sqrt(0.75)), abs=0.03)
    assert (robots[0].snapshot.torso, robots[2].snapshot.torso) == (fallen[0], fallen[2])
    assert "b" in robots[1].snapshot.objects
    stood = robots[1].run(0.5)
    assert stood.stiffnesses == (0.0,) * 26 and stood.odometry.position[:2] == pytest.approx((0.0, 0.0), abs=0.1)


def test_a_reboot_of_one_that_is_alone_is_a_reset(company):
    (one,) = company("0,0,0")
    place(one, name="b", ball=0.04, position=[0.5, 0.0, 0.04])
    one.run(0.2)
    one.reboot()
    assert one.snapshot.objects == {} and one.time == pytest.approx(0.2)


def test_time_waits_for_each_of_them(company):
    robots = company()
    assert not robots[0].shared.holds()
    robots[2].holds.append(lambda: True)
    assert robots[0].shared.holds()
    called = []
    robots[0].shared.wake = lambda: called.append(True)
    robots[1].wake()
    assert called == [True]


@pytest.mark.parametrize("places", [FACE_TO_FACE, "3,1,0; -2,1,0; 0,5,0"])
def test_one_view_has_all_robots_in_it(company, places):
    robots = company(places)
    camera = preset_camera("robots", robots[0].model, robots[0].render_state(robots[0].snapshot), 640, 480)
    eye = np.array(camera.eye)
    ahead = np.array(camera.target) - eye
    ahead /= np.linalg.norm(ahead)
    for one in robots:
        way = np.array(one.snapshot.torso.position) - eye
        angle = math.acos(np.dot(way, ahead) / np.linalg.norm(way))
        assert angle < camera.fov / 2.0


def test_a_picture_shows_another_robot_where_it_is(company):
    looks, other = company("0,0,0; 0.8,0.25,180")
    looks.run(0.1)
    state = looks.render_state(looks.snapshot)
    camera = Camera(eye=(0.1, 0.0, 0.45), target=(1.0, 0.0, 0.35), width=160, height=120, fov=math.radians(50.0))
    with_other = looks.renderer.render(state, camera, 60.0).astype(int)
    without = looks.renderer.render(replace(state, others=()), camera, 60.0).astype(int)
    columns = np.flatnonzero(np.abs(with_other - without).max(axis=(0, 2)) > 60)
    assert len(columns) > 10 and columns.max() < 80, "to the left of the middle"


def test_a_robot_whose_place_is_taken_reboots_beside_it(company):
    one, other = company("0,0,0; 1,0,0")
    place(one, name="post", box=[0.1, 0.1, 0.6], position=[0.35, 0.0, 0.3])  # in the way to the next place, too
    other._physics.place(other.snapshot.positions, 0.0, (0.05, 0.0))  # as if it had walked there
    one._physics.place(one.snapshot.positions, 0.0, (2.0, 0.0))
    one.reboot()
    assert one.inside() == other.inside() == {}
    x, y, _ = one.snapshot.torso.position
    assert 0.3 < math.hypot(x, y) < 0.8
    before = one.run(0.1), other.snapshot
    one.run(0.5)
    for was, robot in zip(before, (one, other)):
        assert math.dist(was.torso.position, robot.snapshot.torso.position) < 0.05, "nobody is hurled away"


def test_what_a_robot_is_inside_is_told(company):
    free, there = company("0,0,0; 1,0,180", world="lab")
    assert free.inside() == {}
    assert list(there.inside()) == ["table"] and there.inside()["table"] > 0.01
