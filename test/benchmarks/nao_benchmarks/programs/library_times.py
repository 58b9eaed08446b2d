#!/usr/bin/env python3
"""Times what a script does with the simulator as a library, against what the bare engine would do.

Prints JSON: `ours` and `reference`, s of each run.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

from nao_benchmarks.printing import print_times
from nao_benchmarks.stats import Sample, interleave

from nao_sim_bridge import NaoSim
from nao_sim_bridge.base.memory_file import memory_file
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.urdf.physics import physics_urdf

IMPORTS = ("import nao_sim_bridge", "import pybullet, numpy")
TIMED = """
import pybullet, numpy, nao_sim_bridge, time
began = time.process_time()
{}
print(time.process_time() - began)
"""
FIRST = "simulation = nao_sim_bridge.NaoSim()"
LOADED = """
flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_SELF_COLLISION
pybullet.loadURDF("{}", flags=flags, physicsClientId=pybullet.connect(pybullet.DIRECT))
"""
STEPS_OF_TWO = 4000
TICKS = 3
"""In a step of an environment."""


def bare_steps(nao: NaoSim, count: int):
    """Steps of the engine alone, in the world of a robot."""
    step = nao._session.shared.physics.engine.stepSimulation

    def run() -> None:
        for _ in range(count):
            step()

    return run


def imports(rounds: int) -> list[Sample]:
    """An interpreter that imports the library, against one that imports what is under it."""

    def starts(statement: str) -> None:
        subprocess.run([sys.executable, "-c", statement], check=True, stdout=subprocess.DEVNULL)

    return interleave([lambda: starts(IMPORTS[0]), lambda: starts(IMPORTS[1])], rounds, warm_up=2)


def first(rounds: int) -> list[Sample]:
    """The first simulation of an interpreter, with what it imports, against its robot in a bare engine; CPU time."""

    def timed(program: str) -> float:
        command = [sys.executable, "-c", TIMED.format(program)]
        told = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, pass_fds=[robot], env=compiled)
        return float(told.stdout.split()[-1])

    compiled = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
    with memory_file(physics_urdf(load_model()).encode()) as path:
        robot = int(Path(path).name)
        times = [(timed(FIRST), timed(LOADED.format(path))) for _ in range(1 + rounds)][1:]
    return [Sample(one) for one in zip(*times)]


def resets(rounds: int) -> list[Sample]:
    """A reset with a new seed, against 40 steps of the engine."""
    return _resets(rounds, "empty")


def resets_with_things(rounds: int) -> list[Sample]:
    """The same in a world with things that can roll away, which is built anew."""
    return _resets(rounds, "lab")


def _resets(rounds: int, world: str) -> list[Sample]:
    with NaoSim(world=world) as nao:
        nao.reset(0)
        seeds = iter(range(1, 10 * rounds + 1000))

        def reset() -> None:
            nao.reset(next(seeds))

        return interleave([reset, lambda: bare_steps(nao, 40)()], rounds, warm_up=10)


def driven(rounds: int) -> list[Sample]:
    """What a step of an environment lets the simulator do, against as many steps of the engine."""
    with NaoSim() as nao:
        stand = list(nao.commands.values())
        count = TICKS * nao._session.shared.settings.steps_per_tick
        return interleave([lambda: nao.drive(stand, ticks=TICKS), bare_steps(nao, count)], rounds, warm_up=50)


def two_processes(rounds: int) -> list[Sample]:
    """Two simulations at once on two processors, against one after the other."""
    program = [sys.executable, __file__, "steps", "--rounds", "1"]

    def together() -> None:
        for process in [subprocess.Popen(program, stdout=subprocess.DEVNULL) for _ in range(2)]:
            process.wait()

    def in_turn() -> None:
        for _ in range(2):
            subprocess.run(program, check=True, stdout=subprocess.DEVNULL)

    return interleave([together, in_turn], rounds)


def steps(_: int) -> list[Sample]:
    """For `two_processes`: some seconds of simulated time."""
    with NaoSim() as nao:
        began = time.perf_counter()
        nao.step(STEPS_OF_TWO * nao.tick_s)
        lasted = time.perf_counter() - began
    return [Sample((lasted,)), Sample((lasted,))]


WHAT = {one.__name__: one for one in (imports, first, resets, resets_with_things, driven, two_processes, steps)}


def measure(what: str, rounds: int) -> dict[str, list[float]]:
    """Time one of them."""
    ours, reference = WHAT[what](rounds)
    return {"ours": list(ours.seconds), "reference": list(reference.seconds)}


if __name__ == "__main__":
    sys.exit(print_times(measure, __doc__, 200, ("what", {"choices": sorted(WHAT), "help": "what to time"})))
