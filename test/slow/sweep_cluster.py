"""Sweeps over two nodes of a Ray cluster on this computer: one node is killed at a random moment, or joins later.

    scripts/ros-env python3 test/slow/sweep_cluster.py --kills 20 --joins 10 [--stacks BEHAVIOR] [--seed 0]

Needs Ray; with --stacks, each worker has a whole stack, and the workspace has to be built. Prints a line for each
sweep and ends with 1 if one of them lacks rows, has wrong ones, hangs, or leaves programs running.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import random
import sys
import threading
import time
import uuid
from pathlib import Path
from typing import Any, Callable

import ray
from ray.cluster_utils import Cluster

from nao_sim_bridge.sweep import sweep

MARK = "SWEEP_CLUSTER_CHECK"
SEEDS = 8
GONE_LIMIT = 60.0
"""s after a sweep within which the programs of lost workers must have ended: roslaunch takes up to 40 s."""
NODE_STARTS = 8
HANG_LIMIT = 600.0
"""s for one sweep."""


def small_run(seed: int, length: float) -> dict[str, float]:
    """A run of about a second: the same numbers for the same seed, wherever it runs."""
    chance = random.Random(seed)
    time.sleep(length * chance.uniform(0.5, 1.5))
    return {"value": chance.random()}


def run_small(address: str) -> list[str]:
    """What is wrong with a sweep of small runs."""
    lengths = [0.8, 1.2]
    table = sweep(small_run, SEEDS, address=address, progress=True, length=lengths)
    expected = [{"seed": seed, "length": length, "value": 0.0} for length in lengths for seed in range(SEEDS)]
    for row in expected:
        chance = random.Random(row["seed"])
        chance.uniform(0.5, 1.5)
        row["value"] = chance.random()
    found = [{name: row.get(name) for name in ("seed", "length", "value")} for row in table.rows]
    errors = [row["error"] for row in table.rows if row["error"]]
    return [*errors, *(["rows differ from those of one process"] if found != expected else [])]


def run_stacks(address: str, behavior: str) -> list[str]:
    """What is wrong with a sweep of whole stacks."""
    from nao_library_modules.sweeps import BehaviorGoal, sweep_stack

    table = sweep_stack(BehaviorGoal(behavior), SEEDS, noise=[1.0], address=address)
    errors = [row["error"] for row in table.rows if row["error"]]
    wrong = [f"seed {row['seed']}: {row.get('outcome')}" for row in table.rows if row.get("outcome") != "succeeded"]
    order = [row["seed"] for row in table.rows] == list(range(SEEDS))
    return [*errors, *wrong, *([] if order else ["rows are not in order"])]


def left_programs(mark: str) -> list[str]:
    """Programs that carry the mark in their environment and are not Ray's."""
    found = []
    for process in Path("/proc").iterdir():
        if not process.name.isdigit() or int(process.name) == os.getpid():
            continue
        try:
            environment = (process / "environ").read_bytes()
            command = (process / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
        except OSError:
            continue  # it has ended
        if f"{MARK}={mark}".encode() in environment and command and "/ray/" not in command and "ray::" not in command:
            found.append(f"{process.name} {command[:120]}")
    return found


def wait_until_gone(mark: str) -> list[str]:
    """What is left when the limit is over."""
    deadline, pause = time.monotonic() + GONE_LIMIT, threading.Event()
    while left_programs(mark) and time.monotonic() < deadline:
        pause.wait(0.5)
    return left_programs(mark)


def insist(start: Callable[[], Any]) -> Any:
    """Start a node: Ray gives up after 15 to 30 s, which a busy computer needs for it."""
    for _ in range(NODE_STARTS - 1):
        try:
            return start()
        except Exception as error:  # Ray raises no other
            print(f"a node does not start: {error}", file=sys.stderr, flush=True)
    return start()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=1, help="sweeps in which a node is killed")
    parser.add_argument("--joins", type=int, default=1, help="sweeps in which a node joins later")
    parser.add_argument("--stacks", metavar="BEHAVIOR", help="whole stacks instead of small functions")
    parser.add_argument("--seed", type=int, default=0, help="of the moments")
    options = parser.parse_args()
    mark = os.environ[MARK] = uuid.uuid4().hex
    os.environ.setdefault("RAY_AUTH_MODE", "disabled")
    chance, failed = random.Random(options.seed), 0
    longest = 60.0 if options.stacks else 15.0  # s of a sweep; then as long as the last one
    cluster = insist(lambda: Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False}))
    try:
        for kind in ["kill"] * options.kills + ["join"] * options.joins:
            faulthandler.dump_traceback_later(HANG_LIMIT, exit=True)
            second = [insist(lambda: cluster.add_node(num_cpus=1))] if kind == "kill" else []
            moment = chance.uniform(0.0, longest)

            def act(kind: str = kind, second: list = second) -> None:
                if kind == "kill":
                    cluster.remove_node(second.pop(), allow_graceful=False)
                else:
                    second.append(insist(lambda: cluster.add_node(num_cpus=1)))

            timer = threading.Timer(moment, act)
            timer.start()
            began = time.monotonic()
            if options.stacks:
                problems = run_stacks(cluster.address, options.stacks)
            else:
                problems = run_small(cluster.address)
            took = longest = time.monotonic() - began
            timer.join()
            for node in second:
                cluster.remove_node(node)
            problems += [f"still running: {program}" for program in wait_until_gone(mark)]
            failed += bool(problems)
            inside = "in the sweep" if moment < took else "after it"
            print(f"{kind} at {moment:.1f} s, {inside}, {took:.0f} s: {'; '.join(problems) or 'ok'}", flush=True)
    finally:
        faulthandler.cancel_dump_traceback_later()
        ray.shutdown()
        cluster.shutdown()
    print(f"{options.kills + options.joins - failed} of {options.kills + options.joins} sweeps ended well")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
