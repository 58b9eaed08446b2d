#!/usr/bin/env python3
"""Measures how the simulated robot walks and prints each figure beside its bound. Needs no ROS master.

Whatever is measured is what really happens in the physics, not what the robot believes. The exit status is 1 when a
figure misses its bound. Everything takes about half an hour of processor time; with --jobs above 1, several processes
(needs the extra `[sweep]`). Parts can be chosen by name:

  speeds     speed, deviation, odometry and joint speeds of a minute at one velocity
  wander     random orders, changing every 2 s, for minutes; sensors like a real robot's, here and below
  pushed     the same, with a push of 1 N s every 2 s
  push       one push of 2 N s from each side, at any phase of a step
  falls      pushes of 3 N s: falls are noticed before the impact, and the robot stands up again
  targets    walks to a place from random starts
  grounds    friction, slopes, bumps, a load
  stops      stopped or cancelled at random moments
"""

from __future__ import annotations

import logging
import math
import sys
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from typing import Any, Callable, Iterable, Iterator, List, Mapping, Sequence

import walk_runs
from command_line import parse, parts_parser

from nao_sim_bridge.sweep import ray_running, sweep

MAX_STEP_X, MAX_STEP_Y = {"MaxStepX": 0.06}, {"MaxStepY": 0.16}
# Velocity, gait, which part of the velocity counts, and what it must be at least, SI.
SPEEDS = {
    "forward": ((0.0952, 0.0, 0.0), {}, 0, 0.095),
    "forward, MaxStepX 0.06": ((0.1428, 0.0, 0.0), MAX_STEP_X, 0, 0.14),
    "backward": ((-0.07, 0.0, 0.0), {}, 0, -0.07),
    "to the left, MaxStepY 0.16": ((0.0, 0.07, 0.0), MAX_STEP_Y, 1, 0.07),
    "to the right, MaxStepY 0.16": ((0.0, -0.07, 0.0), MAX_STEP_Y, 1, -0.07),
    "turning left": ((0.0, 0.0, 0.8), {}, 2, 0.8),
    "turning right": ((0.0, 0.0, -0.8), {}, 2, -0.8),
}
# How much of the velocity asked for must come out.
SHARE = 0.98
SIDES = ("front", "left", "back", "right")
FRICTIONS = (0.4, 0.6, 0.8, 1.0, 1.2)
SLOPE, DIRECTIONS = 3.0, 8
LOAD = 0.1
# Time on each ground, s, and the least way, m, which is half of what would come out on a level floor.
GROUND_TIME, GROUND_WAY = 20.0, 0.7
NINE_OF_TEN = 0.9


@dataclass(frozen=True)
class Line:
    """A line of the table: what was measured, what came out and what must, in words, and whether it did."""

    what: str
    figure: str
    bound: str
    kept: bool


@dataclass(frozen=True)
class Extent:
    """How much to measure.

    Attributes:
        runs: Of everything that depends on chance; None for what each part takes by itself.
        seconds: Of every walk at one velocity.
        minutes: Of every walk by random orders.
    """

    runs: int | None
    seconds: float
    minutes: float
    first: int

    def seeds(self, usual: int) -> range:
        """Seeds of a part that usually takes so many runs."""
        return range(self.first, self.first + (self.runs or usual))


# Runs a function with each of the tuples of arguments; results in their order.
Runner = Callable[[Callable[..., Any], Sequence[tuple]], List[Mapping[str, Any]]]


