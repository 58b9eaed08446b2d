"""The cameras of a simulation, drawn by the real renderer."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.kinematics import quaternion_matrix

PATIENCE = 60.0


def red_center(frame):
    """Mean place of what is red, in pixels, and how many pixels that are."""
    rgb = frame.array().astype(int)
    rows, columns = np.nonzero((rgb[..., 0] > 60) & (rgb[..., 0] > 2.0 * rgb[..., 1:].max(axis=2)))
    return np.array((columns.mean() + 0.5, rows.mean() + 0.5)) if len(rows) else None, len(rows)


@pytest.fixture
def world_with_ball(tmp_path):
    def write(x, y, z):
        path = tmp_path / "ball.yaml"
        ball = f"{{name: ball, sphere: 0.05, position: [{x}, {y}, {z}], color: [0.9, 0.05, 0.05]}}"
        path.write_text(f"floor: {{friction: 1.0}}\nobjects:\n- {ball}\n")
        return str(path)

    return write


@pytest.mark.parametrize(
    "camera, place, yaw", [(0, (1.5, 0.2, 0.5), 0.0), (0, (1.0, 0.8, 0.4), 0.6), (1, (0.45, 0.05, 0.06), 0.0)]
)
def test_a_ball_is_where_projection_says(bench, world_with_ball, camera, place, yaw):
    made = bench(world=world_with_ball(*place))
    made.aim(HeadYaw=yaw)
    made.run(1.5)
    cameras = made.simulation.cameras
    stream = cameras.open("test", camera, 2, 11, 30)
    made.run(0.1)
    frame = stream.take(PATIENCE)
    center, count = red_center(frame)
    assert count > 50
    state = made.simulation.render_state(made.now)
    position, orientation = cameras._places.in_world(state, camera)
    x, y = cameras.optics(camera).project(quaternion_matrix(orientation).T @ (np.array(place) - position))
    assert center == pytest.approx((x * 640, y * 480), abs=2.0)
