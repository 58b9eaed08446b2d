#!/usr/bin/env python3
"""Times ticks of a robot that walks against ticks of its twin that stands still.

With --controller it times what the walk computes in each of those ticks against the physics steps of the same tick.
Prints JSON: `ours` and `reference`, s of processor time of each tick.
"""

from __future__ import annotations

import argparse
import sys
import time
from typing import Any, Callable

import pybullet
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.robots import awake
from nao_benchmarks.stats import interleave

from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.walk.gait import FeetGait

# Until the walk has its speed.
START_S = 4.0
# A circle, m/s, m/s, rad/s: it never leaves the level ground near the origin.
VELOCITY = (0.07, 0.0, 0.2)


class Stopwatch:
    """A callable that adds up how long it takes.

    Attributes:
        seconds: Of all calls since somebody last set it to 0.

    Args:
        call: What it calls.
    """

    def __init__(self, call: Callable[..., Any]) -> None:
        self._call = call
        self.seconds = 0.0

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        began = time.thread_time()
        try:
            return self._call(*args, **kwargs)
        finally:
            self.seconds += time.thread_time() - began


def walking() -> Simulation:
    """A robot that walks a circle."""
    simulation = awake()
    simulation.robot.locomotion.move(*VELOCITY, FeetGait())
    simulation.run(START_S)
    return simulation


def check_walks(simulation: Simulation) -> None:
    """See that a robot walks.

    Raises:
        BenchmarkError: If it does not.
    """
    if not simulation.robot.locomotion.active:
        raise BenchmarkError("the robot that should walk does not")
    if not any(simulation.robot.locomotion.velocity()):
        raise BenchmarkError("the robot that should walk makes no way")


def check_stands(simulation: Simulation) -> None:
    """See that a robot stands still.

    Raises:
        BenchmarkError: If it does not.
    """
    if simulation.robot.locomotion.active or simulation.snapshot.torso.position[2] < 0.25:
        raise BenchmarkError("the robot that should stand still does not")


def time_ticks(rounds: int) -> dict[str, list[float]]:
    """Alternate ticks of two robots, one of which walks.

    Raises:
        BenchmarkError: If one of them does something else.
    """
    ours, still = walking(), awake()
    try:
        taken, reference = interleave([ours.tick, still.tick], rounds, warm_up=100, clock=time.thread_time)
        check_walks(ours)
        check_stands(still)
    finally:
        ours.close()
        still.close()
    return {"ours": list(taken.seconds), "reference": list(reference.seconds)}


def time_controller(rounds: int) -> dict[str, list[float]]:
    """Time the walk's own part and the physics of each tick.

    Raises:
        BenchmarkError: If the robot does not walk.
    """
    simulation = walking()
    locomotion = simulation.robot.locomotion
    step = pybullet.stepSimulation
    controller, physics = Stopwatch(locomotion.tick), Stopwatch(step)
    locomotion.tick, pybullet.stepSimulation = controller, physics
    ours, reference = [], []
    try:
        for _ in range(rounds):
            controller.seconds = physics.seconds = 0.0
            simulation.tick()
            ours.append(controller.seconds)
            reference.append(physics.seconds)
        check_walks(simulation)
    finally:
        pybullet.stepSimulation = step
        simulation.close()
    if not (min(ours) > 0.0 and min(reference) > 0.0):
        raise BenchmarkError("the walk or the physics is called elsewhere than where it is timed")
    return {"ours": ours, "reference": reference}


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=2000, help="ticks to measure")
    parser.add_argument("--controller", action="store_true", help="the walk's own part against the physics")
    options = parser.parse_args()
    measure = time_controller if options.controller else time_ticks
    return print_times(lambda: measure(options.rounds))


if __name__ == "__main__":
    sys.exit(main())
