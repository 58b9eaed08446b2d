#!/usr/bin/env python3
"""Times ticks of a robot that moves every joint against ticks of its twin that stands still.

Prints JSON: `ours` and `reference`, s of each tick.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.robots import alternate, awake, check

from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.core.simulation import Simulation

# rad; small enough to stand by, and long enough to last.
SWING = 0.02
SWING_S = 2.0
SWINGS = 200


def keep_moving(simulation: Simulation) -> None:
    """Start one task that swings all joints to and fro, into their ranges."""
    joints = simulation.model.joints
    times = tuple(SWING_S * i for i in range(SWINGS))

    def build(commands: Sequence[float]) -> dict[int, SmoothCurve]:
        curves = {}
        for index, (joint, at) in enumerate(zip(joints, commands)):
            away = at + SWING if at + SWING < joint.upper else at - SWING
            curves[index] = SmoothCurve(times, tuple(at if i % 2 == 0 else away for i in range(SWINGS)))
        return curves

    simulation.robot.motion.follow("angleInterpolation", range(len(joints)), build)


def check_moves(simulation: Simulation, still: Simulation) -> None:
    """See that one robot moved its joints, the other did not, and both stand.

    Raises:
        BenchmarkError: If that is not so.
    """
    if not all(simulation.robot.joints.velocities):
        raise BenchmarkError("not every joint of the moving robot moves")
    if any(still.robot.joints.velocities):
        raise BenchmarkError("the robot that should stand still moves")
    for each in (simulation, still):
        check(each, walks=False)


def time_ticks(rounds: int) -> dict[str, list[float]]:
    """Alternate ticks of two robots, one of which moves.

    Raises:
        BenchmarkError: If one of them does something else.
    """
    moving, still = awake(), awake()
    keep_moving(moving)
    return alternate(moving, still, rounds, lambda: check_moves(moving, still))


if __name__ == "__main__":
    sys.exit(print_times(time_ticks, __doc__, 2000))
