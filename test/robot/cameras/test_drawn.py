"""The cameras of a simulation, drawn by the real renderer."""

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.places import CameraPlaces
from nao_sim_bridge.sim.kinematics import quaternion_matrix

PATIENCE = 60.0


@pytest.mark.parametrize("camera, place, yaw", [(0, (1.0, 0.8, 0.4), 0.6), (1, (0.45, 0.05, 0.06), 0.0)])
def test_a_ball_is_where_projection_says(bench, world_file, camera, place, yaw):
    ball = f"{{name: ball, sphere: 0.05, position: {list(place)}, color: [0.9, 0.05, 0.05]}}"
    made = bench(world=world_file(ball))
    made.aim(HeadYaw=yaw)
    made.run(1.5)
    stream = made.simulation.cameras.open("test", camera, 2, 11, 30)
    made.run(0.1)
    rgb = stream.take(PATIENCE).array().astype(int)
    rows, columns = np.nonzero((rgb[..., 0] > 60) & (rgb[..., 0] > 2.0 * rgb[..., 1:].max(axis=2)))
    assert len(rows) > 50
    places = CameraPlaces(made.model)
    position, orientation = places.in_world(made.simulation.render_state(made.now), camera)
    x, y = places.optics[camera].project(quaternion_matrix(orientation).T @ (np.array(place) - position))
    assert (columns.mean() + 0.5, rows.mean() + 0.5) == pytest.approx((x * 640, y * 480), abs=2.0)
