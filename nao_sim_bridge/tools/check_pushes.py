#!/usr/bin/env python3
"""Pushes the standing robot from all sides and prints how often it stays on its feet. Needs no ROS master.

Each push takes 0.1 s and acts on the torso; its direction, its moment and the joint angles vary a little from run to
run. A cell tells how many of the runs survived. With --falls it prints instead how long before torso, head or an upper
arm hits the floor the fall manager noticed the fall.
"""

from __future__ import annotations

import argparse
import logging
import math
import random
import sys
from dataclasses import dataclass
from typing import Iterable, Sequence

from walk_trial import BODY, PUSH_TIME, SIDES

from nao_sim_bridge.core.simulation import Scene, Simulation

POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")
# Longest time to fall or to settle after a push, s.
PATIENCE = 4.0
# How much runs differ: joint angles in rad, direction in degrees, wait before the push in s.
JOINT_NOISE, TURN_NOISE, WAIT = 0.01, 10.0, (0.8, 1.3)
# A torso that has sunk by this much, m, has fallen.
SUNK = 0.1
# Back in the posture: m, rad.
NEAR, LEAN = 0.01, math.radians(1.0)


@dataclass(frozen=True)
class Outcome:
    """How one push ended.

    Attributes:
        survived: The robot is on its feet.
        back: It is in its posture again, within 1 cm and 1 degree.
        noticed: When the fall manager raised its alarm, s after the push began; None when it did not.
        impact: When torso, head or an upper arm hit the floor; None when they did not.
    """

    survived: bool
    back: bool
    noticed: float | None
    impact: float | None


def push(simulation: Simulation, impulse: float, angle: float, seed: int, watch: bool = True) -> Outcome:
    """Reset a simulation and push its robot once.

    Args:
        impulse: N s.
        angle: Where the push goes, degrees.
        seed: Of what differs between runs; 0 for no differences.
        watch: Whether the fall manager is on.
    """
    chance = random.Random(seed)
    simulation.reset()
    robot = simulation.robot
    robot.stability.falls.enabled = watch
    joints = range(len(simulation.model.joints))
    robot.motion.set_stiffness_now(dict.fromkeys(joints, 1.0))
    if seed:
        angle += chance.uniform(-TURN_NOISE, TURN_NOISE)
        noisy = {i: robot.joints.commands[i] + chance.uniform(-JOINT_NOISE, JOINT_NOISE) for i in joints}
        robot.motion.set_targets(noisy, dict.fromkeys(noisy, 1.0))
    before = simulation.run(chance.uniform(*WAIT))
    force, heading = impulse / PUSH_TIME, math.radians(angle)
    robot.push((force * math.cos(heading), force * math.sin(heading), 0.0), PUSH_TIME)
    noticed = impact = None
    while simulation.snapshot.time < before.time + PATIENCE and impact is None:
        now = simulation.tick()
        if noticed is None and robot.stability.falls.falling:
            noticed = now.time - before.time
        if any(robot.link_name(contact.link) in BODY for contact in now.contacts):
            impact = now.time - before.time
    end = simulation.snapshot
    survived = end.torso.position[2] > before.torso.position[2] - SUNK and noticed is None
    lean = max(abs(a - b) for a, b in zip(end.imu.angles[:2], before.imu.angles[:2]))
    moved = abs(end.torso.position[2] - before.torso.position[2])
    return Outcome(survived, survived and lean < LEAN and moved < NEAR, noticed, impact)


def check_pushes(postures: Iterable[str], impulses: Sequence[float], runs: int) -> int:
    """Print the table of survived pushes; returns how many runs of the smallest impulse fell."""
    print("posture    side   " + "".join(f"{impulse:7.1f} N s" for impulse in impulses) + "   false alarms  not back")
    fallen = 0
    for posture in postures:
        simulation = Simulation(Scene(posture=posture))
        for side, angle in SIDES.items():
            cells, alarms, away = [], 0, 0
            for impulse in impulses:
                survived = 0
                for seed in range(1, runs + 1):
                    outcome = push(simulation, impulse, angle, seed)
                    survived += outcome.survived
                    away += outcome.survived and not outcome.back
                    if outcome.noticed is not None:
                        alarms += push(simulation, impulse, angle, seed, watch=False).survived
                cells.append(f"{survived:4d} of {runs:2d}")
                fallen += impulse == impulses[0] and runs - survived
            print(f"{posture:10s} {side:6s} " + " ".join(f"{cell:>10s}" for cell in cells) + f"{alarms:12d}{away:10d}")
        simulation.close()
    return fallen


def check_falls(postures: Iterable[str], impulse: float, runs: int) -> int:
    """Print how early falls are noticed; returns how many were not before the impact."""
    print(f"posture    direction   noticed   impact   lead (least) [s]   pushes of {impulse} N s")
    late = 0
    for posture in postures:
        simulation = Simulation(Scene(posture=posture))
        for angle in range(0, 360, 45):
            seen = [push(simulation, impulse, angle, seed) for seed in range(1, runs + 1)]
            falls = [(o.noticed, o.impact) for o in seen if o.noticed is not None and o.impact is not None]
            late += sum(o.noticed is None and o.impact is not None for o in seen)
            if not falls:
                print(f"{posture:10s} {angle:6d} deg   no falls")
                continue
            noticed, impact = (sum(times) / len(falls) for times in zip(*falls))
            least = min(b - a for a, b in falls)
            print(
                f"{posture:10s} {angle:6d} deg   {noticed:7.2f}  {impact:7.2f}   {impact - noticed:.2f} ({least:.2f})"
            )
        simulation.close()
    return late


def main() -> int:
    """Push, print, and tell by the exit status whether all was well."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--postures", nargs="+", choices=POSTURES, default=["Stand", "StandInit"])
    parser.add_argument("--impulses", nargs="+", type=float, default=[2.0, 2.5, 3.0], metavar="N_S", help="in N s")
    parser.add_argument("--runs", type=int, default=10, help="of each push (default 10)")
    parser.add_argument("--falls", action="store_true", help="how early falls are noticed; takes the largest impulse")
    options = parser.parse_args()
    # Noise on the joints goes over their limits now and then: no news here.
    logging.getLogger("nao_sim.motion").setLevel(logging.ERROR)
    if options.falls:
        return check_falls(options.postures, max(options.impulses), options.runs) > 0
    return check_pushes(options.postures, sorted(options.impulses), options.runs) > 0


if __name__ == "__main__":
    sys.exit(main())