def speeds(run: Runner, extent: Extent) -> Iterator[Line]:
    """Speed, deviation, odometry, joints' speeds."""
    arguments = [(velocity, gait, extent.seconds) for velocity, gait, _, _ in SPEEDS.values()]
    for (name, (_, _, axis, least)), made in zip(SPEEDS.items(), run(walk_runs.straight, arguments)):
        unit = "rad/s" if axis == 2 else "m/s"
        speed = made[("x", "y", "theta")[axis]]
        fell = "" if made["up"] else ", fell"
        kept = made["up"] and speed / least >= SHARE
        yield Line(name, f"{speed:.4f} {unit}{fell}", f"{least * SHARE:.4f}", kept)
        if axis != 2:
            aside, degrees, odometry = made["aside"], math.degrees(made["turn"]), made["odometry"]
            yield Line("  to the side", f"{aside * 100.0:.2f} cm/m", "at most 1", aside <= 0.01)
            yield Line("  heading", f"{degrees:.2f} deg/m", "at most 1", degrees <= 1.0)
            yield Line("  odometry", f"{odometry * 100.0:.2f} % of the way", "at most 2", odometry <= 0.02)
        share, time = made["fastest"], made["above"]
        above = f", {made['longest']} above for {time * 1000:.0f} ms" if time else ""
        yield Line("  joints", f"{made['joint']} {share:.2f} of its top speed{above}", "at most 1.05", share <= 1.05)


def wander(run: Runner, extent: Extent, impulse: float = 0.0) -> Iterator[Line]:
    """Random orders, without a fall."""
    seeds = extent.seeds(10)
    runs = run(walk_runs.wander, [(seed, extent.minutes * 60.0, impulse) for seed in seeds])
    good = sum(made["up"] for made in runs)
    misses = [f"{seed}: {made['why']} at {made['time']:.0f} s" for seed, made in zip(seeds, runs) if not made["up"]]
    least = len(runs) if not impulse else NINE_OF_TEN * len(runs)
    name = f"random orders, {extent.minutes:g} min" + (f", pushes of {impulse:g} N s" if impulse else "")
    note = f" (seed {', '.join(misses)})" if misses else ""
    yield Line(name, f"{good} of {len(runs)}{note}", f"at least {least:g}", good >= least)


def pushed(run: Runner, extent: Extent) -> Iterator[Line]:
    """Random orders and pushes."""
    return wander(run, extent, impulse=1.0)


def push(run: Runner, extent: Extent) -> Iterator[Line]:
    """One push of 2 N s."""
    for side, name in enumerate(SIDES):
        runs = run(walk_runs.push, [(seed, side, 2.0, False) for seed in extent.seeds(20)])
        good, least = sum(not made["fell"] for made in runs), NINE_OF_TEN * len(runs)
        yield Line(f"2 N s to the {name}", f"{good} of {len(runs)}", f"at least {least:g}", good >= least)


def falls(run: Runner, extent: Extent) -> Iterator[Line]:
    """Falls are noticed, and the robot stands up."""
    arguments = [(seed, seed % len(SIDES), 3.0, True) for seed in extent.seeds(12)]
    fallen = [made for made in run(walk_runs.push, arguments) if made["fell"]]
    hits = [made for made in fallen if made["impact"]]
    early = [made["early"] for made in hits if "early" in made]
    lead = f", {min(early):.2f} s before at least" if early else ""
    figure = f"{len(fallen)} of {len(arguments)} fell, {len(early)} of {len(hits)} impacts foreseen{lead}"
    kept = len(early) == len(hits) and all(lead > 0.0 for lead in early)
    yield Line("3 N s: noticed before the impact", figure, "all", kept)
    up = sum(made["stood_up"] for made in fallen)
    yield Line("3 N s: stands up again", f"{up} of {len(fallen)}", "all", up == len(fallen))


def targets(run: Runner, extent: Extent) -> Iterator[Line]:
    """Walks to a place."""
    runs = run(walk_runs.arrive, [(seed,) for seed in extent.seeds(20)])
    there = [made for made in runs if made["reached"]]
    good = sum(made["distance"] <= 0.02 and made["turn"] <= math.radians(2.0) for made in there)
    x, y, theta = walk_runs.GOAL
    far, turn = max(made["distance"] for made in runs), math.degrees(max(made["turn"] for made in runs))
    figure = f"{good} of {len(runs)} ({len(there)} say so; furthest {far * 100.0:.1f} cm, {turn:.1f} deg)"
    yield Line(f"moveTo({x}, {y}, {theta}) within 2 cm and 2 deg", figure, "all", good == len(runs))
    worst = max(made["odometry"] for made in runs)
    yield Line("  odometry", f"{worst * 100.0:.2f} % of the way at worst", "at most 2", worst <= 0.02)


