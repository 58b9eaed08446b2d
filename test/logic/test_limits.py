"""No test depends on how fast the computer is: limits of wall time are for what hangs, and no time is a result."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
MEASURES = ("benchmarks", "soak", "faults")
"""Folders that measure this computer, and are no tests."""
HANGS = 60.0
"""s of wall time that a test waits at least before it takes something for hung."""
MOMENT = 1.0
"""Shorter waits are for what must not come; those that it may come in would make a test fail on any computer."""
LIMIT = re.compile(r"(^|_)(LIMIT|PATIENCE)$")
"""Names of constants that are limits."""
WAITS = {
    "acquire", "check_call", "check_output", "communicate", "exception", "get", "join", "result", "run", "settimeout",
    "wait", "wait_connected", "wait_for", "wait_for_message", "wait_for_server", "wait_for_service", "wait_for_tick",
    "wait_until",
}  # fmt: skip
"""Functions that wait for something, with a limit as `timeout`, or as their first, second or third argument."""
PLACES = {
    "exception": 0, "join": 0, "result": 0, "wait": 0, "wait_connected": 0, "wait_for": 1, "wait_for_message": 2,
    "wait_for_server": 0, "wait_for_service": 1, "wait_until": 1,
}  # fmt: skip
CLOCKS = {"time.monotonic", "time.perf_counter", "time.time"}


def number(node):
    """A number that stands in the source, s, also as a duration of ROS; None for anything else."""
    if isinstance(node, ast.Call) and name(node.func) == "Duration" and node.args:
        node = node.args[0]
    return node.value if isinstance(node, ast.Constant) and type(node.value) in (int, float) else None


def name(node):
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def limits(tree):
    """(node, s) of each limit in a file."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and any(LIMIT.search(name(target)) for target in node.targets):
            yield node.value, number(node.value)
        if isinstance(node, ast.Call) and name(node.func) in WAITS:
            for keyword in node.keywords:
                if keyword.arg in ("timeout", "limit"):
                    yield keyword.value, number(keyword.value)
            place = PLACES.get(name(node.func), len(node.args))
            if place < len(node.args) and not (name(node.func) == "wait" and len(node.args) > 1):  # that of a clock
                yield node.args[place], number(node.args[place])


def wall_times(tree):
    """Lines that say how long something may take at most on the clock of the computer."""
    for node in ast.walk(tree):
        asserted = isinstance(node, ast.Assert) or (
            isinstance(node, ast.Call) and name(node.func).startswith("assertLess")
        )
        if not asserted:
            continue
        parts = list(ast.walk(node))
        spans = [part for part in parts if isinstance(part, ast.BinOp) and isinstance(part.op, ast.Sub)]
        timed = any(
            isinstance(each, ast.Call) and ast.unparse(each.func) in CLOCKS
            for span in spans
            for each in ast.walk(span.left)
        )
        less = isinstance(node, ast.Call) or any(isinstance(part, (ast.Lt, ast.LtE)) for part in parts)
        if timed and less:
            yield node.lineno


FILES = [
    path
    for path in sorted(TESTS.rglob("*.py"))
    if path.relative_to(TESTS).parts[0] not in MEASURES and "__pycache__" not in path.parts
]


def found(look):
    for path in FILES:
        for each in look(ast.parse(path.read_text(encoding="utf-8"))):
            yield path.relative_to(TESTS), each


def test_what_a_test_waits_for_has_a_minute_at_least():
    short = [
        f"{path}:{node.lineno}: {seconds:g} s"
        for path, (node, seconds) in found(limits)
        if seconds is not None and MOMENT <= seconds < HANGS
    ]
    assert len(FILES) > 300 and not short, "\n".join(short)


def test_no_test_says_how_long_something_may_take_on_this_computer():
    timed = [f"{path}:{line}" for path, line in found(wall_times)]
    assert not timed, "\n".join(timed)


@pytest.mark.parametrize("path", sorted((TESTS / "rostest").glob("*.test")), ids=lambda path: path.name)
def test_a_suite_of_rostest_has_five_minutes_at_least(path):
    given = re.findall(r'time-limit="(\d+)"', path.read_text(encoding="utf-8"))
    assert given and min(map(int, given)) >= 5 * HANGS
