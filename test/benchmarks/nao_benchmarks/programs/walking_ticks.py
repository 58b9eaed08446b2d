#!/usr/bin/env python3
"""Times ticks of a robot that walks against ticks of its twin that stands still.

With --controller it times what the walk computes in each of those ticks against the physics steps of the same tick.
Prints JSON: `ours` and `reference`, s of processor time of each tick.
"""

from __future__ import annotations

import sys
import time
from typing import Any, Callable

from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.robots import alternate, awake, check, walk

from nao_sim_bridge.core.simulation import Simulation


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
    walk(simulation)
    return simulation


def time_walk(rounds: int) -> dict[str, list[float]]:
    """Alternate ticks of two robots, one of which walks.

    Raises:
        BenchmarkError: If one of them does something else.
    """
    ours, still = walking(), awake()

    def check_both() -> None:
        check(ours, walks=True)
        check(still, walks=False)

    return alternate(ours, still, rounds, check_both, time.thread_time)


def time_controller(rounds: int) -> dict[str, list[float]]:
    """Time the walk's own part and the physics of each tick.

    Raises:
        BenchmarkError: If the robot does not walk.
    """
    simulation = walking()
    locomotion = simulation.robot.locomotion
    engine = simulation.physics.engine
    controller, physics = Stopwatch(locomotion.tick), Stopwatch(engine.stepSimulation)
    locomotion.tick, engine.stepSimulation = controller, physics
    ours, reference = [], []
    try:
        for _ in range(rounds):
            controller.seconds = physics.seconds = 0.0
            simulation.tick()
            ours.append(controller.seconds)
            reference.append(physics.seconds)
        check(simulation, walks=True)
    finally:
        simulation.close()
    if not (min(ours) > 0.0 and min(reference) > 0.0):
        raise BenchmarkError("the walk or the physics is called elsewhere than where it is timed")
    return {"ours": ours, "reference": reference}


def measure(rounds: int, controller: bool) -> dict[str, list[float]]:
    """Whichever was asked for."""
    return time_controller(rounds) if controller else time_walk(rounds)


if __name__ == "__main__":
    sys.exit(print_times(measure, __doc__, 2000, ("--controller", {"action": "store_true"})))
