"""Where the cameras are."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.places import CameraPlaces
from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, rpy_matrix, transform


def test_the_cameras_are_where_the_tables_say(head):
    """Upright, with the head straight: only the cameras' own pitch is left."""
    places = CameraPlaces(head.model)
    head.positions = (0.0,) * 26
    state = head._look(head.snapshot())
    position, orientation = places.in_world(state, 0)
    assert position == pytest.approx((0.05871, 0.0, 0.33 + 0.1265 + 0.06364))
    axis = quaternion_matrix(orientation)[:, 0]
    assert axis == pytest.approx((math.cos(0.0209), 0.0, -math.sin(0.0209)))
    assert quaternion_matrix(places.in_world(state, 1)[1])[:, 0] == pytest.approx(
        (math.cos(0.6929), 0.0, -math.sin(0.6929))
    )


def test_the_true_place_follows_head_and_torso(head):
    places = CameraPlaces(head.model)
    turned = (0.5, -0.3, *head.positions[2:])
    state = head._look(head.snapshot())
    state = type(state)((1.0, 2.0, 0.3), (0.0, 0.0, math.sin(0.4), math.cos(0.4)), turned, state.led_values)
    position, orientation = places.in_world(state, 0)
    frame = frame_of(head.model, "CameraTop")
    torso = transform(quaternion_matrix(state.base_orientation), state.base_position)
    expected = torso @ link_transforms(head.model, turned)["HeadPitch"] @ frame.offset
    assert transform(quaternion_matrix(orientation), position) == pytest.approx(expected)


def test_the_robot_believes_what_its_sensors_say(bench):
    """As ALMotion.getPosition with sensors; the frame of the robot is on the floor between the feet."""
    made = bench(sensor_noise=1.0)
    made.aim(HeadYaw=0.4, HeadPitch=0.2)
    made.run(1.0)
    places, snapshot = CameraPlaces(made.model), made.now
    in_torso, in_robot = places.measured(snapshot, 0)
    frame = frame_of(made.model, "CameraTop")
    expected = link_transforms(made.model, snapshot.positions)["HeadPitch"] @ frame.offset
    assert transform(rpy_matrix(in_torso[3:]), in_torso[:3]) == pytest.approx(expected)
    assert snapshot.positions != made.robot.true_positions
    assert in_robot[2] == pytest.approx(0.45, abs=0.08)
    assert in_robot[5] == pytest.approx(0.4, abs=0.06)
    truth = places.in_world(made.simulation.render_state(snapshot), 0)[0]
    assert np.hypot(*in_robot[:2]) < 0.15 and truth[2] == pytest.approx(in_robot[2], abs=0.02)
