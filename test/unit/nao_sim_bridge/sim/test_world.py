"""Worlds are read strictly and built alike for touching and for seeing."""

from __future__ import annotations

import pybullet
import pytest

from nao_sim_bridge.sim.world import WorldError, build_world, load_world, read_world, world_names

BALL = {"name": "ball", "sphere": 0.04, "position": [0.5, 0.0, 0.2], "mass": 0.1, "color": [1, 0, 0]}
TABLE = {"name": "table", "box": [0.4, 0.6, 0.3], "position": [1.0, 0.0, 0.15], "friction": 0.9}


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
        assert position == pytest.approx(thing.shape.xyz)
        looks = pybullet.getVisualShapeData(bodies[thing.name], physicsClientId=client)
        assert looks[0][7][:3] == pytest.approx(thing.color)
