"""What drawing works out before anything is drawn: rays, cameras of films, floors, what is in sight, what goes over."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from seen import AWAY, MODEL, STATE, UNTURNED, placed, shot

from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.render import PRESETS, Camera, preset_camera
from nao_sim_bridge.sim.render.backdrop import Backdrop
from nao_sim_bridge.sim.render.film_camera import CALM, EYE_LEVEL, FilmCamera
from nao_sim_bridge.sim.render.opengl.scene_block import projection, world_constants
from nao_sim_bridge.sim.render.opengl.shaders import constants
from nao_sim_bridge.sim.render.view import View
from nao_sim_bridge.sim.render.wire import StateReceiver, StateSender
from nao_sim_bridge.sim.world import load_world, world_names
from nao_sim_bridge.sim.world_reader import read_world

HERE = (0.0, 0.0, 0.0)
# --- cameras


def test_views_follow_the_robot_wherever_it_is_but_that_of_the_room_stays():
    turned = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
    elsewhere = replace(STATE, base_position=(2.0, 3.0, 0.333), base_orientation=turned)
    camera = preset_camera("front", MODEL, elsewhere)
    assert camera.eye[:2] == pytest.approx((2.0, 4.05)) and camera.target[:2] == pytest.approx((2.0, 3.0))
    assert preset_camera("room", MODEL, STATE) == preset_camera("room", MODEL, elsewhere)


def moved(x, z=EYE_LEVEL):
    return replace(STATE, base_position=(x, 0.0, z))


def test_a_film_begins_with_the_view_of_pictures_follows_slowly_and_neither_bobs_nor_turns():
    camera = FilmCamera("stage", MODEL, 64, 64, 1)
    first = camera.at(0.0, moved(0.0, z=0.05))
    assert first == preset_camera("stage", MODEL, moved(0.0), 64, 64, 1)
    turned = replace(moved(0.0, z=0.1), base_orientation=(0.0, 0.0, 1.0, 0.0))
    assert camera.at(5.0, turned) == first
    camera = FilmCamera("stage", MODEL, 64, 64, 1)
    start, soon, late = (np.array(camera.at(t, moved(x)).eye) for t, x in ((0.0, 0.0), (CALM, 1.0), (20.0, 1.0)))
    assert soon - start == pytest.approx([1.0 - np.exp(-1.0), 0.0, 0.0])
    assert late - start == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)
    for view in ("room", "face"):
        assert PRESETS[view].follows != "body"
        assert FilmCamera(view, MODEL, 64, 64, 1).at(1.0, STATE) == preset_camera(view, MODEL, STATE, 64, 64, 1)


# --- floors

RUG = {"center": [2.0, 0.5], "size": [0.4, 0.2], "yaw": 0.5, "color": [0.9, 0.1, 0.1]}


def floor_at(x, y, z=0.0, **floor):
    """Colour of the floor at a point, seen from the robot's side."""
    content = {"floor": {"friction": 1.0, **floor}, "light": {"direction": [0, 0, 1]}, "background": {"haze": 1000.0}}
    camera = Camera((x - 1.0, y, z + 1.0), (x, y, z), fov=0.3, width=41, height=41)
    return Backdrop(read_world(content, "test", "test.yaml")).draw(View.of_camera(camera), None)[20, 20].astype(float)


def test_a_rug_is_a_turned_rectangle_of_another_colour_also_on_a_slope():
    for along, across, inside in ((0, 0, True), (0.18, 0.08, True), (0.22, 0, False), (0, 0.12, False)):
        x = 2.0 + along * math.cos(0.5) - across * math.sin(0.5)
        y = 0.5 + along * math.sin(0.5) + across * math.cos(0.5)
        assert (floor_at(x, y, rugs=[RUG]) == pytest.approx(RUG["color"], abs=0.01)) is inside
    for height, inside in ((2.0 * math.tan(math.radians(10.0)), True), (0.0, False)):
        seen = floor_at(2.0, 0.5, height, rugs=[RUG], slope_deg=[10.0, 0.0])
        assert (seen == pytest.approx(RUG["color"], abs=0.01)) is inside


# --- OpenGL


@pytest.mark.parametrize("point, corner", [((1.0, 1.0), (1.0, -1.0)), ((-1.0, -1.0), (-1.0, 1.0)), ((0, 0), (0, 0))])
def test_the_first_row_of_a_picture_is_its_upper_one(point, corner):
    view = View.of_shot(shot())
    wide, high = view.tangents
    x, y, z, w = projection(view) @ (2.0 * point[0] * wide, 2.0 * point[1] * high, -2.0, 1.0)
    assert (x / w, y / w) == pytest.approx(corner) and -1.0 < z / w < 1.0


def test_a_level_floor_in_full_light_has_its_colour_of_the_file():
    """What comes from everywhere, from the lamp and from the second one makes one."""
    for values in (world_constants(load_world(name)) for name in world_names()):
        up = values["UP"]
        light = values["AMBIENT"] + values["LAMP_COLOR"] * (values["LAMP"] @ up) + max(values["FILL"] @ up, 0.0)
        assert light == pytest.approx(1.0, abs=0.02)
    text = "const float A = 0.5;\nconst vec3 B = vec3(1.0, 2.0, 1e-07);\n"
    assert constants({"A": 0.5, "B": np.array((1.0, 2.0, 1e-7))}) == text


# --- what goes over


def test_what_was_placed_goes_over_once():
    sender, receiver = StateSender(), StateReceiver()
    state = placed({"name": "ball", "sphere": 0.05, "position": [1.0, 0.2, 0.5]})
    elsewhere = replace(state, objects={"ball": Pose(HERE, UNTURNED)})
    first, again, moved, without = (sender.pack(one) for one in (state, state, elsewhere, AWAY))
    assert [packed[1] for packed in (first, again, moved, without)] == [state.placed, None, None, ()]
    assert receiver.unpack(first) == state
    assert receiver.unpack(again).placed is receiver.unpack(moved).placed
    assert receiver.unpack(without) == AWAY
