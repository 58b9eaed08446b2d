#!/usr/bin/env python3
"""Sends the robot from every posture to every other one under physics and prints how it went. Needs no ROS master.

A cell holds the time the change took in s of simulated time, and behind a `+` the moves that missed on the way. One in
capitals failed: where the robot ended, or FELL when it lay on the floor without wanting to. With --falls the robot is
pushed over instead, from all sides, and has to stand up.
"""

from __future__ import annotations

import argparse
import logging
import math
import random
import sys
from dataclasses import dataclass

from walk_trial import SIDES

from nao_sim_bridge.control.balance.posture_recognition import LYING, UNKNOWN, lean_of, recognise
from nao_sim_bridge.core.posture_change import PostureChange
from nao_sim_bridge.core.posture_graph import ON_FEET
from nao_sim_bridge.core.posture_moves import load_moves
from nao_sim_bridge.core.simulation import Scene, Simulation
from nao_sim_bridge.model.postures import load_postures, posture

# Time to come to rest before a change, and the longest a change may take, s.
SETTLE_TIME, PATIENCE = 1.5, 90.0
# Time from a push until the robot gets up, s.
LIE_TIME = 3.0


@dataclass(frozen=True)
class Outcome:
    """How one change of posture ended: whether it got there without a fall, and how long it took, s.

    `misses` are moves that led somewhere else, `text` is what the table shows, `reason` why it failed, if it did.
    """

    reached: bool
    time: float
    misses: int
    text: str
    reason: str


def change(start: str, goal: str, speed: float, noise: float, seed: int) -> Outcome:
    """One change of posture at a share of the joints' top speeds; `noise` is how far they are off at the start, rad."""
    simulation = Simulation(Scene(posture=start))
    try:
        _settle(simulation, start, noise, random.Random(f"{start} {goal} {seed}"))
        seen = recognise(simulation.model, simulation.snapshot)
        if seen.family != load_postures().by_name[start].family:
            return Outcome(False, 0.0, 0, f"BEGAN {seen.family}", f"the start settled in {seen.family}")
        return attempt(simulation, goal, speed, may_lie=not _from_feet(start, goal))
    finally:
        simulation.close()


def attempt(simulation: Simulation, goal: str, speed: float, may_lie: bool) -> Outcome:
    """One change of posture from wherever the robot is; if it `may_lie`, a torso near the floor is no fall."""
    begun = simulation.time
    way = PostureChange(simulation.robot, lambda: simulation.snapshot, goal, speed, 3, load_moves())
    task = way.start()
    fell = False
    while not task.finished and simulation.time < begun + PATIENCE:
        roll, pitch, _ = simulation.tick().imu.angles
        fell = fell or not (may_lie or lean_of(roll, pitch) < LYING)
    took = simulation.time - begun
    if not task.value:
        ended = recognise(simulation.model, simulation.snapshot)
        name = ended.family if ended.posture == UNKNOWN else ended.posture
        return Outcome(False, took, way.misses, name.upper(), way.failure or f"not there after {PATIENCE:g} s")
    if fell:
        return Outcome(False, took, way.misses, "FELL", "it fell on the way")
    return Outcome(True, took, way.misses, f"{took:.1f}" + (f"+{way.misses}" if way.misses else ""), "")


def stand_up(angle: float, speed: float, seed: int) -> tuple[str, Outcome]:
    """Push the robot over towards about an angle of `SIDES` and let it stand up; how it lay, and what became of it."""
    simulation = Simulation(Scene(posture="Stand"))
    try:
        chance = random.Random(f"{angle} {seed}")
        _settle(simulation, "Stand", 0.0, chance)
        simulation.run(chance.uniform(0.0, 0.2))
        turn, force = math.radians(angle + chance.gauss(0.0, 15.0)), chance.uniform(40.0, 70.0)
        simulation.robot.push((force * math.cos(turn), force * math.sin(turn), 0.0), 0.2)
        simulation.run(LIE_TIME)
        lay = recognise(simulation.model, simulation.snapshot).family
        return lay, attempt(simulation, "Stand", speed, may_lie=True)
    finally:
        simulation.close()


