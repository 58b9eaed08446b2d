"""Simulated robots for programs that time ticks."""

from __future__ import annotations

import time
from typing import Callable

from nao_sim_bridge.core.simulation import Scene, Simulation
from nao_sim_bridge.walk.gait import FeetGait

from .errors import BenchmarkError
from .stats import interleave

SETTLE_S = 1.0
# Until a walk has its speed.
START_S = 4.0
# A circle, m/s, m/s, rad/s: it never leaves the level ground near where it begins.
VELOCITY = (0.07, 0.0, 0.2)
FALLEN = 0.25


def awake() -> Simulation:
    """A robot that stands stiff and still."""
    simulation = Simulation(Scene(posture="Stand"))
    stiffen(simulation)
    simulation.run(SETTLE_S)
    return simulation


def stiffen(simulation: Simulation) -> None:
    """Switch all motors of a robot on."""
    simulation.robot.motion.set_stiffness_now(dict.fromkeys(range(len(simulation.model.joints)), 1.0))


def walk(*robots: Simulation) -> None:
    """Let all robots of a world walk circles."""
    for robot in robots:
        robot.robot.locomotion.move(*VELOCITY, FeetGait())
    robots[0].run(START_S)


def check(robot: Simulation, walks: bool, which: str = "the robot") -> None:
    """See that a robot walks, or that it stands still.

    Raises:
        BenchmarkError: If it does not.
    """
    locomotion = robot.robot.locomotion
    if locomotion.active != walks or robot.snapshot.torso.position[2] < FALLEN:
        raise BenchmarkError(f"{which} does not {'walk' if walks else 'stand still'}")
    if walks and not any(locomotion.velocity()):
        raise BenchmarkError(f"{which} that should walk makes no way")


def alternate(
    ours: Simulation,
    reference: Simulation,
    rounds: int,
    check_both: Callable[[], None],
    clock: Callable[[], float] = time.perf_counter,
) -> dict[str, list[float]]:
    """Times of ticks of two simulations in turns, which are checked then, and closed.

    Raises:
        BenchmarkError: If one of them did something else, as `check_both` finds.
    """
    try:
        samples = interleave([ours.tick, reference.tick], rounds, warm_up=100, clock=clock)
        check_both()
    finally:
        ours.close()
        reference.close()
    return {name: list(sample.seconds) for name, sample in zip(("ours", "reference"), samples)}
