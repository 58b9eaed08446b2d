"""What a camera of the robot sees, with both engines: where things are in the picture, what hides what, what comes and
goes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from seen import AWAY, BLUE, GREEN, MODEL, RED, STATE, UNTURNED, clear, middle, placed, shot, world

from nao_sim_bridge.sim.cameras.places import CameraPlaces
from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.render import RobotLook
from nao_sim_bridge.sim.render.engines import open_engine
from nao_sim_bridge.sim.render.view import View
from nao_sim_bridge.sim.shapes import Shape
from nao_sim_bridge.sim.world import Part, WorldObject
from nao_sim_bridge.sim.world_pictures import WorldPicture


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


@pytest.fixture
def engine(name):
    """Makes further engines, which are freed after the test."""
    made = []

    def make(*objects):
        made.append(open_engine(name, world(*objects), "V6")[0])
        return made[-1]

    yield make
    for one in made:
        one.close()


def from_head(state, camera=0):
    position, orientation = CameraPlaces(MODEL).in_world(state, camera)
    return View.of_shot(replace(shot(), position=position, orientation=orientation))


@pytest.mark.parametrize("size", [(160, 120), (320, 240), (640, 480)])
@pytest.mark.parametrize(
    "ball, position, rpy, fov",
    [
        ((1.0, 0.0, 0.5), (0.0, 0.0, 0.5), (0.0, 0.0, 0.0), (56.3, 43.7)),
        ((1.0, 0.35, 0.75), (0.0, 0.0, 0.5), (0.0, 0.0, 0.0), (56.3, 43.7)),
        ((0.9, -0.4, 0.25), (0.0, 0.0, 0.5), (0.0, 0.0, 0.0), (60.9, 47.6)),
        ((0.3, 1.2, 0.2), (0.1, 0.2, 0.6), (0.3, 0.4, 1.3), (56.3, 43.7)),
        ((-1.0, -0.2, 0.9), (0.0, 0.0, 0.5), (-0.5, -0.3, 3.1), (60.9, 47.6)),
    ],
)
def test_a_ball_is_seen_where_the_projection_says(drawing, size, ball, position, rpy, fov):
    thing = {"name": "ball", "sphere": 0.025, "position": list(ball), "color": list(GREEN)}
    view = View.of_shot(shot(position, rpy, *size, fov))
    seen = clear(drawing.draw(placed(thing), view), 1)
    expected = view.project(ball)
    assert 0.0 < expected[0] < size[0] and 0.0 < expected[1] < size[1]
    # The middle of what is seen of a ball is a little farther out than the image of its middle.
    assert middle(seen > 0.0) == pytest.approx(expected, abs=0.5)


def test_left_is_left_and_up_is_up(drawing):
    things = [
        {"name": "left", "sphere": 0.03, "position": [1.0, 0.3, 0.5], "color": list(GREEN)},
        {"name": "up", "sphere": 0.03, "position": [1.0, 0.0, 0.7], "color": list(BLUE)},
    ]
    picture = drawing.draw(placed(*things), View.of_shot(shot()))
    assert middle(clear(picture, 1))[0] < 100
    assert middle(clear(picture, 2))[1] < 80


def test_the_near_hides_the_far(drawing):
    near = {"name": "near", "box": [0.1, 0.4, 0.4], "position": [1.0, 0.0, 0.5], "color": list(RED)}
    far = {"name": "far", "box": [0.1, 0.3, 0.3], "position": [1.5, 0.0, 0.5], "color": list(GREEN)}
    view = View.of_shot(shot())
    picture = drawing.draw(placed(far, near), view)
    assert np.count_nonzero(clear(picture, 0)) > 1000 and np.count_nonzero(clear(picture, 1)) == 0
    beside = placed(far, near, objects={"near": Pose((1.0, 1.0, 0.5), UNTURNED)})
    assert np.count_nonzero(clear(drawing.draw(beside, view), 1)) > 1000


@pytest.fixture(scope="module")
def four_colors(tmp_path_factory):
    """A picture: red and green above, blue and white below."""
    pixels = np.zeros((64, 64, 3), dtype=np.uint8)
    pixels[:32, :32], pixels[:32, 32:] = (220, 0, 0), (0, 220, 0)
    pixels[32:, :32], pixels[32:, 32:] = (0, 0, 220), (220, 220, 220)
    path = tmp_path_factory.mktemp("pictures") / "four.png"
    Image.fromarray(pixels).save(path)
    return WorldPicture("file", str(path))


def card(picture, shape=None, **changes):
    """Faces the camera of `shot`, 1 m ahead of it."""
    part = Part(shape or Shape("box", (0.02, 0.4, 0.4), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), (0.5, 0.5, 0.5), picture)
    fields = {"mass": 0.0, "friction": 1.0, "rolling_friction": 0.0, "restitution": 0.0, **changes}
    return WorldObject("card", (1.01, 0.0, 0.5), (0.0, 0.0, math.pi), (part,), **fields)


@pytest.mark.parametrize("kind, size", [("box", (0.02, 0.4, 0.4)), ("sphere", (0.2,))])
def test_a_picture_on_a_thing_is_upright_and_not_mirrored(drawing, four_colors, kind, size):
    thing = card(four_colors, Shape(kind, size, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    picture = drawing.draw(replace(AWAY, placed=(thing,)), View.of_shot(shot()))
    red, green, blue = (middle(clear(picture, channel)) for channel in range(3))
    assert red[0] < 155 and red[1] < 115
    assert green[0] > 165 and green[1] < 115
    assert blue[0] < 155 and blue[1] > 125


def test_a_picture_covers_its_side_of_a_box_and_no_other(drawing, four_colors):
    behind = replace(card(four_colors), rpy=(0.0, 0.0, 0.0))
    picture = drawing.draw(replace(AWAY, placed=(behind,)), View.of_shot(shot()))
    assert all(np.count_nonzero(clear(picture, channel)) == 0 for channel in range(3))
    front = drawing.draw(replace(AWAY, placed=(card(four_colors),)), View.of_shot(shot()))
    rows, columns = np.nonzero(clear(front, 0))
    # A quarter of 0.4 m at 1 m, where 300 pixels are 1 m.
    assert (columns.min(), columns.max()) == pytest.approx((100, 160), abs=2)
    assert (rows.min(), rows.max()) == pytest.approx((60, 120), abs=2)


def test_what_was_placed_comes_moves_and_goes(drawing):
    view = View.of_shot(shot())
    part = Part(Shape("sphere", (0.05,), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), GREEN)
    ball = replace(card(None), name="ball", parts=(part,), position=(1.0, 0.2, 0.5))
    without = drawing.draw(AWAY, view)
    assert np.count_nonzero(clear(without, 1)) == 0
    assert middle(clear(drawing.draw(replace(AWAY, placed=(ball,)), view), 1))[0] == pytest.approx(100, abs=2)
    moved = replace(AWAY, placed=(ball,), objects={"ball": Pose((1.0, -0.2, 0.5), UNTURNED)})
    assert middle(clear(drawing.draw(moved, view), 1))[0] == pytest.approx(220, abs=2)
    assert np.array_equal(drawing.draw(AWAY, view), without)


def test_what_is_gone_is_not_seen_and_throws_no_shadow_and_its_name_may_come_again(drawing, engine):
    plate = {"name": "plate", "box": [0.4, 0.4, 0.02], "position": [1.2, 0.0, 0.3], "color": list(GREEN)}
    with_plate, view = engine(plate), View.of_shot(shot(rpy=(0.0, 0.25, 0.0)))
    there, gone = with_plate.draw(AWAY, view), with_plate.draw(replace(AWAY, gone=frozenset(["plate"])), view)
    assert np.count_nonzero(clear(there, 1)) > 300 and np.count_nonzero(clear(gone, 1)) == 0
    assert np.array_equal(gone, drawing.draw(AWAY, view))
    again = replace(card(None), name="plate", parts=(Part(Shape("sphere", (0.05,), (0, 0, 0), (0, 0, 0)), RED),))
    back = with_plate.draw(replace(AWAY, gone=frozenset(["plate"]), placed=(again,)), view)
    assert np.count_nonzero(clear(back, 0)) > 100 and np.count_nonzero(clear(back, 1)) == 0
    assert np.array_equal(with_plate.draw(AWAY, view), there)


def test_names_that_nothing_has_are_errors(drawing):
    ball, view = {"name": "ball", "sphere": 0.1, "position": [1, 0, 0.1]}, View.of_shot(shot())
    for wrong in ({"objects": {"bal": Pose((0.0, 0.0, 0.0), UNTURNED)}}, {"gone": frozenset(["bal"])}):
        with pytest.raises(UnknownName, match="unknown object 'bal': did you mean 'ball'"):
            drawing.draw(placed(ball, **wrong), view)


def test_a_thing_throws_a_shadow_that_goes_with_it(drawing):
    plate = {"name": "plate", "box": [0.3, 0.3, 0.02], "position": [1.2, 0.0, 0.35], "mass": 1.0}
    view = View.of_shot(shot(rpy=(0.0, 0.4, 0.0)))

    def darker(y):
        moved = placed(plate, objects={"plate": Pose((1.2, y, 0.35), UNTURNED)})
        near = replace(moved, base_position=(-1.0, 0.0, 0.333))
        difference = drawing.draw(near, replace(view, shadows=False)).astype(int) - drawing.draw(near, view)
        return difference[130:].sum(axis=2) > 60

    assert np.count_nonzero(darker(0.0)) > 100
    assert middle(darker(0.3))[0] < middle(darker(0.0))[0] - 20 < middle(darker(-0.3))[0] - 40


@pytest.mark.parametrize("camera", [0, 1])
def test_the_head_is_not_in_the_way_of_its_cameras(drawing, camera):
    """Nothing but the floor and the sky is to be seen of an empty world, and the same as without a robot."""
    view = from_head(STATE, camera)
    seen, without = drawing.draw(STATE, view).astype(int), drawing.draw(AWAY, view)
    changed = np.any(np.abs(seen - without) > 3, axis=2)
    if camera == 0:
        assert not changed.any()
    else:
        # Looking down, its own shadow and feet may be there, nothing above.
        assert not changed[:120].any()


def test_an_arm_that_is_raised_is_seen(drawing):
    angles = list(STATE.joint_positions)
    angles[MODEL.joint_index["LShoulderPitch"]] = -0.2
    angles[MODEL.joint_index["LShoulderRoll"]] = -0.2
    raised = replace(STATE, joint_positions=tuple(angles))
    view = from_head(raised)
    changed = np.any(np.abs(drawing.draw(raised, view).astype(int) - drawing.draw(STATE, view)) > 20, axis=2)
    assert changed.sum() > 3000 and middle(changed)[0] < 140  # on the left


def test_from_outside_the_robot_has_its_head_after_a_picture_from_inside(drawing):
    outside = replace(View.of_shot(shot((1.0, 0.0, 0.45), (0.0, 0.0, math.pi))), from_head=False)
    before = drawing.draw(STATE, outside)
    drawing.draw(STATE, from_head(STATE))
    assert np.array_equal(drawing.draw(STATE, outside), before)
    headless = drawing.draw(STATE, replace(outside, from_head=True))
    assert np.count_nonzero(np.any(headless != before, axis=2)) > 500


def test_other_robots_are_seen_with_their_heads_lights_and_postures(drawing):
    view = from_head(STATE)
    facing = (0.0, 0.0, 1.0, 0.0)
    dark = RobotLook((1.2, 0.0, 0.333), facing, STATE.joint_positions, (0.0,) * 89)
    alone = drawing.draw(STATE, view)
    one = drawing.draw(replace(STATE, others=(dark,)), view)
    assert np.count_nonzero(np.any(np.abs(one.astype(int) - alone) > 20, axis=2)) > 3000
    lit = replace(dark, led_values=(1.0,) * 89)
    glowing = drawing.draw(replace(STATE, others=(lit,)), view)
    assert np.count_nonzero(np.any(np.abs(glowing.astype(int) - one) > 40, axis=2)) > 20
    two = drawing.draw(replace(STATE, others=(dark, replace(dark, base_position=(1.2, 0.4, 0.333)))), view)
    assert np.count_nonzero(np.any(two[:, :100] != one[:, :100], axis=2)) > 1000
    assert np.array_equal(drawing.draw(STATE, view), alone)


def test_the_same_request_gives_the_same_bytes(engine):
    """In another process, after other pictures."""
    thing = {"name": "ball", "sphere": 0.1, "position": [1.0, 0.2, 0.1], "mass": 1.0}
    first, second = engine(thing), engine(thing)
    leds = (0.5,) * 89
    moved = replace(STATE, led_values=leds, objects={"ball": Pose((0.9, 0.0, 0.2), UNTURNED)})
    view = from_head(moved)
    expected = first.draw(moved, view)
    second.draw(STATE, View.of_shot(shot(width=160, height=120)))
    second.draw(replace(moved, gone=frozenset(["ball"])), view)
    second.draw(AWAY, replace(view, samples=2, shadows=False))
    assert np.array_equal(second.draw(moved, view), expected)
