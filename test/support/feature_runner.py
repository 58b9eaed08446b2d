"""Runs the commands of the feature tables as a shell does, side by side where they are not in each other's way."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from feature_table import ALL, Feature
from programs import Ended, Program, at_port, shell


@dataclass(frozen=True)
class Outcome:
    """How a command ended.

    Attributes:
        feature: The row.
        ended: Status, output and time.
    """

    feature: Feature
    ended: Ended

    @property
    def refused(self) -> bool:
        """Whether it failed; `rosservice` ends with status 0 also when a service has said no."""
        return self.ended.status != 0 or "success: False" in self.ended.output

    def __str__(self) -> str:
        """Command, output and status, as people read them."""
        return f"$ {self.feature.command}\n{self.ended}"


def run(feature: Feature, folder: Path, environment: Mapping[str, str], port: int, limit: float) -> Outcome:
    """Run a command as a shell does that it is typed into.

    Args:
        feature: The row.
        folder: Where it runs; files that it writes are there.
        environment: Variables.
        port: Where the robot is, instead of the usual port.
        limit: Longest time, s of wall time; it is killed then with all that it has started.
    """
    return Outcome(feature, Program(shell(at_port(feature.command, port)), folder, environment).end(limit))


def run_all(rows: Sequence[Feature], run_one: Callable[[Feature], Outcome], at_once: int) -> list[Outcome]:
    """Run commands in their order, but none together with one that uses the same.

    A command overtakes those before it that have to wait, if it uses nothing of what they wait for. Those that have
    all for themselves come last, since nothing can overtake them.

    Args:
        rows: What to run.
        run_one: Runs one; called from several threads.
        at_once: How many run side by side at most.
    """
    waiting = sorted(rows, key=lambda row: row.uses == ALL)
    busy, changed = set(), threading.Condition()
    outcomes: list[Outcome] = []

    def next_row() -> Feature | None:
        with changed:
            while waiting:
                taken = set(busy)
                for row in waiting:
                    if not row.uses & taken:
                        waiting.remove(row)
                        busy.update(row.uses)
                        return row
                    taken |= row.uses
                changed.wait()
            return None

    def work() -> None:
        row = next_row()
        while row is not None:
            try:
                outcomes.append(run_one(row))
            finally:
                with changed:
                    busy.difference_update(row.uses)
                    changed.notify_all()
            row = next_row()

    with ThreadPoolExecutor(at_once) as pool:
        for worker in [pool.submit(work) for _ in range(at_once)]:
            worker.result()
    return outcomes
