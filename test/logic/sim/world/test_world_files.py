"""World files: floors, things, cards, people, robots and sounds are read strictly."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from sounds import sound_of

from nao_sim_bridge.base.rotations import rotate
from nao_sim_bridge.base.samples import sine
from nao_sim_bridge.model.kinematics import rpy_matrix
from nao_sim_bridge.model.meshes import tessellate
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.cards import CARDS
from nao_sim_bridge.world.objects import read_object
from nao_sim_bridge.world.painting.known_landmarks import load_landmarks
from nao_sim_bridge.world.pictures import WorldPicture
from nao_sim_bridge.world.places import RobotPlace
from nao_sim_bridge.world.reader import load_world, read_world, world_names
from nao_sim_bridge.world.sounds_made import make_sound, noise
from nao_sim_bridge.world.world import MOST_PARTS, WorldError

BALL = {"name": "ball", "sphere": 0.04, "position": [0.5, 0.0, 0.2], "mass": 0.1, "color": [1, 0, 0]}
TABLE = {"name": "table", "box": [0.4, 0.6, 0.3], "position": [1.0, 0.0, 0.15], "friction": 0.9}
CHAIR = {"name": "chair", "position": [2.0, 1.0, 0.0], "parts": [{"box": [0.4, 0.4, 0.02], "xyz": [0, 0, 0.3]}]}
BUMPS = {"count": 30, "size": [0.05, 0.2], "height": [0.003, 0.008], "area": [[-1, -1], [2, 1]], "seed": 4}
DOCUMENT = Path(__file__).parents[4] / "docs" / "worlds.md"


def read(content, folder=None):
    return read_world(content, "test", "test.yaml", folder)


def floor(**entries):
    return {"floor": {"friction": 1, **entries}}


def of(*objects):
    return {**floor(), "objects": list(objects)}


def robot(entry):
    return {**floor(), "robots": [entry]}


@pytest.mark.parametrize(
    "content, message",
    [
        ({"flor": {}}, "unknown key 'flor': did you mean 'floor'"),
        (floor(friction=-1), r"floor\.friction: is -1, allowed is 0 or more"),
        (of({**BALL, "mas": 1}), r"objects\[0\]: unknown key 'mas'"),
        (of(BALL, BALL), r"objects\[1\]\.name: 'ball' is taken"),
        (of({**CHAIR, "parts": [{"xyz": [0, 0, 0]}]}), r"parts\[0\]: .*exactly one"),
        (floor(slope_deg=[0, -40]), r"slope_deg: .*allowed is -30\.\.30"),
        (floor(bumps={**BUMPS, "count": 0}), r"bumps\.count: is 0, allowed is 1\.\.500"),
        (floor(bumps={**BUMPS, "height": [0.01, 0.005]}), r"bumps\.height: .*smaller one first"),
        (floor(bumps={**BUMPS, "keep_free": 3}), r"keep_free: is 3 m, which leaves no room"),
        (robot({"position": [99, 0]}), r"test.yaml: robots\[0\]"),
        (robot({"position": [0]}), r"robots\[0\]\.position: is \[0\.0\], not \[x, y\] or \[x, y, z\]"),
    ],
)
def test_wrong_worlds_are_refused_with_the_place(content, message):
    with pytest.raises(WorldError, match=message):
        read(content)


def test_worlds_are_found_by_name_and_path(tmp_path):
    names = {"empty", "gallery", "lab", "obstacles", "party", "platform", "slope_3deg", "uneven", "wall"}
    assert set(world_names()) == names
    assert all(load_world(name).name == name and load_world(name).description for name in names)
    empty = load_world("empty")
    assert (empty.floor.friction, empty.objects, empty.robots, empty.sounds) == (1.0, (), (), ())
    path = tmp_path / "mine.yaml"
    path.write_text(
        "floor: {friction: 0.5}\nobjects:\n- {name: cube, box: [1, 1, 1], position: [0, 0, 2]}\n"
        "sounds:\n- {name: bell, on: cube, tone: 440}\n"  # `on` without quotes
        "robots: [{position: [1, 2], yaw: 0.5}, {position: [-1, 0, 0.2]}]\n"
    )
    world = load_world(str(path))
    assert (world.name, world.floor.friction) == ("mine", 0.5)
    assert world.objects[0].name == world.sounds[0].on == "cube"
    assert world.robots == (RobotPlace(1.0, 2.0, 0.5), RobotPlace(-1.0, 0.0, 0.0, 0.2))
    path.write_text("floor: [")
    for wrong, message in (("moon", "'moon'.*empty"), (str(tmp_path / "no.yaml"), r"no\.yaml: cannot be read")):
        with pytest.raises(WorldError, match=message):
            load_world(wrong)
    with pytest.raises(WorldError, match=r"mine\.yaml: cannot be read"):
        load_world(str(path))


@pytest.mark.parametrize(
    "text, told",
    [
        ("a: &a [%s]\nb: &b [%s]\nc: &c [%s]\nd: [%s]\n", "more than 200000 values"),
        ("a: &a {k: 1}\nb: &b {<<: [%s]}\nc: &c {<<: [%s]}\nd: {<<: [%s]}\n", "more than 200000 values"),
        ("objects: &a [*a]", "more than 50 levels"),
        ("[" * 5000, "more than 100 brackets"),
        ("floor: {friction: 1" + "0" * 5000 + "}", "a whole number of 5001 characters"),
        ("floor: {friction: 2024-99-99}", "month must be"),
    ],
    ids=range(6),
)
def test_a_few_lines_cannot_stand_for_endless_values(tmp_path, text, told):
    path = tmp_path / "mine.yaml"
    lists = [",".join([what] * 80) for what in ("1", "*a", "*b", "*c")]
    path.write_text(text % tuple(lists[-text.count("%s") :]) if "%s" in text else text)
    with pytest.raises(WorldError, match=f"mine.yaml: cannot be read: .*{told}"):
        load_world(str(path))


def test_the_world_of_the_documents_can_be_read(tmp_path):
    (tmp_path / "music.ogg").touch()
    texts = re.findall(r"```yaml\n(.*?)```", DOCUMENT.read_text(encoding="utf-8"), re.DOTALL)
    world = read(yaml.safe_load("".join(texts)), tmp_path)
    assert [sound.name for sound in world.sounds] == ["anna", "radio", "hum", "knock"]
    assert [thing.name for thing in world.objects][:2] == ["ball", "chair"]
    assert {thing.kind for thing in world.objects} >= set(CARDS) - {"image"} | {"person", "nao", "ball"}
    assert len(world.floor.rugs) == 1 and len(world.floor.bumps) == 20


def test_a_floor_that_rises_ahead_and_to_the_left():
    slope = read(floor(slope_deg=[3, 5])).floor
    assert slope.height_at(1.0, 0.0) == pytest.approx(math.tan(math.radians(3.0)))
    assert slope.height_at(0.0, 1.0) == pytest.approx(math.tan(math.radians(5.0)))
    assert rotate(slope.orientation, (0.0, 0.0, 1.0)) == pytest.approx(slope.normal)
    x, y, z = (0.4 * axis for axis in slope.normal)
    assert slope.height_at(x, y, above=0.4) == pytest.approx(z)
    # What heads ahead on it still heads ahead, seen from above.
    x, y, _ = rotate(slope.orientation, (1.0, 0.0, 0.0))
    assert math.atan2(y, x) == pytest.approx(0.0, abs=1e-9)


def thing(**entry):
    return read_object({"name": "it", "position": [1.0, 0.0, 0.5], **entry}, "it", Path)


def heights(one):
    """Lowest and highest point over the floor of what is to be seen of a thing, m."""
    points = np.vstack([tessellate(part.shape).placed(part.shape).vertices for part in one.parts])
    points = points @ rpy_matrix(one.rpy).T + one.position
    return points[:, 2].min(), points[:, 2].max()


@pytest.mark.parametrize(
    "entry, width, height",
    [
        ({"landmark": 64}, 0.115, 0.115),
        ({"landmark": 64, "size": 0.2}, 0.25, 0.25),
        ({"qr": "hello", "size": 0.1}, 0.1, 0.1),
        ({"face": "anna", "size": 0.24}, 0.24, 0.30),
        ({"poster": "hills", "size": 0.6}, 0.6, 0.8),
    ],
)
def test_cards_have_the_size_that_was_asked_for(entry, width, height):
    assert thing(**entry).parts[0].shape.size == pytest.approx((0.006, width, height))
    disc = thing(landmark=64).parts[0].shape.size[1] / (1.0 + load_landmarks().margin)
    assert disc == pytest.approx(0.092), "as large as printed ones"


@pytest.mark.parametrize("stand", [False, True])
def test_the_middle_of_a_card_is_at_its_position_and_a_stand_reaches_up_to_it_from_behind(stand):
    one = thing(landmark=119, heading=math.pi, stand=stand)
    for point in (one.parts[0].shape.xyz, one.origin):
        assert rpy_matrix(one.rpy) @ point + one.position == pytest.approx((1.0, 0.0, 0.5))
    assert (one.parts[0].picture, one.kind, one.mass) == (WorldPicture("landmark", "119"), "landmark", 0.0)
    if stand:
        assert heights(one) == (pytest.approx(0.0, abs=1e-9), pytest.approx(0.5575))
        pole = one.parts[1].shape
        assert (rpy_matrix(one.rpy) @ pole.xyz + one.position)[0] - pole.size[0] >= 1.003 - 1e-9


def test_a_ball_is_red_light_and_rolls():
    one = thing(ball=0.03)
    assert one.parts[0].shape == Shape("sphere", (0.03,), (0.0, 0.0, 0.0))
    red, green, blue = one.parts[0].color
    assert red > 4 * green and red > 4 * blue
    assert one.mass == 0.03 and one.rolling_friction < 0.001 and one.kind == "ball"
    assert thing(ball=0.03, mass=0, color=[0, 0, 1]).mass == 0.0


@pytest.mark.parametrize("height", [0.9, 1.65, 1.9])
def test_a_person_stands_on_the_floor_as_tall_as_told_and_looks_ahead_and_down(height):
    one = thing(person="ben", height=height, position=[2, 1, 0], clothes=[0.1, 0.2, 0.3], trousers=[0.7, 0.6, 0.5])
    assert heights(one) == (pytest.approx(0.0, abs=0.005), pytest.approx(height, abs=0.03))
    assert rpy_matrix(one.rpy) @ one.origin + one.position == pytest.approx((2.0, 1.0, 0.0))
    assert len(one.touched) <= MOST_PARTS
    assert {(0.1, 0.2, 0.3), (0.7, 0.6, 0.5)} <= {part.color for part in one.parts}
    people = thing(person="ben"), thing(person="ben", nod=0)
    (head,), (level,) = ([part for part in who.parts if part.picture is not None] for who in people)
    assert head.picture == WorldPicture("head", "ben") and 0.2 < head.shape.rpy[1] < 0.6
    assert level.shape.rpy == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "entry, message",
    [
        ({}, "needs exactly one of box, sphere, .*nao, has none"),
        ({"landmark": 65}, r"it\.landmark: landmark is '65', allowed is one of 64"),
        ({"landmark": 64, "size": 0}, r"it\.size: is 0, allowed is 0.01..4"),
        ({"poster": "hills", "size": 2.0, "stand": True}, r"it\.position: has z 0.5: a card of 2.67 m"),
        ({"landmark": 64, "heading": 1, "rpy": [0, 0, 1]}, "rpy and heading: one of both"),
        ({"barcode": 4006381333931}, r"it\.barcode: is 4006381333931, not a text: put it between quotes"),
        ({"nao": "Handstand"}, r"it\.nao: unknown posture 'Handstand'"),
    ],
)
def test_wrong_things_are_refused(entry, message):
    with pytest.raises(WorldError, match=message):
        thing(**entry)


HUM = {"name": "hum", "tone": 100, "position": [1, 2, 3]}
HERE = {"name": "n", "position": [0, 0, 1]}


def sounds(*entries, folder=None):
    return read({**of(BALL, TABLE), "sounds": list(entries)}, folder).sounds


def made(entry, folder=None):
    """The sound of an entry; a text takes 0.1 s a letter."""
    return make_sound(*sounds(entry, folder=folder), lambda text, voice: sine(300.0, 0.1 * len(text), 0.5), sound_of)


@pytest.mark.parametrize(
    "entry, message",
    [
        ({**HUM, "levl_db": 3}, "unknown key 'levl_db': did you mean 'level_db'"),
        (HERE, "has nothing to sound, needs exactly one of file, tone, noise, say"),
        ({"name": "hum", "on": "dog", "tone": 1}, r"on: is 'dog', allowed is an object of this world \(ball, table\)"),
        ({**HUM, "tone": -5}, "tone: is -5, allowed is above 0 to 20000 Hz"),
        ({**HERE, "noise": "blue"}, "noise: is 'blue', allowed is white or pink"),
        ({**HUM, "pause": 1.0}, "pause: is for what is repeated"),
        ({**HUM, "level_db": 200}, r"level_db: is 200, allowed is -20\.\.140"),
    ],
)
def test_wrong_sounds_are_refused(entry, message):
    with pytest.raises(WorldError, match=message) as raised:
        sounds(entry)
    assert str(raised.value).startswith("test.yaml: sounds[0]")


def spectrum(sound):
    return np.fft.rfftfreq(sound.frames, 1.0 / sound.rate), np.abs(np.fft.rfft(sound.samples[:, 0]))


def test_tones_have_their_frequencies_and_pink_noise_as_much_in_every_octave():
    frequencies, values = spectrum(made({**HUM, "tone": [440.0, 1000.0]}))
    assert sorted(frequencies[np.argsort(values)[-2:]]) == pytest.approx([440.0, 1000.0], abs=0.1)
    frequencies, values = spectrum(noise("pink"))
    powers = [np.sum(values[(frequencies >= low) & (frequencies < 2 * low)] ** 2) for low in (100, 400, 1600, 6400)]
    assert max(powers) < 1.2 * min(powers)


def test_bumps_are_as_many_and_as_large_as_asked_for_leave_the_start_free_and_follow_their_seed():
    def bumps(**changes):
        return read(floor(bumps={**BUMPS, **changes})).floor.bumps

    assert bumps() == bumps() != bumps(seed=5)
    plates = bumps(keep_free=0.3)
    assert len(plates) == 30
    for (length, width, height), (x, y, z) in ((plate.size, plate.xyz) for plate in plates):
        assert 0.05 <= length <= 0.2 and 0.05 <= width <= 0.2 and 0.003 <= height <= 0.008
        assert -1.0 <= x <= 2.0 and -1.0 <= y <= 1.0 and z == height / 2 and math.hypot(x, y) > 0.3
