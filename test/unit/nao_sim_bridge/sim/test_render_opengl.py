"""What drawing with OpenGL works out before anything is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from seen import AWAY, GREEN, placed, shot

from nao_sim_bridge.sim.render.engines import open_engine
from nao_sim_bridge.sim.render.opengl.items import spheres_in_sight
from nao_sim_bridge.sim.render.opengl.scene_block import projection, world_constants
from nao_sim_bridge.sim.render.opengl.shaders import constants
from nao_sim_bridge.sim.render.view import NEAR, View
from nao_sim_bridge.sim.world import load_world, world_names


def test_what_reaches_into_the_picture_is_never_left_out():
    """Spheres about anywhere, and points on each: if one of the points is in the picture, the sphere is drawn."""
    chance = np.random.default_rng(5)
    centers, radii = chance.uniform(-2.0, 2.0, (400, 3)), chance.uniform(0.01, 0.5, 400)
    directions = chance.normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    tangents = (0.54, 0.40)
    kept = spheres_in_sight(centers, radii, tangents, NEAR)
    points = centers[:, None] + radii[:, None, None] * directions
    ahead = points[..., 2]
    seen = (ahead > NEAR) & (np.abs(points[..., :2]) < ahead[..., None] * tangents).all(axis=2)
    assert seen.any(axis=1).sum() > 20
    assert not (seen.any(axis=1) & ~kept).any()
    assert kept.sum() < 200


@pytest.mark.parametrize("point, corner", [((1.0, 1.0), (1.0, -1.0)), ((-1.0, -1.0), (-1.0, 1.0)), ((0, 0), (0, 0))])
def test_the_first_row_of_a_picture_is_its_upper_one(point, corner):
    view = View.of_shot(shot())
    wide, high = view.tangents
    x, y, z, w = projection(view) @ (2.0 * point[0] * wide, 2.0 * point[1] * high, -2.0, 1.0)
    assert (x / w, y / w) == pytest.approx(corner)
    assert -1.0 < z / w < 1.0


@pytest.mark.parametrize("name", world_names())
def test_a_level_floor_in_full_light_has_its_colour_of_the_file(name):
    """What comes from everywhere, from the lamp and from the second one makes one."""
    values = world_constants(load_world(name))
    up = values["UP"]
    light = values["AMBIENT"] + values["LAMP_COLOR"] * (values["LAMP"] @ up) + max(values["FILL"] @ up, 0.0)
    assert light == pytest.approx(1.0, abs=0.02)


def test_numbers_become_constants_of_a_program():
    assert constants({"A": 0.5, "B": np.array((1.0, 2.0, 1e-7))}) == (
        "const float A = 0.5;\nconst vec3 B = vec3(1.0, 2.0, 1e-07);\n"
    )


def test_small_and_far_things_have_fewer_triangles_and_the_same_place():
    """A ball that shrinks below the size where that begins does not jump."""
    drawing, _ = open_engine("opengl", load_world("empty"), "V6")
    view = View.of_shot(shot(width=640, height=480))
    empty = drawing.draw(AWAY, view).astype(int)
    middles = []
    for radius in (0.0165, 0.0175):  # 9.9 and 10.5 pixels at 1 m
        ball = {"name": "ball", "sphere": radius, "position": [1.0, 0.1, 0.55], "color": list(GREEN)}
        changed = np.any(np.abs(drawing.draw(placed(ball), view) - empty) > 40, axis=2)
        middles.append(np.argwhere(changed).mean(axis=0))
        assert changed.sum() == pytest.approx(np.pi * (598.0 * radius) ** 2, rel=0.12)
    drawing.close()
    assert middles[0] == pytest.approx(middles[1], abs=0.4)
