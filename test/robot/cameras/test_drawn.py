"""The cameras of a simulation, drawn by the real renderer."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.places import CameraPlaces
from nao_sim_bridge.sim.cameras.stream import CameraClosed
from nao_sim_bridge.sim.kinematics import quaternion_matrix
from nao_sim_bridge.sim.runner import FASTEST, SimulationRunner
from nao_sim_bridge.sim.simulation import Scene, Simulation

PATIENCE = 60.0


@pytest.mark.parametrize(
    "camera, place, yaw", [(0, (1.5, 0.2, 0.5), 0.0), (0, (1.0, 0.8, 0.4), 0.6), (1, (0.45, 0.05, 0.06), 0.0)]
)
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


def frames_of_a_fast_run(seconds):
    """Every frame of a robot that lifts its head, while time runs as fast as it can; by number."""
    simulation = Simulation(Scene(world="lab", posture="Stand", seed=3))
    runner = SimulationRunner(simulation, FASTEST, paused=True)
    runner.start()
    head = simulation.model.joint_index["HeadPitch"]

    def begin():
        simulation.robot.motion.set_stiffness_now({joint: 1.0 for joint in range(26)})
        simulation.robot.motion.set_targets({head: -0.3}, {head: 0.5})
        return simulation.cameras.open("every", 0, 0, 11, 30, every=True)

    stream, frames = runner.call(begin, PATIENCE), {}

    def take():
        while True:
            try:
                frame = stream.take(PATIENCE)
            except CameraClosed:
                return
            frames[frame.number] = frame

    taker = threading.Thread(target=take)
    taker.start()
    runner.advance(seconds).result(PATIENCE)
    stream.finish()
    taker.join(PATIENCE)
    runner.stop()
    assert stream.dropped == 0
    return frames


def test_fast_runs_see_every_frame_and_always_the_same():
    first, second = (frames_of_a_fast_run(0.5) for _ in range(2))
    assert sorted(first) == sorted(second) == list(range(15))
    assert [frame.time for frame in first.values()] == pytest.approx([(1 + 4 * n) / 120 for n in range(15)])
    assert all(first[number].data == second[number].data for number in first)
    assert np.abs(first[14].array().astype(int) - first[0].array()).mean() > 5, "the head has moved"
    assert first[0].pose_in_torso[4] - first[14].pose_in_torso[4] > 0.1
