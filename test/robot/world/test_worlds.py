"""Worlds under physics: built from their files, those of the package, things that come and go, and their sounds."""

import math
from pathlib import Path

import pytest
import yaml
from sounds import sound_of

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.base.rotations import roll_pitch_yaw, rotate
from nao_sim_bridge.base.samples import sine
from nao_sim_bridge.core.world_sounds_playing import WorldSounds
from nao_sim_bridge.world.builder import build_world
from nao_sim_bridge.world.objects import read_object
from nao_sim_bridge.world.reader import load_world, read_world, world_names

CUBE = {"name": "ball", "sphere": 0.04, "position": [0.5, 0.0, 0.2], "mass": 0.1, "color": [1, 0, 0]}
TABLE = {"name": "table", "box": [0.4, 0.6, 0.3], "position": [1.0, 0.0, 0.15], "friction": 0.9}
LEGS = [{"cylinder": [0.02, 0.29], "xyz": [x, y, 0.145]} for x in (0.15, -0.15) for y in (0.15, -0.15)]
CHAIR = {
    "name": "chair",
    "position": [2.0, 1.0, 0.0],
    "color": [0, 0, 1],
    "parts": [
        {"box": [0.4, 0.4, 0.02], "xyz": [0, 0, 0.3]},
        {"box": [0.02, 0.4, 0.3], "xyz": [-0.19, 0, 0.46], "color": [1, 0, 0]},
        *LEGS,
    ],
}
RUG = {"center": [1.0, 0.5], "size": [1.0, 0.5], "color": [0, 0, 1]}
BUMPS = {"count": 120, "size": [0.05, 0.2], "height": [0.003, 0.008], "area": [[-1, -1], [2, 1]], "seed": 4}


def world(*objects, **floor):
    return read_world({"floor": {"friction": 1.0, **floor}, "objects": list(objects)}, "test", "test.yaml")


class Bare(Engine):
    """A physics engine without a robot."""

    def build(self, of, visual=False):
        return build_world(of, self, visual=visual)

    def settle(self, seconds=2.0):
        self.setGravity(0, 0, -9.81)
        for _ in range(round(240 * seconds)):
            self.stepSimulation()

    def pose(self, body):
        return self.getBasePositionAndOrientation(body)

    def hit(self, start, end):
        """(body, place) that a ray meets."""
        (hit,) = self.rayTestBatch([start], [end])
        return hit[0], hit[3]

    def friction(self, body):
        return self.getDynamicsInfo(body, -1)[1]

    def colors(self, body):
        return {tuple(look[7][:3]) for look in self.getVisualShapeData(body)}


@pytest.fixture
def engine():
    made = Bare()
    yield made
    made.disconnect()


def test_things_fall_lie_and_are_seen_at_their_places(engine):
    seen = world(CUBE, {**TABLE, "rpy": [0, 0, 0.5]})
    bodies = engine.build(seen, visual=True)
    assert set(bodies) == {"floor", "ball", "table"}
    for thing in seen.objects:
        assert engine.pose(bodies[thing.name])[0] == pytest.approx(thing.position)
        assert list(engine.colors(bodies[thing.name])) == [pytest.approx(thing.parts[0].color)]
    engine.resetSimulation()
    bodies = engine.build(world({**CUBE, "position": [1.0, 0.0, 0.4]}, TABLE))
    assert engine.friction(bodies["floor"]) == 1.0 and engine.getDynamicsInfo(bodies["table"], -1)[0] == 0.0
    engine.settle()
    assert engine.pose(bodies["ball"])[0] == pytest.approx((1.0, 0.0, 0.34), abs=2e-3)


