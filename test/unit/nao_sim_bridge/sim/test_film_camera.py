"""The camera of a film: calm, and where the robot is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nao_sim_bridge.sim.render.film_camera import CALM, EYE_LEVEL, FilmCamera
from nao_sim_bridge.sim.render.scene import PRESETS, preset_camera
from nao_sim_bridge.sim.simulation import Scene, Simulation


@pytest.fixture(scope="module")
def stage():
    """A model and what it looks like."""
    simulation = Simulation(Scene(posture="Stand"))
    yield simulation.model, simulation.render_state(simulation.snapshot)
    simulation.close()


def moved(state, x, y=0.0, z=EYE_LEVEL):
    return replace(state, base_position=(x, y, z))


def test_it_begins_with_the_view_of_pictures_at_eye_level(stage):
    model, state = stage
    first = FilmCamera("stage", model, 64, 64, 1).at(0.0, moved(state, 0.0, z=0.05))
    assert first == preset_camera("stage", model, moved(state, 0.0), 64, 64, 1)


def test_it_follows_slowly_and_gets_there(stage):
    model, state = stage
    camera = FilmCamera("stage", model, 64, 64, 1)
    start = np.array(camera.at(0.0, moved(state, 0.0)).eye)
    soon = np.array(camera.at(CALM, moved(state, 1.0)).eye) - start
    late = np.array(camera.at(20.0, moved(state, 1.0)).eye) - start
    assert soon == pytest.approx([1.0 - np.exp(-1.0), 0.0, 0.0])
    assert late == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)


def test_it_neither_bobs_nor_turns_with_the_robot(stage):
    model, state = stage
    camera = FilmCamera("stage", model, 64, 64, 1)
    first = camera.at(0.0, moved(state, 0.0))
    turned = replace(moved(state, 0.0, z=0.1), base_orientation=(0.0, 0.0, 1.0, 0.0))
    assert camera.at(5.0, turned) == first


def test_views_of_the_room_and_of_the_face_are_those_of_pictures(stage):
    model, state = stage
    for view in ("room", "face"):
        assert PRESETS[view].follows != "body"
        assert FilmCamera(view, model, 64, 64, 1).at(1.0, state) == preset_camera(view, model, state, 64, 64, 1)
