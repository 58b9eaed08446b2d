"""Sweeps over two nodes of a Ray cluster on this computer: one node is killed at a random moment, or joins later.

    scripts/ros-env python3 test/slow/sweep_cluster.py --kills 20 --joins 10 [--stacks BEHAVIOR] [--seed 0]

Needs Ray; with --stacks, each worker has a whole stack, and the workspace has to be built. Prints a line for each
sweep and ends with 1 if one of them lacks rows, has wrong ones, hangs, or leaves programs running. A sweep that ends
before its node is in the cluster says nothing: it is a "no join", and made again with longer runs.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import random
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import uuid
from collections import Counter
from pathlib import Path
from typing import Any, Callable

import ray
from ray.cluster_utils import Cluster

from nao_sim_bridge.sweep import sweep

RAY = {"RAY_AUTH_MODE": "disabled", "RAY_worker_niceness": "0", "RAY_worker_register_timeout_seconds": "300"}
"""For a busy computer: with Ray's niceness of 15 a worker hardly starts there, and Ray ends it after 60 s."""
MARK = "SWEEP_CLUSTER_CHECK"
NO_JOIN = "no join"
SEEDS = 8
GONE_LIMIT = 60.0
"""s after a sweep within which the programs of lost workers must have ended: roslaunch takes up to 40 s."""
NODE_STARTS = 8
JOIN_TRIES = 3
"""Sweeps for a join, each with runs twice as long as those of the one before: a busy computer takes long to join."""
HANG_LIMIT = 600.0
"""s for one sweep."""


def small_run(seed: int, length: float) -> dict[str, Any]:
    """A run of about `length` s: the same value for the same seed, on whatever node."""
    chance = random.Random(seed)
    time.sleep(length * chance.uniform(0.5, 1.5))
    return {"value": chance.random(), "node": ray.get_runtime_context().get_node_id()}


def run_small(address: str, rows: Path, lengths: list[float]) -> tuple[list[str], str]:
    """What is wrong with a sweep of small runs, and how many rows each node has made."""
    table = sweep(small_run, SEEDS, rows, address=address, length=lengths)
    errors = [row["error"] for row in table.rows if row["error"]]
    found = [(row["seed"], row["length"], row.get("value")) for row in table.rows]
    values = []
    for seed in range(SEEDS):
        chance = random.Random(seed)
        chance.uniform(0.5, 1.5)
        values.append(chance.random())
    right = found == [(seed, length, values[seed]) for length in lengths for seed in range(SEEDS)]
    makers = Counter(row.get("node") for row in table.rows).values()
    return [*errors, *([] if right else ["rows differ from those of one process"])], "+".join(map(str, makers))


def run_stacks(address: str, behavior: str, rows: Path, seeds: int) -> tuple[list[str], str]:
    """What is wrong with a sweep of whole stacks, and how many rows it has."""
    from nao_library_modules.sweeps import BehaviorGoal, sweep_stack

    table = sweep_stack(BehaviorGoal(behavior), seeds, noise=[1.0], output=rows, address=address)
    errors = [row["error"] for row in table.rows if row["error"]]
    wrong = [f"seed {row['seed']}: {row.get('outcome')}" for row in table.rows if row.get("outcome") != "succeeded"]
    order = [row["seed"] for row in table.rows] == list(range(seeds))
    return [*errors, *wrong, *([] if order else ["rows are not in order"])], str(len(table.rows))


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


