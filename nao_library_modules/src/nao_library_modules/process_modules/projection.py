"""Projection: a plan runs in the simulator, faster than real time, before it runs on a robot.

The program of the plan runs unchanged, with another ROS master and another robot behind it. It takes `--trace FILE` and
writes its trace there, as `run_and_tell` does.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..ros.own_stack import OwnStack, StackFailed
from .failures import PlanFailure
from .trace import Record, Trace

LIMIT = 600.0
"""s of wall time that a projected plan may take."""
AS_FAST_AS_POSSIBLE = "0"


class ProjectionFailed(PlanFailure):
    """The plan could not be projected: there is no trace."""


class ProjectionLate(ProjectionFailed):
    """The program took longer than it may, and was ended."""


def project(
    program: Path, arguments: Sequence[str] = (), world: str = "empty", launch: Mapping[str, str] | None = None
) -> Trace:
    """Run the program of a plan on a simulated robot of its own; the trace of the plan, whether it succeeded or not.

    `launch`: further arguments of nao_sim.launch. Raises ProjectionFailed if the simulator does not come up, or there
    is no trace.
    """
    with tempfile.TemporaryDirectory(prefix="projection_") as folder:
        given = {"world": world, "speed": AS_FAST_AS_POSSIBLE, "record_dir": folder, **(launch or {})}
        with OwnStack(Path(folder) / "stack.log", given) as stack:
            try:
                stack.wait_for_robot()  # a program that begins before has another time
            except StackFailed as error:
                raise ProjectionFailed(str(error)) from error
            return run_program(program, arguments, stack.master_uri, Path(folder))


def run_program(program: Path, arguments: Sequence[str], master_uri: str, folder: Path, limit: float = LIMIT) -> Trace:
    """Run a program that takes `--trace FILE` with a ROS master, for at most `limit` s; the trace that it keeps.

    Raises ProjectionLate if it took longer, ProjectionFailed if it kept no trace.
    """
    trace = folder / "trace.json"
    command = [sys.executable, str(program), *arguments, "--trace", str(trace)]
    environment = {**os.environ, "ROS_MASTER_URI": master_uri}
    try:
        done = subprocess.run(
            command, env=environment, timeout=limit, stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
    except subprocess.TimeoutExpired:
        raise ProjectionLate(f"{program.name} took longer than {limit:g} s") from None
    try:
        return Trace.from_json(trace.read_text(encoding="utf-8"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        reason = done.stderr.strip().rpartition("\n")[2] or f"it ended with status {done.returncode}"
        raise ProjectionFailed(f"{program.name} kept no trace: {reason}") from error


@dataclass(frozen=True)
class Difference:
    """A task with different outcomes in two runs; an outcome is state and failure, empty where there is no task."""

    path: str
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.path}: {self.before or 'not there'} -> {self.after or 'not there'}"


@dataclass(frozen=True)
class Comparison:
    """What differs between two runs of a plan: tasks in the order of the tree, and the duration of each run, s."""

    differences: tuple[Difference, ...]
    before: float
    after: float

    @property
    def alike(self) -> bool:
        return not self.differences


def compare(before: Trace, after: Trace) -> Comparison:
    """Compare the tasks of two traces of a plan, and the outcome of each."""
    first, second = dict(_paths(before)), dict(_paths(after))
    differences = [
        Difference(path, _outcome(first.get(path)), _outcome(second.get(path)))
        for path in {**first, **second}
        if _outcome(first.get(path)) != _outcome(second.get(path))
    ]
    return Comparison(tuple(differences), _duration(before), _duration(after))


def _paths(trace: Trace, parent: int | None = None, above: str = "") -> Iterator[tuple[str, Record]]:
    seen: dict[str, int] = {}
    for record in trace.children(parent):
        # Of several of a name each has its number: the second try is compared with the second try.
        seen[record.name] = seen.get(record.name, 0) + 1
        again = f"[{seen[record.name]}]" if seen[record.name] > 1 else ""
        path = f"{above}{record.name}{again}"
        yield path, record
        yield from _paths(trace, record.number, f"{path}/")


def _outcome(record: Record | None) -> str:
    if record is None:
        return ""
    kind = record.failure.partition(":")[0] if record.state == "failed" else ""
    return f"{record.state} ({kind})" if kind else record.state


def _duration(trace: Trace) -> float:
    return max((record.ended or 0.0 for record in trace.records), default=0.0)
