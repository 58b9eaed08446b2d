#!/usr/bin/env python3
"""Tries the moves between postures under physics, and searches for better key frames. Needs no ROS master.

    find_posture_moves.py check [--runs 20] [--friction 0.5]       table of all moves of config/posture_moves.json
    find_posture_moves.py search LyingBelly Stand --minutes 20     better key frames for one of them

A search begins with the key frames of the file and changes all but the last one, which is the goal; right and left
stay mirror images. Its state is a file: called again it goes on. When its middle beats what the file has, it is
written there. To find a move from nothing, write a rough one by hand and search from that.
"""

from __future__ import annotations

import argparse
import json
import logging
import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy as np
from posture_attempt import Attempts, Mark, Outcome
from sep_cma_es import SepCmaEs
from symmetric_frames import mirrored, to_frames, to_vector

from nao_sim_bridge.base.config import config_file
from nao_sim_bridge.control.balance.posture_recognition import STANDING
from nao_sim_bridge.core.posture_moves import FILE, Move, load_moves
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures
from nao_sim_bridge.model.robot_model import RobotModel

# Seeds of checks begin here: no search has seen them.
CHECK_SEEDS = 1_000_000
# A check may have this many fewer than the file says: other starts, other luck.
SLACK = 1
# The search ends when this share of the candidates of a generation gets there.
MOST = 0.95
# Torso of a standing robot over the floor, m.
STANDING_HEIGHT = 0.33
# What the score weighs: success; the end; the last poses before the goal, latest first; N of impact; s of time.
SUCCESS, END, WAY, IMPACT, TIME = 3.0, 3.0, (1.0, 0.8, 0.6), 0.002, 0.05


@dataclass(frozen=True)
class Tally:
    """What a number of attempts came to: how many, how many got there, and the worst of each."""

    runs: int
    reached: int
    others: tuple[str, ...]
    turn: float
    impact: float
    speed: float
    torque: float


def tally(move: Move, runs: int, noise: float, friction: float | None) -> Tally:
    """Try a move from `runs` starts that no search has seen."""
    attempts = Attempts(move.start, noise, friction)
    try:
        outcomes = [attempts.run(move, CHECK_SEEDS + seed) for seed in range(runs)]
    finally:
        attempts.close()
    return Tally(
        runs=runs,
        reached=sum(outcome.reached for outcome in outcomes),
        others=tuple(sorted({outcome.ended for outcome in outcomes if not outcome.reached})),
        **{name: max(getattr(outcome, name) for outcome in outcomes) for name in ("turn", "impact", "speed", "torque")},
    )


def cost(move: Move, outcome: Outcome) -> float:
    """How bad an attempt was; smaller is better.

    Attempts that fail are told apart by how near they came: a body that is upright over flat feet in the last poses
    will stand, one that sits or lies lower than its goal needs only the way there.
    """
    *way, end = outcome.marks
    on_feet = load_postures().by_name[move.goal].family == STANDING
    good = SUCCESS if outcome.reached else 0.0
    if on_feet:
        good += END * (end.upright / 2.0 + min(end.height / STANDING_HEIGHT, 1.0))
        good += sum(weight * _worth(mark) for weight, mark in zip(WAY, way[-2::-1]))
    else:
        good += END * (outcome.ended == load_postures().by_name[move.goal].family)
    return -good + IMPACT * outcome.impact + TIME * move.duration


def _worth(mark: Mark) -> float:
    return 0.5 * mark.upright + mark.height / 0.2 + 1.2 * mark.flat - 4.0 * mark.beside


# --- the file ---------------------------------------------------------------------------------------------------------


def put(model: RobotModel, move: Move, runs: int, reached: int) -> None:
    """Put a move that was tried so often into the file, in place of one that begins and ends alike."""
    path = config_file(FILE)
    content = json.loads(path.read_text(encoding="utf-8"))
    entry = {
        "from": move.start,
        "to": move.goal,
        "checked": {"runs": runs, "reached": reached},
        "frames": [
            {
                "time": round(frame.duration, 3),
                "angles": {model.joints[i].name: round(angle, 4) for i, angle in sorted(frame.angles.items())},
            }
            for frame in move.frames
        ],
    }
    ends = (move.start, move.goal)
    places = [i for i, other in enumerate(content["moves"]) if (other["from"], other["to"]) == ends]
    if places:
        content["moves"][places[0]] = entry
    else:
        content["moves"].append(entry)
    path.write_text(text_of(content), encoding="utf-8")


def text_of(content: dict[str, Any]) -> str:
    """The file as text: one key frame a line, so that a change shows what moved."""
    moves = []
    for move in content["moves"]:
        head = ", ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in move.items() if key != "frames")
        frames = ",\n".join(f"   {json.dumps(frame)}" for frame in move["frames"])
        moves.append(f'  {{{head}, "frames": [\n{frames}\n  ]}}')
    about = json.dumps(content["_meta"], indent=1).replace("\n", "\n ")
    return f'{{\n "_meta": {about},\n "moves": [\n' + ",\n".join(moves) + "\n ]\n}\n"


# --- checking ---------------------------------------------------------------------------------------------------------


