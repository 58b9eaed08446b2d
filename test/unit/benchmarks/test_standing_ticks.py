"""The program that compares ticks with bare steps must compare the same robot in the same state."""

from __future__ import annotations

import json

import pytest
from nao_benchmarks.errors import BenchmarkError

from nao_sim_bridge.sim.simulation import Scene, Simulation


@pytest.fixture
def awake():
    simulation = Simulation(Scene(posture="Stand"))
    simulation.robot.joints.set_stiffness(dict.fromkeys(range(len(simulation.model.joints)), 1.0))
    simulation.run(1.0)
    yield simulation
    simulation.close()


def test_the_twin_stands_like_the_robot(program, awake):
    twin = program.bare_twin(awake)
    try:
        joints, body = twin.read_joints(), twin.read_body()
        feet = {contact.link for contact in twin.read_contacts()}
    finally:
        twin.close()
    assert joints.positions == pytest.approx(awake.snapshot.positions, abs=0.01)
    assert body.pose.position[2] == pytest.approx(awake.snapshot.torso.position[2], abs=0.002)
    assert feet == {contact.link for contact in awake.snapshot.contacts}


def test_ours_and_bare_are_timed_equally_often_and_time_passes_for_both(program, awake):
    before = awake.time
    times = json.loads(json.dumps(program.time_ticks(awake, rounds=20)))
    assert len(times["ours"]) == len(times["reference"]) == 20
    assert min(times["ours"] + times["reference"]) > 0.0
    # The warm-up counts for time, not for the figures.
    assert awake.time - before > 20 * awake.settings.tick_s


def test_a_limp_robot_is_not_measured(program):
    simulation = Simulation(Scene(posture="Stand"))
    try:
        with pytest.raises(BenchmarkError, match="not awake"):
            program.time_ticks(simulation, rounds=2)
    finally:
        simulation.close()


def test_a_robot_that_lies_is_not_like_one_that_stands(program, awake):
    twin = program.bare_twin(awake)
    try:
        twin.place(awake.snapshot.positions)
        for _ in range(150):
            twin.step({"torso": (60.0, 0.0, 0.0)})
        with pytest.raises(BenchmarkError, match="do not stand alike"):
            program.check_alike(awake.snapshot, twin)
    finally:
        twin.close()
