"""Worlds in pictures: rugs, slopes, the shadows of furniture, and the view of the whole room."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.render import Camera, RenderState, preset_camera
from nao_sim_bridge.sim.render.backdrop import Backdrop
from nao_sim_bridge.sim.render.engines import open_engine
from nao_sim_bridge.sim.render.view import View
from nao_sim_bridge.sim.world_reader import read_world

RUG = {"center": [2.0, 0.5], "size": [0.4, 0.2], "yaw": 0.5, "color": [0.9, 0.1, 0.1]}
PLATE = {"name": "plate", "box": [0.4, 0.4, 0.02], "position": [2.5, 0.0, 0.5]}
OVERHEAD = {"direction": [0.0, 0.0, 1.0]}
CLEAR = {"haze": 1000.0}
MODEL = load_model()
STATE = RenderState((0.0, 0.0, 0.333), (0.0, 0.0, 0.0, 1.0), posture(MODEL, "Stand"), (0.0,) * 89)


def world(floor=None, *objects):
    content = {"floor": {"friction": 1.0, **(floor or {})}, "light": OVERHEAD, "background": CLEAR}
    return read_world({**content, "objects": list(objects)}, "test", "test.yaml")


def looking_at(x, y, z=0.0):
    """A small camera whose middle pixel is at a point of the floor, seen from the robot's side."""
    return Camera((x - 1.0, y, z + 1.0), (x, y, z), fov=0.3, width=41, height=41)


def middle(picture):
    return picture[20, 20].astype(float)


@pytest.fixture(params=["opengl", "builtin"])
def studio(request):
    """Makes engines that are freed after the test."""
    made = []

    def make(of):
        made.append(open_engine(request.param, of, "V6")[0])
        return made[-1]

    yield make
    for one in made:
        one.close()


@pytest.mark.parametrize(
    "along, across, inside", [(0.0, 0.0, True), (0.18, 0.08, True), (0.22, 0, False), (0, 0.12, False)]
)
def test_a_rug_is_a_turned_rectangle_of_another_colour(along, across, inside):
    x = 2.0 + along * math.cos(0.5) - across * math.sin(0.5)
    y = 0.5 + along * math.sin(0.5) + across * math.cos(0.5)
    seen = middle(Backdrop(world({"rugs": [RUG]})).draw(View.of_camera(looking_at(x, y)), None))
    assert (seen == pytest.approx(RUG["color"], abs=0.01)) is inside


def test_the_floor_of_a_slope_is_seen_where_it_is():
    """The rug is 2 m ahead on the slope: the ray to that point meets it, one to the level floor below does not."""
    backdrop = Backdrop(world({"rugs": [RUG], "slope_deg": [10.0, 0.0]}))
    height = 2.0 * math.tan(math.radians(10.0))
    assert middle(backdrop.draw(View.of_camera(looking_at(2.0, 0.5, height)), None)) == pytest.approx(
        RUG["color"], abs=0.01
    )
    assert middle(backdrop.draw(View.of_camera(looking_at(2.0, 0.5, 0.0)), None)) != pytest.approx(
        RUG["color"], abs=0.01
    )


def test_furniture_far_from_the_robot_throws_a_shadow(studio):
    with_plate, without = studio(world({}, PLATE)), studio(world())
    # Low enough to look under the plate.
    camera = Camera((1.5, 0.0, 0.3), (2.5, 0.0, 0.0), fov=0.2, width=41, height=41)
    dark, bright = (
        middle(with_plate.draw(STATE, View.of_camera(camera))),
        middle(without.draw(STATE, View.of_camera(camera))),
    )
    assert np.all(dark < 0.75 * bright)
    beside = replace(camera, eye=(1.5, 0.6, 0.3), target=(2.5, 0.6, 0.0))
    assert middle(with_plate.draw(STATE, View.of_camera(beside))) == pytest.approx(
        middle(without.draw(STATE, View.of_camera(beside))), abs=2.0
    )


def test_the_shadow_of_what_can_be_moved_goes_with_it(studio):
    moving = studio(world({}, {**PLATE, "mass": 1.0}, {**PLATE, "name": "still", "position": [-3.0, 0.0, 0.5]}))
    camera = Camera((1.5, 0.0, 0.3), (2.5, 0.0, 0.0), fov=0.2, width=41, height=41)
    here = replace(STATE, objects={"plate": Pose((2.5, 0.0, 0.5), (0.0, 0.0, 0.0, 1.0))})
    gone = replace(STATE, objects={"plate": Pose((2.5, 1.5, 0.5), (0.0, 0.0, 0.0, 1.0))})
    assert np.all(
        middle(moving.draw(here, View.of_camera(camera))) < 0.75 * middle(moving.draw(gone, View.of_camera(camera)))
    )


def test_two_shadows_on_each_other_are_no_darker_than_one(studio):
    under = {**PLATE, "position": [0.6, 0.0, 0.5]}
    one = studio(world({}, under))
    both = studio(world({}, under, {**under, "name": "lid", "position": [0.6, 0.0, 0.6], "mass": 1.0}))
    camera = Camera((0.6, -1.2, 0.3), (0.6, 0.0, 0.0), fov=0.2, width=41, height=41)
    assert middle(both.draw(STATE, View.of_camera(camera))) == pytest.approx(
        middle(one.draw(STATE, View.of_camera(camera))), abs=3.0
    )


def test_the_view_of_the_room_stays_where_it_is():
    elsewhere = replace(STATE, base_position=(1.0, 1.0, 0.3), base_orientation=(0.0, 0.0, 1.0, 0.0))
    assert preset_camera("room", MODEL, STATE) == preset_camera("room", MODEL, elsewhere)
