#!/usr/bin/env python3
"""Times ticks of a world with several robots, awake, against ticks of one robot that has a world for itself.

With --walking all of them walk. Prints JSON: `ours` and `reference`, s of processor time of each tick.
"""

from __future__ import annotations

import sys
import time

from nao_benchmarks.printing import print_times
from nao_benchmarks.robots import SETTLE_S, alternate, check, stiffen, walk

from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.world.places import RobotPlace

ROBOTS = 3
APART = 2.0
"""Distance of two robots, m: they do not meet on their circles."""


def awake(count: int) -> list[Simulation]:
    """Robots in one world that stand stiff and still."""
    scene = Scene(posture="Stand")
    shared = SharedWorld(scene)
    robots = [Simulation(scene, shared=shared, place=RobotPlace(0.0, APART * number)) for number in range(count)]
    for robot in robots:
        stiffen(robot)
    robots[0].run(SETTLE_S)
    return robots


def time_ticks(rounds: int, walking: bool) -> dict[str, list[float]]:
    """Alternate ticks of both worlds.

    Raises:
        BenchmarkError: If a robot does something else.
    """
    several, one = awake(ROBOTS), awake(1)
    if walking:
        walk(*several)
        walk(*one)

    def check_all() -> None:
        for robots in (several, one):
            for number, robot in enumerate(robots, start=1):
                check(robot, walking, f"robot {number} of {len(robots)}")

    return alternate(several[0], one[0], rounds, check_all, time.thread_time)


if __name__ == "__main__":
    sys.exit(print_times(time_ticks, __doc__, 2000, ("--walking", {"action": "store_true"})))
