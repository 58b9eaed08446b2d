"""Where head and arms go to look and point at places, checked against the kinematics of the robot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import link_transforms
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.tracking.geometry import (
    HEAD,
    arm_angles,
    distance_of,
    head_angles,
    seen_place,
    turn_to,
)

MODEL = load_model()
PLACES = [(1.0, 0.0, 0.2), (1.0, 0.6, 0.5), (0.5, -0.4, 0.1), (2.0, 1.5, -0.3)]


def pose(name, angles):
    """(4, 4) of a frame in the torso for joint angles by name; the others are 0."""
    body = [angles.get(joint.name, 0.0) for joint in MODEL.joints]
    frame = frame_of(MODEL, name)
    return link_transforms(MODEL, body)[frame.link] @ frame.offset


def off(frame, place):
    """Angle between the X axis of a frame and the way from it to a place, rad."""
    way = np.linalg.inv(frame) @ np.array((*place, 1.0))
    return math.acos(way[0] / np.linalg.norm(way[:3]))


@pytest.mark.parametrize("place", PLACES)
def test_the_camera_looks_at_the_place(place):
    angles = dict(zip(HEAD, head_angles(MODEL, place)))
    assert off(pose("CameraTop", angles), place) < 1e-6


def test_the_other_camera_looks_there_with_the_head_higher():
    place = (1.0, 0.2, -0.2)
    yaw, pitch = head_angles(MODEL, place, camera=1)
    assert pitch < head_angles(MODEL, place)[1] - 0.5
    assert off(pose("CameraBottom", dict(zip(HEAD, (yaw, pitch)))), place) < 1e-6


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.1265), (-1.0, 0.1, 0.2), (0.1, 0.0, -1.0), (0.0, 0.0, 5.0)])
def test_places_out_of_reach_stay_within_the_limits(place):
    for name, angle in zip(HEAD, head_angles(MODEL, place)):
        joint = MODEL.joints[MODEL.joint_index[name]]
        assert joint.lower <= angle <= joint.upper


@pytest.mark.parametrize("arm, side", [("LArm", 1.0), ("RArm", -1.0)])
@pytest.mark.parametrize("height", [-0.3, 0.1, 0.6])
def test_the_arm_points_at_the_place(arm, side, height):
    place = (1.0, 0.4 * side, height)
    assert off(pose(arm, arm_angles(MODEL, arm, place)), place) < math.radians(4.0)


def test_what_a_camera_sees_is_where_its_ray_goes():
    camera = (0.1, 0.2, 0.5, 0.0, 0.3, 0.7)
    place = seen_place(camera, 0.0, 0.0, 2.0)
    assert math.dist(place, camera[:3]) == pytest.approx(2.0)
    assert math.atan2(place[1] - 0.2, place[0] - 0.1) == pytest.approx(0.7)
    left = seen_place((0.0,) * 6, 0.3, 0.0, 1.0)
    assert left[1] > 0.0
    assert seen_place((0.0,) * 6, 0.0, 0.3, 1.0)[2] < 0.0


def test_a_thing_half_as_wide_is_twice_as_far():
    assert distance_of(0.1, 0.1) == pytest.approx(1.0, abs=0.01)
    assert distance_of(0.1, 0.05) == pytest.approx(2.0, abs=0.01)


def test_the_shortest_turn_is_never_more_than_half_a_turn():
    assert turn_to(3.0, -3.0) == pytest.approx(2.0 * math.pi - 6.0)
    assert turn_to(0.2, 0.5) == pytest.approx(0.3)
