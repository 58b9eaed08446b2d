"""Simulations of all kinds, freed after the test that made them."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.simulation import Scene, Simulation

BODY = range(26)
PATIENCE = 15.0
"""Longest wait for something that must happen, in s; passing tests do not come near it."""


class Bench:
    """A simulation on the bench: commands by joint name, and time that passes when asked."""

    def __init__(self, scene, stiffness):
        self.simulation = Simulation(scene)
        self.model = self.simulation.model
        if stiffness:
            self.stiffen(stiffness)

    @property
    def robot(self):
        return self.simulation.robot

    @property
    def now(self):
        return self.simulation.snapshot

    def stiffen(self, stiffness, *names):
        joints = [self.model.joint_index[name] for name in names] or BODY
        self.robot.motion.set_stiffness_now({joint: stiffness for joint in joints})

    def aim(self, speed=1.0, **targets):
        """Set targets in rad at `speed` in rad/s."""
        indices = {self.model.joint_index[name]: angle for name, angle in targets.items()}
        self.robot.motion.set_targets(indices, {index: speed for index in indices})

    def joint(self, name, of="positions"):
        return getattr(self.now, of)[self.model.joint_index[name]]

    def push(self, force, duration, link="torso"):
        self.robot.push(force, duration, link)

    def run(self, seconds):
        return self.simulation.run(seconds)

    def watch(self, seconds):
        """The snapshots of the next `seconds`."""
        return [self.simulation.tick() for _ in range(round(seconds / self.simulation.settings.tick_s))]


@pytest.fixture
def change_file(tmp_path, monkeypatch):
    """Has a module read its FILE of the package after a change of the content."""

    def change_for(module, change):
        content = json.loads(config_file(module.FILE).read_text())
        change(content)
        path = tmp_path / module.FILE
        path.write_text(json.dumps(content))
        monkeypatch.setattr(module, "config_file", lambda name: path)

    return change_for


@pytest.fixture(scope="session")
def patience():
    return PATIENCE


@pytest.fixture
def bench():
    """Makes simulations that are stiff and stand, unless asked for something else."""
    made = []

    def make(posture="Stand", stiffness=1.0, **scene):
        made.append(Bench(replace(Scene(posture=posture), **scene), stiffness))
        return made[-1]

    yield make
    for one in made:
        one.simulation.close()


@pytest.fixture
def world_file(tmp_path):
    """Writes a world of objects in YAML; returns its path."""

    def write(*objects):
        path = tmp_path / "world.yaml"
        path.write_text("floor: {friction: 1.0}\nobjects:\n" + "".join(f"- {entry}\n" for entry in objects))
        return str(path)

    return write
