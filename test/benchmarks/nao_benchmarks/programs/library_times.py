#!/usr/bin/env python3
"""Times what a script does with the simulator as a library, against what the bare engine would do.

Prints JSON: `ours` and `reference`, s of each run.
"""

from __future__ import annotations

import subprocess
import sys
import time

from nao_benchmarks.printing import print_times
from nao_benchmarks.stats import Sample, interleave

from nao_sim_bridge import NaoSim

IMPORTS = ("import nao_sim_bridge", "import pybullet, numpy")
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


def resets(rounds: int) -> list[Sample]:
    """A reset with a new seed, against 40 steps of the engine."""
    with NaoSim() as nao:
        nao.reset(0)
        seeds = iter(range(1, 10 * rounds + 1000))

        def reset() -> None:
            nao.reset(next(seeds))

        return interleave([reset, bare_steps(nao, 40)], rounds, warm_up=10)


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


WHAT = {one.__name__: one for one in (imports, resets, driven, two_processes, steps)}


def measure(what: str, rounds: int) -> dict[str, list[float]]:
    """Time one of them."""
    ours, reference = WHAT[what](rounds)
    return {"ours": list(ours.seconds), "reference": list(reference.seconds)}


if __name__ == "__main__":
    sys.exit(print_times(measure, __doc__, 200, ("what", {"choices": sorted(WHAT), "help": "what to time"})))
