#!/usr/bin/env python3
"""Adds up what the test runs left behind and closes with one line: `N passed, N failed`.

A run is a directory with the exit status of its process (file `status`) and its JUnit XML files at any depth.
What counts is what should have run, not what was found: a run that left nothing is a failure.
"""

from __future__ import annotations

import argparse
import enum
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

TIMED_OUT = 124
"""Exit status that stands for "did not end in time", as in the program timeout."""


class Outcome(enum.IntEnum):
    """How a test ended; the larger value wins where one test reports twice."""

    PASSED = 0
    SKIPPED = 1
    FAILED = 2


VERDICTS = {"failure": Outcome.FAILED, "error": Outcome.FAILED, "skipped": Outcome.SKIPPED}
"""Elements of JUnit XML that say how a test ended; without one of them it passed."""


@dataclass(frozen=True)
class Case:
    """One test.

    Attributes:
        run: The run it belongs to: `unit`, or a scenario such as `lights.test`.
        name: Class and function of the test.
        outcome: How it ended.
        message: First line of what went wrong; empty for a test that passed.
    """

    run: str
    name: str
    outcome: Outcome
    message: str = ""


ON_REQUEST = "<!-- on request"
"""Comment in a scenario that runs only when it is asked for by its name."""


def find_scenarios(folder: Path, patterns: Sequence[str] = ()) -> list[Path]:
    """Return the `.test` files under a folder, as sorted paths relative to it.

    Args:
        folder: Where to look, at any depth.
        patterns: Parts of the relative path, one of which has to occur; without any, everything is returned but those
            that run on request only, because they take many minutes.

    Returns:
        Relative paths such as `lights.test`; empty if nothing fits.
    """
    found = sorted(path.relative_to(folder) for path in folder.rglob("*.test"))
    if patterns:
        return [path for path in found if any(pattern in str(path) for pattern in patterns)]
    return [path for path in found if ON_REQUEST not in (folder / path).read_text(encoding="utf-8", errors="replace")]


def read_cases(path: Path, run: str) -> list[Case]:
    """Read one JUnit XML file; a file that cannot be read counts as one failed test."""
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError) as error:
        return [Case(run, path.name, Outcome.FAILED, f"unreadable results: {error}")]
    cases: dict[str, Case] = {}
    for element in root.iter("testcase"):
        case = _read_case(element, run)
        # pytest reports a test twice whose teardown fails as well: it is one test, with the worse outcome.
        if case.name not in cases or cases[case.name].outcome < case.outcome:
            cases[case.name] = case
    return list(cases.values())


def _read_case(element: ElementTree.Element, run: str) -> Case:
    parts = (element.get("classname", ""), element.get("name", ""))
    name = ".".join(part for part in parts if part)
    for tag, outcome in VERDICTS.items():
        verdict = element.find(tag)
        if verdict is not None:
            text = (verdict.get("message") or verdict.text or "").strip()
            return Case(run, name, outcome, text.splitlines()[0] if text else tag)
    return Case(run, name, Outcome.PASSED)


def collect_run(directory: Path, run: str) -> list[Case]:
    """Collect the tests of one run.

    rostest writes two kinds of files: `rostest-*.xml` says whether the test programs ran at all, the others
    hold the tests themselves. The first kind counts only where it reports a failure.

    Args:
        directory: What the run left behind; it need not exist.
        run: Name of the run, for the reports.

    Returns:
        The tests, with one failed test in addition if the run is incomplete: never an empty list.
    """
    status = _read_status(directory / "status")
    if status is None:
        return [Case(run, "run", Outcome.FAILED, "did not run, or was interrupted")]
    cases: list[Case] = []
    for path in sorted(directory.rglob("*.xml")):
        found = read_cases(path, run)
        if path.name.startswith("rostest-"):
            found = [case for case in found if case.outcome is Outcome.FAILED]
        cases += found
    if any(case.outcome is Outcome.FAILED for case in cases):
        return cases
    if status != 0:
        cases.append(Case(run, "run", Outcome.FAILED, describe_status(status)))
    elif not cases:
        cases.append(Case(run, "run", Outcome.FAILED, "ran no test"))
    return cases


def _read_status(path: Path) -> int | None:
    try:
        return int(path.read_text())
    except (OSError, ValueError):
        return None


def describe_status(status: int) -> str:
    """Say in words what a non-zero exit status means; negative or above 128 is a signal."""
    if status == TIMED_OUT:
        return "did not end in time"
    if status < 0 or status > 128:
        return f"was ended by signal {-status if status < 0 else status - 128}, no test reported a failure"
    return f"ended with status {status}, no test reported a failure"


def closing_line(cases: Iterable[Case]) -> str:
    """Return `N passed, N failed`, with `, N skipped` behind it if there are any."""
    outcomes = [case.outcome for case in cases]
    line = f"{outcomes.count(Outcome.PASSED)} passed, {outcomes.count(Outcome.FAILED)} failed"
    skipped = outcomes.count(Outcome.SKIPPED)
    return f"{line}, {skipped} skipped" if skipped else line


def is_success(cases: Iterable[Case]) -> bool:
    """Tell whether something passed and nothing failed."""
    outcomes = {case.outcome for case in cases}
    return Outcome.PASSED in outcomes and Outcome.FAILED not in outcomes


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the failed tests and the closing line; return the exit status."""
    parser = argparse.ArgumentParser(description="Add up the results of the test runs.")
    parser.add_argument("--results", type=Path, required=True, help="directory with one directory a run")
    parser.add_argument("--unit", action="store_true", help="expect the unit tests, in RESULTS/unit")
    parser.add_argument("--scenarios", type=Path, help="expect every .test file under this folder")
    parser.add_argument("patterns", nargs="*", help="only the scenarios whose path contains one of these")
    options = parser.parse_args(arguments)

    runs = [("unit", options.results / "unit")] if options.unit else []
    if options.scenarios:
        scenarios = find_scenarios(options.scenarios, options.patterns)
        # A folder that lost its scenarios must not look like one whose scenarios pass.
        runs += [(str(path), options.results / "rostest" / path.with_suffix("")) for path in scenarios] or [
            ("rostest", options.results / "rostest")
        ]
    cases: list[Case] = []
    for run, directory in runs:
        found = collect_run(directory, run)
        cases += found
        failed = [case for case in found if case.outcome is Outcome.FAILED]
        for case in failed:
            print(f"FAILED {run}: {case.name}: {case.message}")
        if failed and directory.exists():
            print(f"       see {directory}")
    line = closing_line(cases)
    options.results.mkdir(parents=True, exist_ok=True)
    (options.results / "summary.txt").write_text(line + "\n")
    print(line, flush=True)
    return 0 if is_success(cases) else 1


if __name__ == "__main__":
    sys.exit(main())