def test_an_object_of_parts_is_one_body_with_its_frame_in_its_centre_of_mass(engine):
    built = world({**CHAIR, "rpy": [0, 0, 0.5], "mass": 1.2})
    (chair,) = built.objects
    body = engine.build(built)["chair"]
    assert engine.pose(body)[0] == pytest.approx(chair.position)
    engine.settle()
    position, orientation = engine.pose(body)
    assert position == pytest.approx(chair.position, abs=2e-3)
    assert roll_pitch_yaw(orientation) == pytest.approx((0.0, 0.0, 0.5), abs=2e-3)
    engine.resetSimulation()
    engine.build(world(CHAIR))
    heights = [engine.hit((x, 1.0, 1.0), (x, 1.0, -0.1))[1][2] for x in (2.0, 1.81, 2.3)]
    assert heights == pytest.approx([0.31, 0.61, 0.0], abs=2e-3)
    assert engine.hit((2.5, 1.15, 0.1), (2.0, 1.15, 0.1))[1][0] == pytest.approx(2.17, abs=2e-3)


def test_all_bumps_can_be_felt_and_have_the_friction_of_the_floor_and_rugs_are_only_seen(engine):
    """The engine takes a limited number of shapes for a body, and is silent about the others."""
    built = world(friction=0.9, bumps=BUMPS)
    floor = engine.build(built)["floor"]
    for plate in built.floor.bumps:
        x, y, _ = plate.xyz
        body, place = engine.hit((x, y, 0.1), (x, y, -0.1))
        assert body != floor and place[2] >= plate.size[2] - 1e-4 and engine.friction(body) == 0.9
    engine.resetSimulation()
    floor = engine.build(world(rugs=[RUG]))["floor"]
    body, place = engine.hit((1.0, 0.5, 0.1), (1.0, 0.5, -0.1))
    assert body == floor and place[2] == pytest.approx(0.0, abs=1e-6)
    assert (0.0, 0.0, 1.0) in engine.colors(engine.build(world(rugs=[RUG]), visual=True)["floor"])


def test_bumps_of_the_uneven_floor_are_3_to_8_mm_high():
    heights = [plate.size[2] for plate in load_world("uneven").floor.bumps]
    assert len(heights) >= 40 and 0.003 <= min(heights) < 0.004 and 0.007 < max(heights) <= 0.008


def standing(bench, world, **scene):
    """A robot that stands by its stiffness alone."""
    one = bench(world=world, **scene)
    one.robot.stability.balance.enabled = False
    return one


@pytest.mark.parametrize("world", world_names())
def test_the_robot_starts_on_both_feet_with_nothing_else_touching_it_and_things_lie_still(bench, world):
    one = standing(bench, world)
    assert {one.robot.link_name(c.link) for c in one.simulation.tick().contacts} == {"l_ankle", "r_ankle"}
    start, settled = one.now.torso.position, one.run(0.8)
    end = one.run(1.2)
    assert end.left_foot.total + end.right_foot.total == pytest.approx(one.model.total_mass * 9.81, rel=0.02)
    assert end.torso.position == pytest.approx(start, abs=8e-3) and one.robot.stability.on_feet
    for name, pose in settled.objects.items():
        assert end.objects[name].position == pytest.approx(pose.position, abs=1e-3), name


def test_on_the_slope_the_soles_lie_flat_and_the_torso_leans_with_it(bench):
    flat, sloping = (standing(bench, name).run(0.1) for name in ("empty", "slope_3deg"))
    assert sloping.imu.angles[1] == pytest.approx(flat.imu.angles[1] - math.radians(3.0), abs=6e-3)
    assert sloping.imu.angles[0] == pytest.approx(0.0, abs=2e-3)
    normal = load_world("slope_3deg").floor.normal
    for pose in sloping.link_poses.values():
        assert rotate(pose.orientation, (0.0, 0.0, 1.0)) == pytest.approx(normal, abs=3e-3)
    # The weight has moved towards the heels.
    assert -0.025 < sloping.left_foot.center_of_pressure[0] - flat.left_foot.center_of_pressure[0] < -0.01


BALL = {"name": "b", "ball": 0.03, "position": [0.6, 0.2, 0.03]}
PERSON = {"name": "p", "person": "anna", "position": [1.5, 0.0, 0.0], "heading": 3.0}


@pytest.fixture
def one(bench):
    return bench(posture="Crouch", world="lab")


def place(one, **entry):
    one.simulation.things.place(read_object(entry, "entry", Path))


def where(one, name):
    return one.simulation.things.places()[name]


