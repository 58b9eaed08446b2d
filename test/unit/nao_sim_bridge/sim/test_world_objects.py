"""Things that world files know by name: cards, people, robots, balls."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from nao_sim_bridge.sim.kinematics import rpy_matrix
from nao_sim_bridge.sim.landmarks import load_landmarks
from nao_sim_bridge.sim.meshes import front_and_rest, tessellate
from nao_sim_bridge.sim.shapes import Shape
from nao_sim_bridge.sim.world import MOST_PARTS, WorldError
from nao_sim_bridge.sim.world_objects import read_object
from nao_sim_bridge.sim.world_pictures import WorldPicture


def thing(**entry):
    return read_object({"name": "it", "position": [1.0, 0.0, 0.5], **entry}, "it", Path)


def reach(one):
    """Lowest and highest point of what is to be seen of a thing, over the floor, in m: ((x, x), (y, y), (z, z))."""
    points = np.vstack([tessellate(part.shape).placed(part.shape).vertices for part in one.parts])
    points = points @ rpy_matrix(one.rpy).T + one.position
    return tuple(zip(points.min(axis=0), points.max(axis=0)))


# --- cards ------------------------------------------------------------------------------------------------------------


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
    card = thing(**entry).parts[0].shape
    assert card.size == pytest.approx((0.006, width, height))


def test_the_disc_of_a_landmark_is_as_large_as_printed_ones():
    card = thing(landmark=64).parts[0].shape
    assert card.size[1] / (1.0 + load_landmarks().margin) == pytest.approx(0.092)


def test_the_middle_of_a_card_is_at_its_position_with_and_without_a_stand():
    for stand in (False, True):
        one = thing(landmark=119, heading=math.pi, stand=stand)
        middle = rpy_matrix(one.rpy) @ one.parts[0].shape.xyz + one.position
        assert middle == pytest.approx((1.0, 0.0, 0.5))
        assert rpy_matrix(one.rpy) @ one.origin + one.position == pytest.approx((1.0, 0.0, 0.5))
        assert one.parts[0].picture == WorldPicture("landmark", "119")
        assert one.kind == "landmark" and one.mass == 0.0


def test_a_stand_reaches_from_the_floor_to_the_card_and_stays_behind_it():
    one = thing(qr="hello", heading=math.pi, stand=True)
    assert reach(one)[2] == (pytest.approx(0.0, abs=1e-9), pytest.approx(0.575))
    pole = one.parts[1].shape
    assert (rpy_matrix(one.rpy) @ pole.xyz + one.position)[0] - pole.size[0] >= 1.003 - 1e-9


def test_a_card_from_a_file_has_its_proportions(tmp_path):
    Image.new("RGB", (40, 10)).save(tmp_path / "wide.png")
    entry = {"name": "it", "position": [0, 0, 1], "image": "wide.png", "size": 0.8}
    card = read_object(entry, "it", lambda name: tmp_path / name).parts[0]
    assert card.shape.size[1:] == pytest.approx((0.8, 0.2))
    assert card.picture == WorldPicture("file", str(tmp_path / "wide.png"))


# --- balls, boxes -----------------------------------------------------------------------------------------------------


def test_a_ball_is_red_light_and_rolls():
    one = thing(ball=0.03)
    assert one.parts[0].shape == Shape("sphere", (0.03,), (0.0, 0.0, 0.0))
    red, green, blue = one.parts[0].color
    assert red > 4 * green and red > 4 * blue
    assert one.mass == 0.03 and one.rolling_friction < 0.001 and one.kind == "ball"
    assert thing(ball=0.03, mass=0, color=[0, 0, 1]).mass == 0.0


def test_a_box_may_have_a_picture_on_its_front():
    one = thing(box=[0.1, 0.2, 0.3], picture="pattern:oak")
    assert one.parts[0].picture == WorldPicture("pattern", "oak")


def test_the_front_of_a_box_has_the_whole_picture_upright():
    front, rest = front_and_rest(tessellate(Shape("box", (0.1, 0.2, 0.3), (0, 0, 0))))
    assert len(front.faces) == 2 and len(rest.faces) == 10
    places = {tuple(vertex): tuple(uv) for vertex, uv in zip(front.vertices.round(6).tolist(), front.uvs.tolist())}
    # Who looks at it from the front has -Y on the left.
    assert places[(0.05, -0.1, -0.15)] == (0.0, 0.0)
    assert places[(0.05, 0.1, 0.15)] == (1.0, 1.0)


@pytest.mark.parametrize("kind, size", [("sphere", (0.1,)), ("ellipsoid", (0.1, 0.2, 0.3)), ("cylinder", (0.1, 0.4))])
def test_the_front_of_round_shapes_is_the_half_that_looks_along_x(kind, size):
    mesh = tessellate(Shape(kind, size, (0, 0, 0)))
    front, rest = front_and_rest(mesh)
    assert len(front.faces) + len(rest.faces) == len(mesh.faces)
    assert front.vertices[:, 0].min() > -1e-9
    assert front.uvs.min() >= 0.0 and front.uvs.max() <= 1.0
    moved = front.placed(Shape(kind, size, (1.0, 2.0, 3.0)))
    assert moved.uvs is front.uvs


# --- people and robots ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("height", [0.9, 1.65, 1.9])
def test_a_person_stands_on_the_floor_and_is_as_tall_as_told(height):
    one = read_object({"name": "it", "person": "anna", "height": height, "position": [2, 1, 0]}, "it", Path)
    lowest, highest = reach(one)[2]
    assert lowest == pytest.approx(0.0, abs=0.005)
    assert highest == pytest.approx(height, abs=0.03)
    assert rpy_matrix(one.rpy) @ one.origin + one.position == pytest.approx((2.0, 1.0, 0.0))
    assert len(one.touched) <= MOST_PARTS


def test_the_face_of_a_person_looks_ahead_and_down():
    one = thing(person="ben")
    (head,) = [part for part in one.parts if part.picture is not None]
    assert head.picture == WorldPicture("head", "ben")
    assert 0.2 < head.shape.rpy[1] < 0.6
    (level,) = [part for part in thing(person="ben", nod=0).parts if part.picture is not None]
    assert level.shape.rpy == (0.0, 0.0, 0.0)


def test_clothes_have_the_colours_that_were_asked_for():
    colors = [part.color for part in thing(person="ben", clothes=[0.1, 0.2, 0.3], trousers=[0.7, 0.6, 0.5]).parts]
    assert (0.1, 0.2, 0.3) in colors and (0.7, 0.6, 0.5) in colors


@pytest.mark.parametrize("posture, low, high", [("Stand", 0.55, 0.60), ("Sit", 0.35, 0.45), ("LyingBack", 0.1, 0.3)])
def test_another_nao_is_on_the_floor_in_its_posture(posture, low, high):
    one = read_object({"name": "it", "nao": posture, "position": [1, 0, 0]}, "it", Path)
    lowest, highest = reach(one)[2]
    assert lowest == pytest.approx(0.0, abs=0.002)
    assert low < highest < high
    assert len(one.touched) <= MOST_PARTS and {shape.kind for shape in one.touched} <= {"box", "sphere", "capsule"}


def test_the_lights_of_another_nao():
    assert not any(part.shining for part in thing(nao="Stand").parts)
    lit = [part for part in thing(nao="Stand", leds=[0.1, 0.6, 1.0]).parts if part.shining]
    assert len(lit) == 51 and {part.color for part in lit} == {(0.1, 0.6, 1.0)}


# --- errors -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "entry, message",
    [
        ({}, "needs exactly one of box, sphere, .*nao, has none"),
        ({"ball": 0.03, "box": [1, 1, 1]}, "exactly one of .*, has box, ball"),
        ({"ball": -1}, "sizes must be above 0"),
        ({"ball": 0.03, "stand": True}, "unknown key 'stand'"),
        ({"landmark": 65}, r"it\.landmark: landmark is '65', allowed is one of 64"),
        ({"landmark": 64, "size": 0}, r"it\.size: is 0, allowed is 0.01..4"),
        ({"landmark": 64, "stand": "yes"}, r"it\.stand: is 'yes', not true or false"),
        ({"poster": "hills", "size": 2.0, "stand": True}, r"it\.position: has z 0.5: a card of 2.67 m"),
        ({"landmark": 64, "heading": 1, "rpy": [0, 0, 1]}, "rpy and heading: one of both"),
        ({"qr": "x" * 301}, "1 to 300 bytes"),
        ({"barcode": "123"}, "12 or 13 digits"),
        ({"barcode": 4006381333931}, r"it\.barcode: is 4006381333931, not a text: put it between quotes"),
        ({"landmark": True}, "landmark is 'True', allowed is one of 64"),
        ({"image": "nowhere.png"}, "a file that is there"),
        ({"person": "nobody"}, "allowed is one of anna"),
        ({"person": "anna", "height": 3}, r"it\.height: is 3, allowed is 0.9..1.9"),
        ({"person": "anna", "trouser": [0, 0, 0]}, "did you mean 'trousers'"),
        ({"nao": "Handstand"}, r"it\.nao: unknown posture 'Handstand'"),
        ({"nao": "Stand", "leds": [2, 0, 0]}, r"it\.leds: .* allowed is 0..1 each"),
        ({"box": [1, 1, 1], "picture": "oak"}, r"it\.picture: is 'oak', not a kind and a name"),
        ({"box": [1, 1, 1], "picture": "file:/etc/passwd"}, "not a kind and a name"),
        ({"box": [1, 1, 1], "picture": "pattern:gold"}, "allowed is one of oak"),
    ],
)
def test_wrong_entries_are_told(entry, message):
    with pytest.raises(WorldError, match=message):
        thing(**entry)
