"""Fixtures of the levels robot and slow."""

from __future__ import annotations

from dataclasses import replace

import pytest
from module_goals import ModuleGoals
from simulator import Simulator

from nao_sim_bridge.core.simulation import Scene, Simulation


@pytest.fixture(scope="session")
def shared_robot(tmp_path_factory):
    simulator = Simulator(tmp_path_factory.mktemp("records"), speed=float("inf"))
    yield simulator
    simulator.close()


@pytest.fixture
def robot(shared_robot):
    """A robot that has just started: it stands, limp; time stands still."""
    shared_robot.fresh()
    return shared_robot


@pytest.fixture
def stiff_robot(robot):
    """The robot with stiff motors."""
    robot.ALMotion.setStiffnesses("Body", 1.0)
    return robot


@pytest.fixture
def goals_to(robot):
    """Makes modules under test: `goals_to(NaoLights, NaoLedGoal)`."""
    made = []

    def make(kind, goal, **options):
        made.append(ModuleGoals(kind, goal, robot, **options))
        return made[-1]

    yield make
    for one in made:
        one.close()


@pytest.fixture
def lights(goals_to):
    from nao_library_actions.msg import NaoLedGoal
    from nao_library_modules.lights.lights_server import NaoLights

    return goals_to(NaoLights, NaoLedGoal)


class Bench:
    """A simulation without server and thread: commands by joint name, and time that passes when asked."""

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
        joints = [self.model.joint_index[name] for name in names] or range(26)
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
def bench():
    """Makes simulations, stiff and standing unless asked for something else."""
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


@pytest.fixture
def told(robot):
    """Values of an event that an action leads to, each with the time, s after the begin of the action."""

    def of(event, action):
        values, begin = [], robot.now.time
        robot.server.memory.listen(event, lambda value: values.append((value, robot.now.time - begin)))
        action()
        return list(values)

    return of
