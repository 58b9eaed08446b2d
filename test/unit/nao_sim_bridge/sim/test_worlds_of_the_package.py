"""The worlds that come with the package: the robot starts on its feet in each, and things are where they should be."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pybullet
import pytest
import yaml

from nao_sim_bridge.sim.rotations import rotate
from nao_sim_bridge.sim.world import load_world, world_names
from nao_sim_bridge.sim.world_cards import CARDS
from nao_sim_bridge.sim.world_reader import read_world

ROOT = Path(__file__).parents[4]
WORLDS = world_names()


@pytest.fixture
def standing(bench):
    """Makes simulations of a robot that stands by its stiffness alone."""

    def make(world, **scene):
        one = bench(world=world, **scene)
        one.robot.stability.balance.enabled = False
        return one

    return make


def edges(name, world="lab"):
    """Corners of an upright object that is turned by no or little, as it stands: lowest and highest x, y, z in m."""
    (thing,) = [thing for thing in load_world(world).objects if thing.name == name]
    reach = [
        [(p + s - e / 2, p + s + e / 2) for p, s, e in zip(thing.position, part.shape.xyz, part.shape.size)]
        for part in thing.parts
        if part.shape.kind == "box"
    ]
    return [(min(low for low, _ in axis), max(high for _, high in axis)) for axis in zip(*reach)]


def test_the_worlds_that_there_are():
    assert set(WORLDS) == {"empty", "gallery", "lab", "obstacles", "party", "slope_3deg", "uneven", "wall"}
    assert all(load_world(name).description for name in WORLDS)


@pytest.mark.parametrize("world", WORLDS)
def test_the_robot_starts_on_both_feet_with_nothing_else_touching_it(standing, world):
    one = standing(world)
    ankles = {one.simulation.robot.link_name(contact.link) for contact in one.simulation.tick().contacts}
    assert ankles == {"l_ankle", "r_ankle"}
    start = one.now.torso.position
    end = one.run(2.0)
    weight = one.model.total_mass * 9.81
    assert end.left_foot.total + end.right_foot.total == pytest.approx(weight, rel=0.02)
    assert end.torso.position == pytest.approx(start, abs=8e-3)
    assert one.robot.stability.on_feet


@pytest.mark.parametrize("world", WORLDS)
def test_things_that_can_be_moved_lie_still(bench, world):
    one = bench(posture="Crouch", world=world)
    before = dict(one.run(1.0).objects)
    after = one.run(2.0).objects
    for name, pose in before.items():
        assert after[name].position == pytest.approx(pose.position, abs=1e-3), name


def test_on_the_slope_the_soles_lie_flat_and_the_torso_leans_with_it(standing):
    flat, sloping = standing("empty").run(0.1), standing("slope_3deg").run(0.1)
    slope = math.radians(3.0)
    assert sloping.imu.angles[1] == pytest.approx(flat.imu.angles[1] - slope, abs=6e-3)
    assert sloping.imu.angles[0] == pytest.approx(0.0, abs=2e-3)
    normal = load_world("slope_3deg").floor.normal
    for pose in sloping.link_poses.values():
        assert rotate(pose.orientation, (0.0, 0.0, 1.0)) == pytest.approx(normal, abs=3e-3)
    # The weight has moved towards the heels.
    shift = sloping.left_foot.center_of_pressure[0] - flat.left_foot.center_of_pressure[0]
    assert -0.025 < shift < -0.01


@pytest.mark.parametrize("posture", ["Sit", "LyingBack"])
def test_a_robot_that_is_not_on_its_feet_starts_on_the_slope_too(bench, posture):
    falls = []
    for world in ("empty", "slope_3deg"):
        one = bench(posture=posture, world=world)
        start = one.now.torso.position
        falls.append([after - before for before, after in zip(start, one.run(0.2).torso.position)])
    assert falls[1] == pytest.approx(falls[0], abs=4e-3)


def test_the_lab_is_a_room_of_5_by_4_metres_with_a_table_ahead():
    back, front, right = edges("wall_back"), edges("wall_front"), edges("wall_right")
    left = edges("wall_right_of_door")
    assert front[0][0] - back[0][1] == pytest.approx(5.0)
    assert left[1][0] - right[1][1] == pytest.approx(4.0)
    table = edges("table")
    assert table[0][0] == pytest.approx(0.6)
    assert table[1][0] < -0.4 and table[1][1] > 0.4
    door = edges("wall_left_of_door")[0][0] - edges("wall_right_of_door")[0][1]
    assert door == pytest.approx(0.8)


def test_the_ball_of_the_lab_rolls_and_comes_to_rest(bench):
    one = bench(posture="Crouch", world="lab")
    start = one.now.objects["ball"].position
    physics = one.simulation._physics  # the robot cannot reach the ball from where it starts
    pybullet.resetBaseVelocity(
        physics.bodies.ids["ball"], (0.6, -0.3, 0.0), (0.0, 0.0, 0.0), physicsClientId=physics.client
    )
    rolling = one.run(0.5).objects["ball"].position
    assert 0.1 < math.dist(rolling, start) < 1.0
    one.run(12.0)
    rest = one.now.objects["ball"].position
    assert math.dist(one.run(1.0).objects["ball"].position, rest) < 2e-3


def test_the_world_of_the_documents_can_be_read(tmp_path):
    (tmp_path / "music.ogg").touch()
    texts = re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "worlds.md").read_text(encoding="utf-8"), re.DOTALL)
    content = yaml.safe_load("".join(texts))
    world = read_world(content, "mine", "mine.yaml", tmp_path)
    assert [sound.name for sound in world.sounds] == ["anna", "radio", "hum", "knock"]
    assert [thing.name for thing in world.objects][:2] == ["ball", "chair"]
    assert {thing.kind for thing in world.objects} >= set(CARDS) - {"image"} | {"person", "nao", "ball"}
    assert len(world.floor.rugs) == 1 and len(world.floor.bumps) == 20


def test_nothing_in_the_lab_is_to_be_recognised_but_its_ball():
    things = load_world("lab").objects
    shown = {part.picture.kind for thing in things for part in thing.parts if part.picture is not None}
    assert shown == {"poster", "pattern"}
    assert not {thing.kind for thing in things} & {"person", "nao"}


def test_the_gallery_has_some_of_each_within_reach_of_the_eyes():
    things = load_world("gallery").objects
    kinds = [thing.kind for thing in things]
    for kind, count in (
        ("landmark", 3),
        ("face", 2),
        ("person", 4),
        ("qr", 1),
        ("barcode", 2),
        ("nao", 1),
        ("ball", 1),
    ):
        assert kinds.count(kind) == count, kind
    for thing in things:
        if thing.kind in ("landmark", "face", "qr", "barcode", "nao", "person"):
            x, y, _ = thing.position
            assert 0.5 < math.hypot(x, y) < 2.5
            assert abs(math.atan2(y, x)) < math.radians(119.0), f"the head cannot be turned to {thing.name}"
            towards_robot = math.atan2(-y, -x)
            off = (thing.rpy[2] - towards_robot + math.pi) % (2.0 * math.pi) - math.pi
            assert abs(off) < 0.1, f"{thing.name} does not face the robot"


def test_bumps_of_the_uneven_floor_are_3_to_8_mm_high():
    heights = [plate.size[2] for plate in load_world("uneven").floor.bumps]
    assert len(heights) >= 40
    assert 0.003 <= min(heights) < 0.004 and 0.007 < max(heights) <= 0.008


def test_a_way_leads_through_the_obstacles():
    """Straight ahead is blocked; a corridor of the robot's width and some more leads around, from point to point."""
    assert not clear([(0.0, 0.0), (3.0, 0.0)])
    assert clear([(0.0, 0.0), (0.5, -0.45), (1.0, -0.6), (1.2, -0.6), (1.5, -0.15), (2.8, 0.0)])


def clear(way, radius=0.17):
    """Whether a disc can go along a polyline without meeting an object of the obstacles that cannot be pushed."""
    things = [thing for thing in load_world("obstacles").objects if thing.mass == 0.0]
    steps = [
        (x0 + k / 50 * (x1 - x0), y0 + k / 50 * (y1 - y0))
        for (x0, y0), (x1, y1) in zip(way, way[1:])
        for k in range(51)
    ]
    return all(distance(thing, point) > radius for thing in things for point in steps)


def distance(thing, point):
    """From a point to an object of one upright box or cylinder (the first part), seen from above, m."""
    shape, yaw = thing.parts[0].shape, thing.rpy[2]
    dx, dy = point[0] - thing.position[0], point[1] - thing.position[1]
    if shape.kind == "cylinder":
        return math.hypot(dx, dy) - shape.size[0]
    along, across = dx * math.cos(yaw) + dy * math.sin(yaw), dy * math.cos(yaw) - dx * math.sin(yaw)
    return math.hypot(max(abs(along) - shape.size[0] / 2, 0.0), max(abs(across) - shape.size[1] / 2, 0.0))
