"""Programs that time ticks in a process of their own: threads of ours would take the interpreter from them."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

from .errors import BenchmarkError
from .places import PROGRAMS
from .program import Program
from .stats import Sample

LIMIT = 60.0


def run_timings(name: str, rounds: int, *options: str) -> tuple[Sample, Sample]:
    """Run `programs/<name>.py`, which prints JSON with the lists `ours` and `reference`, s of each tick.

    Args:
        name: Of the program.
        rounds: How many ticks it times.
        options: Further options of its command line.

    Raises:
        BenchmarkError: If it fails or prints no times.
    """
    package = str(Path(__file__).resolve().parents[1])
    path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
    command = [sys.executable, str(PROGRAMS / f"{name}.py"), "--rounds", str(rounds), *options]
    with Program(name, command, {"PYTHONPATH": path}) as program:
        lines = program.wait(LIMIT).splitlines()
    try:
        times = json.loads(next(line for line in reversed(lines) if line.startswith("{")))
        return Sample(tuple(times["ours"])), Sample(tuple(times["reference"]))
    except (StopIteration, ValueError, KeyError):
        raise BenchmarkError(f"{name} printed no times") from None
