#!/usr/bin/env python3
"""Times ticks of a robot that moves every joint against ticks of its twin that stands still.

Prints JSON: `ours` and `reference`, s of each tick.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence

from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.robots import awake
from nao_benchmarks.stats import interleave

from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.simulation import Simulation

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
        if each.snapshot.torso.position[2] < 0.25:
            raise BenchmarkError("a robot has fallen")


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=2000, help="ticks to measure")
    rounds = parser.parse_args().rounds
    moving, still = awake(), awake()
    keep_moving(moving)
    try:
        ours, reference = interleave([moving.tick, still.tick], rounds, warm_up=100)
        check_moves(moving, still)
    except BenchmarkError as error:
        print(error)
        return 1
    print(json.dumps({"ours": ours.seconds, "reference": reference.seconds}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