def check_falls(count: int, speed: float, seed: int) -> bool:
    """Push the robot over `count` times from each side; prints what came of it, True when it stood up every time."""
    good = True
    for side, angle in SIDES.items():
        ends = [stand_up(angle, speed, seed + run) for run in range(count)]
        lay = ", ".join(sorted({family for family, _ in ends}))
        up = [outcome for _, outcome in ends if outcome.reached]
        longest = max((outcome.time for outcome in up), default=0.0)
        misses = sum(outcome.misses for _, outcome in ends)
        print(
            f"{side}: {len(up)} of {count} stood up, within {longest:.1f} s, {misses} misses; lay in {lay}", flush=True
        )
        good = good and len(up) == count
    return good


def _from_feet(start: str, goal: str) -> bool:
    """Whether a change has no reason to leave the feet."""
    return all(load_postures().by_name[name].family in ON_FEET for name in (start, goal))


def _settle(simulation: Simulation, start: str, noise: float, chance: random.Random) -> None:
    """Stiff, at rest, in the posture but for the noise."""
    aims = posture(simulation.model, start)
    body = range(len(aims))
    simulation.robot.motion.set_stiffness_now(dict.fromkeys(body, 1.0))
    targets = {i: aims[i] + chance.uniform(-noise, noise) for i in body}
    simulation.robot.motion.set_targets(targets, dict.fromkeys(body, 0.5))
    simulation.run(SETTLE_TIME)


def table(outcomes: dict[tuple[str, str], Outcome]) -> str:
    """Starts down, goals across."""
    starts = list(dict.fromkeys(start for start, _ in outcomes))
    goals = list(dict.fromkeys(goal for _, goal in outcomes))
    rows = [["from \\ to", *goals]]
    for start in starts:
        cells = [outcomes[start, goal].text if (start, goal) in outcomes else "-" for goal in goals]
        rows.append([start, *cells])
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def parse(arguments: list[str] | None = None) -> argparse.Namespace:
    """Options of the command line."""
    names = sorted(load_postures().by_name)
    parser = argparse.ArgumentParser(prog="check_posture_graph", description=__doc__)
    parser.add_argument("--start", nargs="+", choices=names, default=names, metavar="POSTURE", help="begin in these")
    parser.add_argument("--goal", nargs="+", choices=names, default=names, metavar="POSTURE", help="go to these")
    parser.add_argument("--speed", type=float, default=1.0, help="share of the joints' top speeds (default 1)")
    parser.add_argument(
        "--noise", type=float, default=0.0, help="deviation of each joint at the start, rad (default 0)"
    )
    parser.add_argument("--seed", type=int, default=0, help="of the noise (default 0)")
    parser.add_argument("--falls", type=int, metavar="N", help="push the robot over N times from each side instead")
    parser.add_argument("--verbose", action="store_true", help="log every move")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """Try all changes; 0 when every one got there."""
    options = parse(arguments)
    logging.basicConfig(level=logging.INFO if options.verbose else logging.ERROR, format="%(message)s")
    if options.falls:
        return 0 if check_falls(options.falls, options.speed, options.seed) else 1
    outcomes = {}
    for start in options.start:
        for goal in options.goal:
            if start != goal:
                outcome = change(start, goal, options.speed, options.noise, options.seed)
                outcomes[start, goal] = outcome
                print(f"{start} -> {goal}: {outcome.text} {outcome.reason}".rstrip(), flush=True)
    reached = sum(outcome.reached for outcome in outcomes.values())
    print(f"\n{table(outcomes)}\n\n{reached} of {len(outcomes)} changes reached their posture")
    return 0 if reached == len(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
