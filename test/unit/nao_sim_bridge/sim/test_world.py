"""Worlds are read strictly and built alike for touching and for seeing."""

from __future__ import annotations

import math
from dataclasses import replace

import pybullet
import pytest

from nao_sim_bridge.sim.rotations import roll_pitch_yaw, rotate
from nao_sim_bridge.sim.world import WorldError, load_world, world_names
from nao_sim_bridge.sim.world_builder import build_world
from nao_sim_bridge.sim.world_reader import read_world

BALL = {"name": "ball", "sphere": 0.04, "position": [0.5, 0.0, 0.2], "mass": 0.1, "color": [1, 0, 0]}
TABLE = {"name": "table", "box": [0.4, 0.6, 0.3], "position": [1.0, 0.0, 0.15], "friction": 0.9}
CHAIR = {
    "name": "chair",
    "position": [2.0, 1.0, 0.0],
    "color": [0, 0, 1],
    "parts": [
        {"box": [0.4, 0.4, 0.02], "xyz": [0, 0, 0.3]},
        {"box": [0.02, 0.4, 0.3], "xyz": [-0.19, 0, 0.46], "color": [1, 0, 0]},
        {"cylinder": [0.02, 0.29], "xyz": [0.15, 0.15, 0.145]},
        {"cylinder": [0.02, 0.29], "xyz": [0.15, -0.15, 0.145]},
        {"cylinder": [0.02, 0.29], "xyz": [-0.15, 0.15, 0.145]},
        {"cylinder": [0.02, 0.29], "xyz": [-0.15, -0.15, 0.145]},
    ],
}
RUG = {"center": [1.0, 0.5], "size": [1.0, 0.5], "color": [0, 0, 1]}
BUMPS = {"count": 30, "size": [0.05, 0.2], "height": [0.003, 0.008], "area": [[-1, -1], [2, 1]], "seed": 4}


@pytest.fixture
def client():
    number = pybullet.connect(pybullet.DIRECT)
    yield number
    pybullet.disconnect(physicsClientId=number)


def world_with(*objects):
    return read_world({"floor": {"friction": 1.0}, "objects": list(objects)}, "test", "test.yaml")


@pytest.mark.parametrize("name", world_names())
def test_every_world_of_the_package_can_be_read(name):
    assert load_world(name).name == name


def test_the_empty_world_is_a_floor_with_friction_one():
    world = load_world("empty")
    assert world.floor.friction == 1.0
    assert world.objects == ()


