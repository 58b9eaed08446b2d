#!/usr/bin/env python3
"""Times ticks of a robot that stands awake against bare physics steps of the same robot in the same state.

The server has all its services registered; nobody calls them. Prints JSON: `ours` and `reference`, s of each tick.
"""

from __future__ import annotations

import math
import sys

import qi
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.stats import interleave

from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.physics import Physics
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Scene, Simulation
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer
from nao_sim_bridge.world.reader import load_world

SETTLE_S = 2.0
LIMIT = 60.0
# Two robots that stand alike: m.
SAME_HEIGHT = 0.005


def bare_twin(simulation: Simulation) -> Physics:
    """The engine alone: the same robot in the same world, told once to hold the same angles, at rest."""
    snapshot, settings = simulation.snapshot, simulation.settings
    twin = Physics(simulation.model, load_world(simulation.scene.world), settings, snapshot.positions)
    joints = JointCommands(simulation.model, snapshot.commands)
    joints.set_stiffness(dict(enumerate(snapshot.stiffnesses)))
    twin.drive(joints)
    for _ in range(round(SETTLE_S / settings.tick_s)):
        twin.step()
    return twin


def time_ticks(simulation: Simulation, rounds: int) -> dict[str, list[float]]:
    """Alternate our ticks with bare ones; in the simulation thread.

    Raises:
        BenchmarkError: If the two robots are not alike at the end.
    """
    twin = bare_twin(simulation)
    step, steps = twin.engine.stepSimulation, range(simulation.settings.steps_per_tick)

    def bare_tick() -> None:
        for _ in steps:
            step()

    try:
        ours, bare = interleave([simulation.tick, bare_tick], rounds, warm_up=100)
        check_alike(simulation.snapshot, twin)
    finally:
        twin.close()
    return {"ours": list(ours.seconds), "reference": list(bare.seconds)}


def check_alike(snapshot: Snapshot, twin: Physics) -> None:
    """See that both robots stand awake: a fallen one has other contacts, and other costs.

    Raises:
        BenchmarkError: If they do not.
    """
    ours, bare = snapshot.torso.position[2], twin.read_body().pose.position[2]
    if not all(snapshot.stiffnesses):
        raise BenchmarkError("the robot is not awake: not every joint is stiff")
    if not math.isclose(ours, bare, abs_tol=SAME_HEIGHT):
        raise BenchmarkError(f"the robots do not stand alike: torsos {ours:.3f} m and {bare:.3f} m high")


def measure(rounds: int) -> dict[str, list[float]]:
    """Time ticks of a server that somebody has connected to, between its turns."""
    server = SimulatorServer(ServerOptions(Scene(posture="Stand"), port=0, speed=math.inf))
    server.start()
    session = qi.Session()
    try:
        session.connect(f"tcp://127.0.0.1:{server.broker.port}")
        session.service("ALMotion").wakeUp()
        server.runner.pause()
        return server.runner.call(lambda: time_ticks(server.simulation, rounds), LIMIT)
    finally:
        session.close()
        server.stop()


if __name__ == "__main__":
    sys.exit(print_times(measure, __doc__, 2000))