class Meddler(threading.Thread):
    """Kills the second node, or adds it, once in a sweep.

    Args:
        cluster: What it meddles with.
        kind: "kill" or "join".
        rows: The file of the sweep.
        at_once: The moment counts from the begin of the sweep; else from its first row on.
        moment: s.
    """

    def __init__(self, cluster: Cluster, kind: str, rows: Path, at_once: bool, moment: float) -> None:
        super().__init__()
        self.done = "not before the end"
        self._cluster, self._kind, self._rows = cluster, kind, rows
        self._at_once, self._moment = at_once, moment
        self._over = threading.Event()
        self._second = insist(lambda: cluster.add_node(num_cpus=1)) if kind == "kill" else None
        self._joined: subprocess.Popen[bytes] | None = None

    def run(self) -> None:
        while not self._at_once and not self._rows.exists():
            if self._over.wait(0.05):
                return
        if self._over.wait(self._moment):
            return
        if self._kind == "kill":
            self._cluster.remove_node(self._second, allow_graceful=False)
            self._second = None
        else:
            command = [sys.executable, "-m", "ray.scripts.scripts", "start", "--address", self._cluster.address]
            with self._rows.with_suffix(".log").open("wb") as log:
                self._joined = subprocess.Popen(
                    [*command, "--num-cpus", "1", "--block"], stdout=log, stderr=log, stdin=subprocess.DEVNULL
                )
        rows = self._rows.read_text().count("\n") - 1 if self._rows.exists() else 0
        self.done = f"with {rows} rows"

    def came(self) -> bool:
        """Whether the second node is in the cluster now, or a kill has no node that should come."""
        nodes = self._cluster.global_state.node_table()
        return self._kind == "kill" or sum(node["Alive"] for node in nodes) > 1

    def end(self) -> None:
        """The sweep is over: take the second node away."""
        self._over.set()
        self.join()
        if self._second is not None:
            self._cluster.remove_node(self._second)
        if self._joined is not None:
            self._joined.terminate()
            self._joined.wait(GONE_LIMIT)


def try_sweep(
    cluster: Cluster, kind: str, stacks: str | None, rows: Path, mark: str, chance: random.Random, attempt: int
) -> list[str]:
    """What is wrong with one sweep, during which a node is killed or joins; prints a line."""
    faulthandler.dump_traceback_later(HANG_LIMIT, exit=True)
    at_once = chance.random() < (0.2 if kind == "kill" else 0.5)
    lasted = 30.0 if stacks else 8.0  # s from the first row to the last one, about
    meddler = Meddler(cluster, kind, rows, at_once, chance.uniform(0.0, 0.6) * lasted)
    began = time.monotonic()
    meddler.start()
    try:
        if stacks:
            problems, made = run_stacks(cluster.address, stacks, rows, SEEDS * 2**attempt)
        else:
            lengths = [0.8, 1.2] if kind == "kill" else [3.0, 4.0]  # a node takes a while to join
            problems, made = run_small(cluster.address, rows, [2**attempt * length for length in lengths])
        if not meddler.came():
            problems.append(NO_JOIN)
    finally:
        meddler.end()
    took = time.monotonic() - began
    problems += [f"still running: {program}" for program in wait_until_gone(mark)]
    told = f"{rows.stem} {kind} {meddler.done}, rows by node: {made}, {took:.0f} s"
    print(f"{told}: {'; '.join(problems) or 'ok'}", flush=True)
    return problems


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=1, help="sweeps in which a node is killed")
    parser.add_argument("--joins", type=int, default=1, help="sweeps in which a node joins later")
    parser.add_argument("--stacks", metavar="BEHAVIOR", help="whole stacks instead of small functions")
    parser.add_argument("--seed", type=int, default=0, help="of the moments")
    options = parser.parse_args()
    mark = os.environ[MARK] = uuid.uuid4().hex
    for name, value in RAY.items():
        os.environ.setdefault(name, value)
    chance, failed = random.Random(options.seed), 0
    folder = Path(tempfile.mkdtemp(prefix="sweep_cluster_"))
    cluster = insist(lambda: Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False}))
    try:
        for number, kind in enumerate(["kill"] * options.kills + ["join"] * options.joins):
            for attempt in range(JOIN_TRIES):
                problems = try_sweep(
                    cluster, kind, options.stacks, folder / f"{number}_{attempt}.csv", mark, chance, attempt
                )
                if problems != [NO_JOIN]:
                    break
            failed += bool(problems)
    finally:
        faulthandler.cancel_dump_traceback_later()
        ray.shutdown()
        cluster.shutdown()
        shutil.rmtree(folder)
    print(f"{options.kills + options.joins - failed} of {options.kills + options.joins} sweeps ended well")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
