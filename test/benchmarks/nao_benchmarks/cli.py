"""The command line: which rows, where to write, and the exit status."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Sequence

from .errors import BenchmarkError
from .machine import describe
from .places import ROOT
from .report import Result, record, table, write
from .row import Row
from .stack import Stack

OUTPUT = ROOT / "bench_output" / "bench.json"
EPILOG = "The exit status is 1 when a bound is missed or a row could not be measured."


def parser(rows: Sequence[Row]) -> argparse.ArgumentParser:
    """Options of the program."""
    width = max(len(row.name) for row in rows)
    lines = [f"  {row.name:<{width}}  {row.subject}; {row.bound}" for row in rows]
    options = argparse.ArgumentParser(
        prog="scripts/ros-env python3 test/benchmarks/run.py",
        description="Measures the stack against what it is made of, side by side in one run.",
        epilog="\n".join(["rows:", *lines, "", EPILOG]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    names = [row.name for row in rows]
    options.add_argument("--only", metavar="NAME", action="append", choices=names, help="a row; repeatable")
    options.add_argument("--output", type=Path, default=OUTPUT, help="file (default bench_output/bench.json)")
    return options


def measured(row: Row, stack: Stack) -> Result:
    """Measure a row; what goes wrong is its result, and the other rows go on."""
    try:
        return Result(row, row.measure(stack))
    except BenchmarkError as error:
        return Result(row, None, str(error))
    except Exception as error:  # libqi, ROS or a simulator that fails: the table says which row, and why
        return Result(row, None, f"{type(error).__name__}: {error}")


def main(rows: Sequence[Row], arguments: Sequence[str] | None = None) -> int:
    """Measure, print the table, write the file.

    Args:
        rows: All rows there are.
        arguments: Command line, that of the process by default.

    Returns:
        Exit status.
    """
    options = parser(rows).parse_args(arguments)
    machine = describe()
    print(", ".join(f"{key} {value}" for key, value in machine.items()), flush=True)
    results = []
    with Stack() as stack:
        for row in rows:
            if options.only is None or row.name in options.only:
                print(f"measuring {row.name} ...", file=sys.stderr, flush=True)
                results.append(measured(row, stack))
    print(f"\n{table(results)}")
    write(options.output, record(results, machine))
    missed = [result.row.name for result in results if not result.ok]
    print(f"\nmissed: {', '.join(missed)}" if missed else "\nall bounds are kept")
    return 1 if missed else 0