def check(options: argparse.Namespace) -> int:
    """Print how often each move gets there; 0 when all do at least as often as the file says."""
    good = True
    print(f"{'move':26}{'there':>9}{'time s':>8}{'turn rad/s':>12}{'impact N':>10}{'speed':>7}{'torque':>8}  else in")
    for move in load_moves():
        if options.move and [move.start, move.goal] != options.move:
            continue
        found = tally(move, options.runs, options.noise, options.friction)
        good = good and found.reached >= math.floor(found.runs * move.certainty) - SLACK
        print(
            f"{str(move):26}{f'{found.reached}/{found.runs}':>9}{move.duration:8.1f}{found.turn:12.1f}"
            f"{found.impact:10.0f}{found.speed:7.2f}{found.torque:8.2f}  {', '.join(found.others)}",
            flush=True,
        )
        if options.write and found.reached:
            put(load_model(), move, found.runs, found.reached)
    return 0 if good else 1


# --- searching --------------------------------------------------------------------------------------------------------


def search(options: argparse.Namespace) -> int:
    """Search until time is over or nearly all candidates get there."""
    model = load_model()
    seed_move = next((m for m in load_moves() if [m.start, m.goal] == [options.start, options.goal]), None)
    if seed_move is None:
        print(f"the file has no move {options.start} -> {options.goal} to begin with", file=sys.stderr)
        return 2
    if not mirrored(model, seed_move.frames[:-1]):
        print(f"{seed_move} is not the same left and right: this search does not fit it", file=sys.stderr)
        return 2
    goal, state = seed_move.frames[-1], Path(options.state or f"{options.start}_{options.goal}.json")

    def move_of(vector: Sequence[float]) -> Move:
        return Move(options.start, options.goal, (*to_frames(model, vector), goal))

    if state.exists():
        strategy = SepCmaEs.from_state(json.loads(state.read_text(encoding="utf-8")))
        print(f"goes on with generation {strategy.generation} of {state}")
    else:
        first = to_vector(model, seed_move.frames[:-1])
        strategy = SepCmaEs(first, options.sigma, options.population, options.seed)
    attempts = Attempts(options.start, options.noise)
    give_up = time.monotonic() + 60.0 * options.minutes
    share = 0.0
    try:
        last = strategy.generation + options.generations
        while share < MOST and strategy.generation < last and time.monotonic() < give_up:
            share = generation(strategy, attempts, move_of, options.starts)
            state.write_text(json.dumps(strategy.state()), encoding="utf-8")
    finally:
        attempts.close()
    return settle(seed_move, move_of(strategy.mean), options)


def generation(
    strategy: SepCmaEs, attempts: Attempts, move_of: Callable[[Sequence[float]], Move], starts: int
) -> float:
    """Try all candidates of a generation from the same starts; the share of attempts that got there."""
    costs, reached, seed = [], 0, strategy.generation * starts
    candidates = strategy.ask()
    for candidate in candidates:
        move = move_of(candidate)
        outcomes = [attempts.run(move, seed + i) for i in range(starts)]
        reached += sum(outcome.reached for outcome in outcomes)
        costs.append(float(np.mean([cost(move, outcome) for outcome in outcomes])))
    strategy.tell(costs)
    share = reached / (starts * len(candidates))
    print(
        f"generation {strategy.generation}: best {min(costs):.2f}, median {np.median(costs):.2f}, "
        f"step {strategy.sigma:.3f}, {share:.0%} got there",
        flush=True,
    )
    return share


def settle(before: Move, after: Move, options: argparse.Namespace) -> int:
    """Compare old and new under the same starts and keep the better one; 0 when that is the new one."""
    old, new = (tally(move, options.runs, options.noise, None) for move in (before, after))
    print(f"{before}: {old.reached} of {old.runs} before, {new.reached} of {new.runs} now, {after.duration:.1f} s")
    if not new.reached or (new.reached, -new.impact) <= (old.reached, -old.impact):
        return 1
    if options.write:
        put(load_model(), after, new.runs, new.reached)
        print("written")
    return 0


def parse(arguments: list[str] | None = None) -> argparse.Namespace:
    """Options of the command line."""
    parser = argparse.ArgumentParser(
        prog="find_posture_moves", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(dest="command", required=True)
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--runs", type=int, default=20, help="attempts of a check (default 20)")
    common.add_argument("--noise", type=float, default=0.05, help="deviation of each joint at the start, rad (0.05)")
    common.add_argument("--write", action="store_true", help="write to config/posture_moves.json")
    one = commands.add_parser("check", parents=[common], help="try the moves of the file")
    one.add_argument("--move", nargs=2, metavar=("FROM", "TO"), help="only this one")
    one.add_argument("--friction", type=float, help="of the soles, in place of the settings'")
    other = commands.add_parser("search", parents=[common], help="search for better key frames of one move")
    other.add_argument("start", metavar="FROM", help="posture or family it begins in")
    other.add_argument("goal", metavar="TO", help="posture it ends in")
    other.add_argument("--minutes", type=float, default=20.0, help="longest time to search (default 20)")
    other.add_argument("--generations", type=int, default=1000, help="most generations to search (default 1000)")
    other.add_argument("--population", type=int, default=14, help="candidates a generation (default 14)")
    other.add_argument("--starts", type=int, default=2, help="disturbed starts a candidate (default 2)")
    other.add_argument("--sigma", type=float, default=0.1, help="first step, rad and s (default 0.1)")
    other.add_argument("--seed", type=int, default=0, help="of the search (default 0)")
    other.add_argument("--state", help="file of the state (default FROM_TO.json in the current folder)")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """Check or search."""
    options = parse(arguments)
    # Candidates often ask for more speed than there is, and get what there is.
    logging.getLogger("nao_sim").setLevel(logging.ERROR)
    return check(options) if options.command == "check" else search(options)


if __name__ == "__main__":
    sys.exit(main())
