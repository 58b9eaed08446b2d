#!/usr/bin/env python3
"""Times ticks of a world with several robots, awake, against ticks of one robot that has a world for itself.

With --walking all of them walk. Prints JSON: `ours` and `reference`, s of processor time of each tick.
"""

from __future__ import annotations

import argparse
import sys
import time

from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.robots import SETTLE_S
from nao_benchmarks.stats import interleave

from nao_sim_bridge.sim.places import RobotPlace
from nao_sim_bridge.sim.scene import Scene
from nao_sim_bridge.sim.shared_world import SharedWorld
from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.walk.gait import FeetGait

ROBOTS = 3
APART = 2.0
"""Distance of two robots, m: they do not meet on their circles."""
START_S = 4.0
VELOCITY = (0.07, 0.0, 0.2)
FALLEN = 0.25


def awake(count: int) -> list[Simulation]:
    """Robots in one world that stand stiff and still."""
    scene = Scene(posture="Stand")
    shared = SharedWorld(scene)
    robots = [Simulation(scene, shared=shared, place=RobotPlace(0.0, APART * number)) for number in range(count)]
    for robot in robots:
        robot.robot.motion.set_stiffness_now(dict.fromkeys(range(len(robot.model.joints)), 1.0))
    robots[0].run(SETTLE_S)
    return robots


def walk(robots: list[Simulation]) -> None:
    """Let all of them walk circles."""
    for robot in robots:
        robot.robot.locomotion.move(*VELOCITY, FeetGait())
    robots[0].run(START_S)


def check(robots: list[Simulation], walking: bool) -> None:
    """See that all of them do what they should.

    Raises:
        BenchmarkError: If one does not.
    """
    for number, robot in enumerate(robots):
        if robot.robot.locomotion.active != walking or robot.snapshot.torso.position[2] < FALLEN:
            raise BenchmarkError(f"robot {number + 1} of {len(robots)} does not {'walk' if walking else 'stand still'}")


def time_ticks(rounds: int, walking: bool) -> dict[str, list[float]]:
    """Alternate ticks of both worlds.

    Raises:
        BenchmarkError: If a robot does something else.
    """
    several, one = awake(ROBOTS), awake(1)
    try:
        if walking:
            walk(several)
            walk(one)
        worlds = [several[0].tick, one[0].tick]
        taken, reference = interleave(worlds, rounds, warm_up=100, clock=time.thread_time)
        check(several, walking)
        check(one, walking)
    finally:
        several[0].close()
        one[0].close()
    return {"ours": list(taken.seconds), "reference": list(reference.seconds)}


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=2000, help="ticks to measure")
    parser.add_argument("--walking", action="store_true", help="all robots walk")
    options = parser.parse_args()
    return print_times(lambda: time_ticks(options.rounds, options.walking))


if __name__ == "__main__":
    sys.exit(main())
