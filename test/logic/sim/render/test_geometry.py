"""What drawing works out before anything is drawn: views, cameras of films, the projection, light."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from seen import MODEL, STATE, shot

from nao_sim_bridge.render.film_camera import CALM, EYE_LEVEL, FilmCamera
from nao_sim_bridge.render.opengl.scene_block import projection, world_constants
from nao_sim_bridge.render.opengl.shaders import constants
from nao_sim_bridge.render.scene.view import View
from nao_sim_bridge.world.reader import load_world, world_names
from nao_sim_bridge.world.render_state import PRESETS, preset_camera


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
