"""Places of the robot and the frames that ALMotion speaks in."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.frames import FEET, ROBOT, WORLD, Placement, commanded, frame_of, robot_in_world, space_in_torso
from nao_sim_bridge.sim.kinematics import link_transforms, rpy_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
STAND = posture(MODEL, "Stand")
TORSO = transform(rpy_matrix((0.0, 0.0, 3.0)), (1.0, 2.0, 0.3))


@pytest.fixture
def placed():
    return Placement(link_transforms(MODEL, STAND), TORSO)


def test_the_robot_frame_is_between_the_feet_and_looks_where_they_point(placed):
    frame = space_in_torso(MODEL, ROBOT, placed)
    feet = [np.linalg.inv(frame) @ placed.in_torso(frame_of(MODEL, name)) for name in FEET]
    assert feet[0][:2, 3] + feet[1][:2, 3] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert feet[0][0, 0] == pytest.approx(feet[1][0, 0], abs=1e-3)
    assert robot_in_world(MODEL, placed)[2, 2] == pytest.approx(1.0)


def test_the_torso_in_the_world_frame_is_where_it_was_put(placed):
    assert np.linalg.inv(space_in_torso(MODEL, WORLD, placed)) == pytest.approx(TORSO)


def test_commands_that_bend_the_legs_lower_the_torso_and_keep_the_support_foot(placed):
    asked = commanded(MODEL, posture(MODEL, "Crouch"), placed)
    foot = frame_of(MODEL, "LLeg")
    assert asked.torso_in_world @ asked.in_torso(foot) == pytest.approx(TORSO @ placed.in_torso(foot))
    assert asked.torso_in_world[2, 3] < TORSO[2, 3] - 0.03


def test_sensors_have_places_and_unknown_ones_are_refused():
    assert frame_of(MODEL, "CameraTop").link == "HeadPitch"
    with pytest.raises(UnknownName, match="CameraTop"):
        frame_of(MODEL, "CamraTop")