def test_a_path_is_read_as_well_as_a_name(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("floor: {friction: 0.5}\nobjects:\n- {name: cube, box: [1, 1, 1], position: [0, 0, 2]}\n")
    world = load_world(str(path))
    assert (world.name, world.floor.friction, world.objects[0].name) == ("mine", 0.5, "cube")


@pytest.mark.parametrize(
    "content, message",
    [
        ({"flor": {}}, "unknown key 'flor', did you mean 'floor'"),
        ({}, "missing 'floor'"),
        ({"floor": {"friction": -1}}, r"floor\.friction: is -1, allowed is 0 or more"),
        ({"floor": {"friction": "much"}}, r"floor\.friction"),
        ({"floor": {"friction": 1}, "light": {"direction": [1, 0, -1]}}, "light must be above"),
        ({"floor": {"friction": 1, "color": [0, 0, 2]}}, r"floor\.color: .* allowed is 0..1"),
        ({"floor": {"friction": 1}, "objects": {"a": 1}}, "objects: .*not a list"),
        ({"floor": {"friction": 1}, "objects": [{**BALL, "mas": 1}]}, r"objects\[0\]: unknown key 'mas'"),
        ({"floor": {"friction": 1}, "objects": [{**BALL, "box": [1, 1, 1]}]}, "exactly one of"),
        ({"floor": {"friction": 1}, "objects": [{**TABLE, "box": [1, 1]}]}, "not 3 finite numbers"),
        ({"floor": {"friction": 1}, "objects": [{**TABLE, "box": [1, 1, 0]}]}, "must be above 0"),
        ({"floor": {"friction": 1}, "objects": [BALL, BALL]}, r"objects\[1\]\.name: 'ball' is taken"),
        ({"floor": {"friction": 1}, "objects": [{**BALL, "name": "floor"}]}, "'floor' is taken"),
        ({"floor": {"friction": 1}, "objects": [{**CHAIR, "box": [1, 1, 1]}]}, "parts and a shape of its own"),
        ({"floor": {"friction": 1}, "objects": [{**CHAIR, "parts": []}]}, r"objects\[0\]\.parts: has 0 entries"),
        (
            {"floor": {"friction": 1}, "objects": [{**CHAIR, "parts": CHAIR["parts"] * 3}]},
            r"has 18 .* allowed is 1\.\.16",
        ),
        (
            {"floor": {"friction": 1}, "objects": [{**CHAIR, "parts": [{"xyz": [0, 0, 0]}]}]},
            r"parts\[0\]: .*exactly one",
        ),
        ({"floor": {"friction": 1}, "objects": [{**CHAIR, "parts": {"box": [1, 1, 1]}}]}, "parts: .*not a list"),
        ({"floor": {"friction": 1, "slope_deg": [3]}}, r"floor\.slope_deg: .*not 2 finite numbers"),
        ({"floor": {"friction": 1, "slope_deg": [0, -40]}}, r"slope_deg: .*allowed is -30\.\.30"),
        ({"floor": {"friction": 1, "rugs": [{**RUG, "size": [1, 0]}]}}, r"rugs\[0\]\.size: .*above 0"),
        ({"floor": {"friction": 1, "rugs": [{"center": [0, 0]}]}}, r"rugs\[0\]: missing 'size', 'color'"),
        ({"floor": {"friction": 1}, "background": {"haze": 0}}, r"background\.haze: is 0, allowed is 0\.1 or more"),
        ({"floor": {"friction": 1, "bumps": {**BUMPS, "count": 0}}}, r"bumps\.count: is 0, allowed is 1\.\.500"),
        ({"floor": {"friction": 1, "bumps": {**BUMPS, "count": 2.5}}}, r"bumps\.count: is 2\.5, not a whole number"),
        (
            {"floor": {"friction": 1, "bumps": {**BUMPS, "height": [0.01, 0.005]}}},
            r"bumps\.height: .*smaller one first",
        ),
        ({"floor": {"friction": 1, "bumps": {**BUMPS, "keep_free": 3}}}, r"keep_free: is 3 m, which leaves no room"),
        ({"floor": {"friction": 1, "bumps": {**BUMPS, "area": [0, 1]}}}, r"bumps\.area: .*not 2 x 2 finite numbers"),
        (["floor"], "not a mapping"),
    ],
)
def test_wrong_worlds_are_refused_with_the_place(content, message):
    with pytest.raises(WorldError, match=message):
        read_world(content, "test", "test.yaml")


def test_an_unknown_world_names_those_there_are():
    with pytest.raises(WorldError, match="'moon'.*empty"):
        load_world("moon")


def test_a_missing_file_and_broken_yaml_are_world_errors(tmp_path):
    with pytest.raises(WorldError, match=r"nothing\.yaml: cannot be read"):
        load_world(str(tmp_path / "nothing.yaml"))
    broken = tmp_path / "broken.yaml"
    broken.write_text("floor: [")
    with pytest.raises(WorldError, match=r"broken\.yaml: cannot be read"):
        load_world(str(broken))


def test_a_ball_falls_on_the_table_and_stays(client):
    bodies = build_world(world_with({**BALL, "position": [1.0, 0.0, 0.4]}, TABLE), client, visual=False)
    pybullet.setGravity(0, 0, -9.81, physicsClientId=client)
    for _ in range(480):
        pybullet.stepSimulation(physicsClientId=client)
    position, _ = pybullet.getBasePositionAndOrientation(bodies["ball"], physicsClientId=client)
    assert position == pytest.approx((1.0, 0.0, 0.34), abs=2e-3)
    assert pybullet.getDynamicsInfo(bodies["table"], -1, physicsClientId=client)[0] == 0.0


def test_floor_friction_reaches_the_engine(client):
    bodies = build_world(load_world("empty"), client, visual=False)
    assert pybullet.getDynamicsInfo(bodies["floor"], -1, physicsClientId=client)[1] == 1.0


def test_the_same_things_can_be_seen_at_the_same_places(client):
    world = world_with(BALL, {**TABLE, "rpy": [0, 0, 0.5]})
    bodies = build_world(world, client, visual=True)
    assert set(bodies) == {"floor", "ball", "table"}
    for thing in world.objects:
        position, _ = pybullet.getBasePositionAndOrientation(bodies[thing.name], physicsClientId=client)
        assert position == pytest.approx(thing.position)
        looks = pybullet.getVisualShapeData(bodies[thing.name], physicsClientId=client)
        assert looks[0][7][:3] == pytest.approx(thing.parts[0].color)


def settle(client, seconds=2.0, gravity=(0.0, 0.0, -9.81)):
    pybullet.setGravity(*gravity, physicsClientId=client)
    for _ in range(round(240 * seconds)):
        pybullet.stepSimulation(physicsClientId=client)


def pose(body, client):
    return pybullet.getBasePositionAndOrientation(body, physicsClientId=client)


def test_an_object_of_parts_is_one_body_with_its_frame_in_its_centre_of_mass(client):
    world = world_with({**CHAIR, "rpy": [0, 0, 0.5], "mass": 1.2})
    (chair,) = world.objects
    # The back is heavy: the middle is behind that of the seat.
    behind = [chair.position[0] - 2.0, chair.position[1] - 1.0]
    assert behind[0] * math.cos(0.5) + behind[1] * math.sin(0.5) < -0.02
    body = build_world(world, client, visual=False)["chair"]
    assert pose(body, client)[0] == pytest.approx(chair.position)
    settle(client)
    position, orientation = pose(body, client)
    assert position == pytest.approx(chair.position, abs=2e-3)
    assert roll_pitch_yaw(orientation) == pytest.approx((0.0, 0.0, 0.5), abs=2e-3)


def test_each_part_is_where_it_should_be(client):
    build_world(world_with(CHAIR), client, visual=False)

    def height(x, y):
        (hit,) = pybullet.rayTestBatch([(x, y, 1.0)], [(x, y, -0.1)], physicsClientId=client)
        return 1.0 - 1.1 * hit[2]

    assert height(2.0, 1.0) == pytest.approx(0.31, abs=2e-3)
    assert height(1.81, 1.0) == pytest.approx(0.61, abs=2e-3)
    assert height(2.3, 1.0) == pytest.approx(0.0, abs=2e-3)
    (leg,) = pybullet.rayTestBatch([(2.5, 1.15, 0.1)], [(2.0, 1.15, 0.1)], physicsClientId=client)
    assert leg[3][0] == pytest.approx(2.17, abs=2e-3)


def test_parts_keep_their_colours(client):
    body = build_world(world_with(CHAIR), client, visual=True)["chair"]
    looks = pybullet.getVisualShapeData(body, physicsClientId=client)
    assert {tuple(look[7][:3]) for look in looks} == {(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)}


def test_a_floor_that_rises_ahead_and_to_the_left():
    floor = read_world({"floor": {"friction": 1, "slope_deg": [3, 5]}}, "test", "test.yaml").floor
    assert floor.height_at(1.0, 0.0) == pytest.approx(math.tan(math.radians(3.0)))
    assert floor.height_at(0.0, 1.0) == pytest.approx(math.tan(math.radians(5.0)))
    assert rotate(floor.orientation, (0.0, 0.0, 1.0)) == pytest.approx(floor.normal)
    point = tuple(0.4 * axis for axis in floor.normal)
    assert floor.height_at(point[0], point[1], above=0.4) == pytest.approx(point[2])
    # What heads ahead on it still heads ahead, seen from above.
    x, y, _ = rotate(floor.orientation, (1.0, 0.0, 0.0))
    assert math.atan2(y, x) == pytest.approx(0.0, abs=1e-9)


def test_objects_stand_on_a_slope_as_on_the_floor(client):
    content = {"floor": {"friction": 1, "slope_deg": [3, 0]}, "objects": [{**TABLE, "mass": 2.0}]}
    world = read_world(content, "test", "test.yaml")
    bodies = build_world(world, client, visual=False)
    before = pose(bodies["table"], client)
    assert before[0] == pytest.approx(rotate(world.floor.orientation, (1.0, 0.0, 0.15)))
    assert roll_pitch_yaw(before[1])[1] == pytest.approx(-math.radians(3.0))
    settle(client)
    after = pose(bodies["table"], client)
    assert after[0] == pytest.approx(before[0], abs=2e-3)


def test_a_ball_rolls_down_a_slope(client):
    content = {"floor": {"friction": 1, "slope_deg": [0, 3]}, "objects": [{**BALL, "position": [0, 0, 0.04]}]}
    body = build_world(read_world(content, "test", "test.yaml"), client, visual=False)["ball"]
    settle(client, 1.0)
    assert pose(body, client)[0][1] < -0.1


def bumps(**changes):
    return read_world({"floor": {"friction": 0.9, "bumps": {**BUMPS, **changes}}}, "test", "test.yaml")


def test_the_seed_decides_where_bumps_lie():
    assert bumps() == bumps()
    assert bumps().floor.bumps != bumps(seed=5).floor.bumps


def test_bumps_are_as_many_and_as_large_as_asked_for_and_leave_the_start_free():
    plates = bumps(keep_free=0.3).floor.bumps
    assert len(plates) == 30
    for plate in plates:
        (length, width, height), (x, y, z) = plate.size, plate.xyz
        assert 0.05 <= length <= 0.2 and 0.05 <= width <= 0.2 and 0.003 <= height <= 0.008
        assert -1.0 <= x <= 2.0 and -1.0 <= y <= 1.0 and z == height / 2
        assert math.hypot(x, y) > 0.3


def test_all_bumps_can_be_felt_and_have_the_friction_of_the_floor(client):
    """The engine takes a limited number of shapes for a body, and is silent about the others."""
    world = bumps(count=120)
    floor = build_world(world, client, visual=False)["floor"]
    for plate in world.floor.bumps:
        x, y, _ = plate.xyz
        (hit,) = pybullet.rayTestBatch([(x, y, 0.1)], [(x, y, -0.1)], physicsClientId=client)
        assert hit[0] != floor and hit[3][2] >= plate.size[2] - 1e-4
        assert pybullet.getDynamicsInfo(hit[0], -1, physicsClientId=client)[1] == 0.9


def test_what_stands_on_a_bump_stands_higher(client):
    world = bumps(count=1, size=[0.2, 0.2], height=[0.03, 0.03], area=[[0, 0], [0, 0]])
    world = replace(
        world, objects=world_with({**TABLE, "box": [0.1, 0.1, 0.1], "position": [0, 0, 0.1], "mass": 1}).objects
    )
    body = build_world(world, client, visual=False)["table"]
    settle(client)
    assert pose(body, client)[0][2] == pytest.approx(0.08, abs=1e-3)


def test_what_lies_still_wakes_up_when_something_meets_it(client):
    runner = {**BALL, "name": "runner", "position": [0.0, 0.0, 0.04], "rolling_friction": 0.0}
    ball = build_world(world_with({**BALL, "position": [0.5, 0.0, 0.04]}), client, visual=False)["ball"]
    settle(client, 4.0)
    still = pose(ball, client)[0]
    runner = build_world(world_with(runner), client, visual=False)["runner"]
    pybullet.resetBaseVelocity(runner, (1.0, 0.0, 0.0), (0.0, 25.0, 0.0), physicsClientId=client)
    settle(client, 1.0)
    assert pose(ball, client)[0][0] > still[0] + 0.05


def test_rugs_are_seen_and_not_felt(client):
    world = read_world({"floor": {"friction": 1, "rugs": [RUG]}}, "test", "test.yaml")
    touched = build_world(world, client, visual=False)
    (hit,) = pybullet.rayTestBatch([(1.0, 0.5, 0.1)], [(1.0, 0.5, -0.1)], physicsClientId=client)
    assert hit[0] == touched["floor"] and hit[3][2] == pytest.approx(0.0, abs=1e-6)
    seen = build_world(world, client, visual=True)
    looks = pybullet.getVisualShapeData(seen["floor"], physicsClientId=client)
    assert (0.0, 0.0, 1.0) in {tuple(look[7][:3]) for look in looks}