def move(one, *arguments):
    return one.simulation.things.move(*arguments)


def test_a_person_walks_by_at_constant_speed_until_a_kill(one):
    place(one, **PERSON)
    start, task = one.now.time, move(one, "p", [1.5, -1.0, 0.0], None, 2.0)
    for _ in range(5):
        elapsed = one.run(0.5).time - start
        assert where(one, "p") == pytest.approx((1.5, -min(elapsed / 2.0, 1.0), 0.0, 0.0, 0.0, 3.0), abs=0.01)
    assert task.finished and not task.killed and one.now.objects["p"].position[1] == pytest.approx(-1.0, abs=1e-3)
    second = move(one, "p", [1.5, -0.5, 0.0], [0.0, 0.0, -3.0], 1.0)
    one.run(0.5)
    second.kill()
    one.run(1.0)
    assert where(one, "p")[1] == pytest.approx(-0.75, abs=0.02)
    assert abs(where(one, "p")[5]) == pytest.approx(math.pi, abs=0.02), "the short way round"


def test_what_cannot_be_placed_is_refused(one):
    for entry, message in (
        ({"name": "table"}, r"name is 'table', allowed is one that is free .*; taken: ball, .*wall_right"),
        ({"ball": 11.0, "position": [50, 0, 0]}, "size is 11.0, allowed is 10 m at most"),
        ({"position": [101, 0, 0]}, r"position is .*each -100..100"),
    ):
        with pytest.raises(BadValue, match=message):
            place(one, **{**BALL, **entry})
    with pytest.raises(NotAllowed, match=r"'b' cannot be there: it would be 0\.\d+ m inside the robot"):
        place(one, **{**BALL, "ball": 0.1, "position": [0.0, 0.0, 0.3]})
    assert one.simulation.things.placed == ()


BOX = {"name": "box", "box": [0.4, 0.4, 0.4], "position": [1.0, -1.0, 0.2], "rpy": [0, 0, 1.5707963]}


@pytest.fixture
def playing(bench, tmp_path):
    """A simulation of a world with these sounds, which have begun."""

    def make(*sounds):
        path = tmp_path / "world.yaml"
        path.write_text(yaml.safe_dump({"floor": {"friction": 1.0}, "objects": [CUBE, BOX], "sounds": list(sounds)}))
        one = bench(world=str(path))
        speak = lambda text, _: sine(300.0, 0.1 * len(text), 0.5)  # noqa: E731
        WorldSounds(one.simulation, load_world(str(path)), speak, sound_of).begin()
        return one

    return make


def names(one, seconds=0.0):
    """What sounds after a while."""
    one.run(seconds)
    return one.simulation.sound.sources.names()


def test_sounds_begin_when_they_are_due_end_and_begin_again_after_a_reset(playing):
    hum = {"name": "hum", "tone": 100, "position": [1, 2, 3]}
    burst = {"name": "burst", "noise": "white", "position": [1, 0, 1], "start": 0.3, "duration": 0.2}
    one = playing(hum, burst, {"name": "late", "say": "Hi", "position": [1, 0, 1], "start": 0.6})
    for _ in range(2):
        heard = [names(one), *(names(one, seconds) for seconds in (0.28, 0.06, 0.2, 0.1, 0.2))]
        assert heard == [["hum"], ["hum"], ["hum", "burst"], ["hum"], ["hum", "late"], ["hum"]]
        one.simulation.reset()


def test_a_sound_rides_on_what_moves_and_is_turned_with_what_stands(playing):
    bell = {"name": "bell", "on": "ball", "tone": 500, "position": [0, 0, 0.1]}
    one = playing(bell, {"name": "radio", "on": "box", "tone": 500, "position": [0.1, 0, 0.2]})
    sources = one.simulation.sound.sources
    assert sources.get("radio").place == pytest.approx((1.0, -0.9, 0.4), abs=1e-6)
    move(one, "ball", [1.5, 0.0, 0.04], None, 0.5)
    ball = one.run(0.6).objects["ball"].position
    assert ball[0] > 1.2 and math.dist(sources.get("bell").place, ball) == pytest.approx(0.1, abs=0.03)
