"""What cameras see, with both engines: where things are in the picture, what hides what, what comes and goes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from seen import AWAY, BLUE, GREEN, MODEL, RED, STATE, UNTURNED, clear, middle, placed, shot, world

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.cameras.darkroom import CameraPlaces
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.render.engines import open_engine
from nao_sim_bridge.render.scene.view import View
from nao_sim_bridge.world.pictures import WorldPicture
from nao_sim_bridge.world.render_state import RobotLook
from nao_sim_bridge.world.world import Part, WorldObject

VIEW, HERE = View.of_shot(shot()), (0.0, 0.0, 0.0)


@pytest.fixture(scope="module", params=["opengl", "builtin"])
def name(request):
    """Of each engine."""
    return request.param


@pytest.fixture(scope="module")
def drawing(name):
    """An engine with an empty world."""
    made, _ = open_engine(name, world(), "V6")
    yield made
    made.close()


def ball(name, position, color=GREEN, radius=0.03):
    return {"name": name, "sphere": radius, "position": list(position), "color": list(color)}


def test_things_of_a_world_are_seen_until_they_are_gone(name):
    plate = {"name": "plate", "box": [0.4, 0.4, 0.02], "position": [1.2, 0.0, 0.3], "color": list(GREEN)}
    engine, _ = open_engine(name, world(plate), "V6")
    try:
        view = View.of_shot(shot(rpy=(0.0, 0.25, 0.0)))
        assert area(engine.draw(AWAY, view)) > 300
        assert area(engine.draw(replace(AWAY, gone=frozenset(["plate"])), view)) == 0
    finally:
        engine.close()


@pytest.mark.parametrize("ambient", [0.0, 1.0])
def test_the_light_of_a_world_may_come_from_everywhere_or_from_one_side_alone(name, ambient):
    there = world(ball("ball", (1.0, 0.0, 0.5), radius=0.1))
    engine, _ = open_engine(name, replace(there, light=replace(there.light, ambient=ambient)), "V6")
    try:
        assert area(engine.draw(AWAY, VIEW)) > 300
    finally:
        engine.close()


def area(picture, channel=1):
    """Number of pixels of a primary colour."""
    return np.count_nonzero(clear(picture, channel))


def differ(one, other, by=0):
    """Where two pictures differ."""
    return np.any(np.abs(one.astype(int) - other) > by, axis=2)


def from_head(state, camera=0):
    position, orientation = CameraPlaces(MODEL).in_world(state, camera)
    return View.of_shot(replace(shot(), position=position, orientation=orientation))


@pytest.mark.parametrize(
    "place, position, rpy, fov",
    [
        ((1.0, 0.35, 0.75), (0.0, 0.0, 0.5), HERE, (56.3, 43.7)),
        ((0.3, 1.2, 0.2), (0.1, 0.2, 0.6), (0.3, 0.4, 1.3), (56.3, 43.7)),
        ((-1.0, -0.2, 0.9), (0.0, 0.0, 0.5), (-0.5, -0.3, 3.1), (60.9, 47.6)),
    ],
)
def test_a_ball_is_seen_where_the_projection_says(drawing, place, position, rpy, fov):
    for size in ((160, 120), (640, 480)):
        view = View.of_shot(shot(position, rpy, *size, fov))
        seen, expected = clear(drawing.draw(placed(ball("ball", place, radius=0.025)), view), 1), view.project(place)
        assert 0.0 < expected[0] < size[0] and 0.0 < expected[1] < size[1]
        # The middle of what is seen of a ball is a little farther out than the image of its middle.
        assert middle(seen > 0.0) == pytest.approx(expected, abs=0.5)


def test_left_is_left_up_is_up_and_the_near_hides_the_far(drawing):
    picture = drawing.draw(placed(ball("left", (1.0, 0.3, 0.5)), ball("up", (1.0, 0.0, 0.7), BLUE)), VIEW)
    assert middle(clear(picture, 1))[0] < 100 and middle(clear(picture, 2))[1] < 80
    near = {"name": "near", "box": [0.1, 0.4, 0.4], "position": [1.0, 0.0, 0.5], "color": list(RED)}
    far = {"name": "far", "box": [0.1, 0.3, 0.3], "position": [1.5, 0.0, 0.5], "color": list(GREEN)}
    picture = drawing.draw(placed(far, near), VIEW)
    assert area(picture, 0) > 1000 and area(picture) == 0


@pytest.fixture(scope="module")
def four_colors(tmp_path_factory):
    """A picture: red and green above, blue and white below."""
    pixels = np.zeros((64, 64, 3), dtype=np.uint8)
    pixels[:32, :32], pixels[:32, 32:] = (220, 0, 0), (0, 220, 0)
    pixels[32:, :32], pixels[32:, 32:] = (0, 0, 220), (220, 220, 220)
    path = tmp_path_factory.mktemp("pictures") / "four.png"
    Image.fromarray(pixels).save(path)
    return WorldPicture("file", str(path))


def card(picture=None, shape=None, color=(0.5, 0.5, 0.5), **changes):
    """Faces the camera of `shot`, 1 m ahead of it."""
    part = Part(shape or Shape("box", (0.02, 0.4, 0.4), HERE, HERE), color, picture)
    physics = {"mass": 0.0, "friction": 1.0, "rolling_friction": 0.0, "restitution": 0.0}
    return replace(WorldObject("card", (1.01, 0.0, 0.5), (0.0, 0.0, math.pi), (part,), **physics), **changes)


def with_things(*things, **changes):
    return replace(AWAY, placed=things, **changes)


@pytest.mark.parametrize("kind, size", [("box", (0.02, 0.4, 0.4)), ("sphere", (0.2,))])
def test_a_picture_on_a_thing_is_upright_not_mirrored_and_on_its_front_only(drawing, four_colors, kind, size):
    thing = card(four_colors, Shape(kind, size, HERE, HERE))
    picture = drawing.draw(with_things(thing), VIEW)
    red, green, blue = (middle(clear(picture, channel)) for channel in range(3))
    assert red[0] < 155 and red[1] < 115
    assert green[0] > 165 and green[1] < 115
    assert blue[0] < 155 and blue[1] > 125
    if kind == "box":
        rows, columns = np.nonzero(clear(picture, 0))
        # A quarter of 0.4 m at 1 m, where 300 pixels are 1 m.
        assert (columns.min(), columns.max()) == pytest.approx((100, 160), abs=2)
        assert (rows.min(), rows.max()) == pytest.approx((60, 120), abs=2)
        behind = drawing.draw(with_things(replace(thing, rpy=HERE)), VIEW)
        assert [area(behind, channel) for channel in range(3)] == [0, 0, 0]


def test_what_was_placed_comes_moves_and_goes(drawing):
    thing = card(shape=Shape("sphere", (0.05,), HERE, HERE), color=GREEN, name="ball", position=(1.0, 0.2, 0.5))
    without = drawing.draw(AWAY, VIEW)
    assert area(without) == 0
    assert middle(clear(drawing.draw(with_things(thing), VIEW), 1))[0] == pytest.approx(100, abs=2)
    moved = with_things(thing, objects={"ball": Pose((1.0, -0.2, 0.5), UNTURNED)})
    assert middle(clear(drawing.draw(moved, VIEW), 1))[0] == pytest.approx(220, abs=2)
    assert np.array_equal(drawing.draw(AWAY, VIEW), without)
    with pytest.raises(UnknownName, match="unknown object 'bal': did you mean 'ball'"):
        drawing.draw(with_things(thing, objects={"bal": Pose(HERE, UNTURNED)}), VIEW)


def test_the_head_is_not_in_the_way_of_its_cameras_but_a_raised_arm_is_seen(drawing):
    for camera, rows in ((0, 240), (1, 120)):  # looking down, its own shadow and feet may be there, nothing above
        view = from_head(STATE, camera)
        assert not differ(drawing.draw(STATE, view), drawing.draw(AWAY, view), by=3)[:rows].any()
    angles = list(STATE.joint_positions)
    for joint in ("LShoulderPitch", "LShoulderRoll"):
        angles[MODEL.joint_index[joint]] = -0.2
    raised, view = replace(STATE, joint_positions=tuple(angles)), from_head(STATE)
    changed = differ(drawing.draw(raised, view), drawing.draw(STATE, view), by=20)
    assert changed.sum() > 3000 and middle(changed)[0] < 140, "on the left"


def test_other_robots_are_seen_with_their_heads_lights_and_postures(drawing):
    view = from_head(STATE)
    dark = RobotLook((1.2, 0.0, 0.333), (0.0, 0.0, 1.0, 0.0), STATE.joint_positions, (0.0,) * 89)
    bright, beside = replace(dark, led_values=(1.0,) * 89), replace(dark, base_position=(1.2, 0.4, 0.333))
    groups = (), (dark,), (bright,), (dark, beside)
    alone, one, glowing, two = (drawing.draw(replace(STATE, others=others), view) for others in groups)
    assert differ(one, alone, by=20).sum() > 3000 and differ(glowing, one, by=40).sum() > 20
    assert differ(two, one)[:, :100].sum() > 1000 and np.array_equal(drawing.draw(STATE, view), alone)