def grounds(run: Runner, extent: Extent) -> Iterator[Line]:
    """Other grounds, and a load."""
    load = LOAD * walk_runs.total_mass()
    scenes: dict[str, dict[str, Any]] = {f"friction {value:g}": {"friction": value} for value in FRICTIONS}
    scenes["bumps of 3 to 8 mm"] = {"world": "uneven"}
    scenes[f"a load of {load:.2f} kg"] = {"payload": load}
    seeds = extent.seeds(5)
    for name, scene in scenes.items():
        yield _walked_on(name, run(walk_runs.on_ground, [(scene, seed, GROUND_TIME) for seed in seeds]))
    headings = [index * 2.0 * math.pi / DIRECTIONS for index in range(DIRECTIONS)]
    arguments = [(heading, SLOPE, extent.first, GROUND_TIME) for heading in headings]
    yield _walked_on(f"slope of {SLOPE:g} deg, {DIRECTIONS} directions", run(walk_runs.on_slope, arguments))


def stops(run: Runner, extent: Extent) -> Iterator[Line]:
    """Stopped at random moments."""
    runs = run(walk_runs.stop_somewhere, [(seed,) for seed in extent.seeds(20)])
    good = sum(made["result"] for made in runs)
    yield Line("stands 2 s after a stop", f"{good} of {len(runs)}", "all", good == len(runs))


PARTS = {part.__name__: part for part in (speeds, wander, pushed, push, falls, targets, grounds, stops)}


def _walked_on(name: str, runs: list[Mapping[str, Any]]) -> Line:
    good, least = sum(made["up"] and made["way"] >= GROUND_WAY for made in runs), min(made["way"] for made in runs)
    return Line(name, f"{good} of {len(runs)} (least way {least:.2f} m)", "all", good == len(runs))


def measure(parts: Iterable[str], extent: Extent, run: Runner) -> int:
    """Measure and print; returns how many figures miss their bounds."""
    missed = 0
    for name in parts:
        print(f"{name}:", flush=True)
        for line in PARTS[name](run, extent):
            missed += not line.kept
            mark = "" if line.kept else "   MISSED"
            print(f"  {line.what:44s} {line.figure:44s} {line.bound}{mark}", flush=True)
    print(f"{missed} missed" if missed else "all bounds are kept")
    return missed


def outcomes(workers: int, function: Callable[..., Any], jobs: Sequence[tuple]) -> list[Mapping[str, Any]]:
    """What a function makes of each of the tuples of arguments, in their order.

    Args:
        workers: Processes; 0 for this one.
    """
    alone = not workers and sys.stderr.isatty()

    def job(seed: int) -> Mapping[str, Any]:
        if alone:
            print(f"\r{seed} of {len(jobs)} runs \r", end="", file=sys.stderr, flush=True)
        return function(*jobs[seed])

    shown = workers > 0 and sys.stderr.isatty()
    table = sweep(job, len(jobs), workers=workers, progress=shown)
    if table.errors:
        raise RuntimeError(table.errors[0]["error"])
    return table.rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and tell by the exit status whether all was well."""
    parser = parts_parser(__doc__ or "", PARTS)
    parser.add_argument("--runs", type=int, help="of everything that depends on chance (default: 5 to 20, by part)")
    parser.add_argument("--seconds", type=float, default=60.0, help="of a walk at one velocity (default 60)")
    parser.add_argument("--minutes", type=float, default=5.0, help="of a walk by random orders (default 5)")
    parser.add_argument("--seed", type=int, default=1, help="the first one (default 1)")
    parser.add_argument("--jobs", type=int, default=1, help="processes (default 1)")
    chosen = parse(parser, PARTS, arguments, jobs=1, runs=1, seconds=1.0, minutes=0.1)
    logging.getLogger("nao_sim").setLevel(logging.ERROR)  # falls and refused orders are no news
    workers = chosen.jobs if chosen.jobs > 1 else 0
    extent = Extent(chosen.runs, chosen.seconds, chosen.minutes, chosen.seed)
    with ray_running(workers) if workers else nullcontext():  # once, for all sweeps
        return measure(chosen.parts, extent, partial(outcomes, workers)) > 0


if __name__ == "__main__":
    sys.exit(main())
