"""The order of a participant's conditions, counterbalanced, and the order of a trial's steps. Pure.

A path names a step for good: `2.3` is the third step of the second phase, `2.3.b1.2` the second of the first branch
there, `2.3.r4.2` the second of the fourth round, `2.3.w4.2` that of a `while`.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from .protocol import FIRST, LAST, BranchStep, ProtocolStep, RoundsStep, StudyError, StudyProtocol, WhileStep

FIXED, LATIN_SQUARE, RANDOM = "fixed", "latin_square", "random"
ORDERS = (LATIN_SQUARE, RANDOM, FIXED)


def balanced_rows(count: int) -> list[list[int]]:
    """Latin square of Williams: each condition is at each place, and behind each other one, equally often.

    `count`: how many conditions. Returns `count` rows of the numbers from 0; twice as many where `count` is odd, for
    then one square is not enough.
    """
    first = _zigzag(count)
    rows = [[(value + shift) % count for value in first] for shift in range(count)]
    return rows if count % 2 == 0 or count == 1 else rows + [row[::-1] for row in rows]


def _zigzag(count: int) -> list[int]:
    """0, 1, n-1, 2, n-2, ..."""
    low, high = 1, count - 1
    values = [0]
    while len(values) < count:
        values.append(low)
        low += 1
        if len(values) < count:
            values.append(high)
            high -= 1
    return values


def conditions_of(protocol: StudyProtocol, within: bool) -> list[dict[str, str]]:
    """All combinations of the levels of the factors within participants, or between them: factor -> level."""
    factors = [factor for factor in protocol.factors if factor.within == within]
    return [
        dict(zip((factor.name for factor in factors), levels))
        for levels in itertools.product(*(factor.levels for factor in factors))
    ]


def order_of(protocol: StudyProtocol, number: int) -> list[dict[str, str]]:
    """Conditions of a participant, a trial each, in their order: factor -> level.

    `number`: of the participant, from 1. Consecutive participants go to the groups of the factors between participants
    in turn; within a group consecutive ones have consecutive rows of the square.
    """
    groups, inner = conditions_of(protocol, within=False), conditions_of(protocol, within=True)
    group, place = groups[(number - 1) % len(groups)], (number - 1) // len(groups)
    return [_in_order(protocol, {**group, **inner[i]}) for i in _places(protocol, len(inner), number, place)]


def _places(protocol: StudyProtocol, count: int, number: int, place: int) -> Sequence[int]:
    if protocol.order == FIXED:
        return range(count)
    if protocol.order == RANDOM:
        places = list(range(count))
        random.Random(f"{protocol.seed}:{number}").shuffle(places)
        return places
    rows = balanced_rows(count)
    return rows[place % len(rows)]


def _in_order(protocol: StudyProtocol, condition: Mapping[str, str]) -> dict[str, str]:
    return {factor.name: condition[factor.name] for factor in protocol.factors}


def following(protocol: StudyProtocol, path: str, values: Mapping[str, Any]) -> str:
    """Path of the step that comes behind another one; empty at the end of the trial, or of a round of a `while`.

    `path`: of that one; empty: the first step is wanted. `values`: of the trial, for branches and phases.
    """
    parts = path.split(".") if path else ["0"]
    if path:
        lists = _lists(protocol, parts)
        while lists:
            group, steps, length = lists.pop()
            prefix, known = parts[:length], {**values, **_rounds(protocol, parts[:length], values)}
            found = _first(steps, prefix, known, int(parts[length]))
            if not found and isinstance(group, RoundsStep):
                found = _first_round(group, prefix[:-1], known, int(prefix[-1][1:]) + 1)
            if found:
                return ".".join(found)
            if isinstance(group, WhileStep):
                return ""
    for i, phase in enumerate(protocol.phases[int(parts[0]) :], int(parts[0]) + 1):
        if (phase.only == FIRST and values["trial"] != 1) or (
            phase.only == LAST and values["trial"] != values["trials"]
        ):
            continue
        found = _first(phase.steps, [str(i)], values, 0)
        if found:
            return ".".join(found)
    return ""


def first_inside(protocol: StudyProtocol, path: str, number: int, values: Mapping[str, Any]) -> str:
    """Path of the first step in a round of the `while` at a path; empty if none is done."""
    step = step_at(protocol, path)
    assert isinstance(step, WhileStep)
    known = {**values, **rounds_of(protocol, path, values)}
    return ".".join(_first(step.steps, [*path.split("."), f"w{number}"], known, 0))


def is_inside(path: str) -> bool:
    """Whether a step is one of those that a `while` does."""
    return ".w" in path


def round_numbers(path: str) -> list[int]:
    """Numbers of the rounds that a step is in, from outside; those of a `while` among them."""
    return [int(part[1:]) for part in path.split(".") if part[:1] in ("r", "w")]


def any_round(path: str) -> str:
    """A path with all its rounds taken for the first one, as the protocol has it."""
    return ".".join(f"{part[0]}1" if part[0] in "rw" else part for part in path.split("."))


def step_at(protocol: StudyProtocol, path: str) -> ProtocolStep:
    """The step of a path. Raises StudyError if there is none: the protocol is not the one that the path is of."""
    parts = path.split(".")
    *_, (_, steps, length) = _lists(protocol, parts)
    try:
        return steps[int(parts[length]) - 1]
    except (IndexError, ValueError):
        raise StudyError(f"there is no step {path} in protocol {protocol.name}") from None


def phase_of(protocol: StudyProtocol, path: str) -> str:
    """Name of the phase that a step is in."""
    return protocol.phases[int(path.partition(".")[0]) - 1].name


def rounds_of(protocol: StudyProtocol, path: str, values: Mapping[str, Any]) -> dict[str, int]:
    """Values of the rounds that a step is in, from outside: name -> 1, 2, ... `values`: of the trial."""
    return _rounds(protocol, path.split("."), values)


def all_steps(protocol: StudyProtocol) -> Iterator[tuple[str, ProtocolStep]]:
    """Steps with their paths in the order of the file, groups among them; of rounds the first one."""
    for i, phase in enumerate(protocol.phases, 1):
        yield from _walk(phase.steps, str(i))


def steps_in(steps: Iterable[ProtocolStep]) -> Iterator[ProtocolStep]:
    """Steps and those inside of them; of rounds the first one."""
    return (step for _, step in _walk(tuple(steps), ""))


def _walk(steps: tuple[ProtocolStep, ...], prefix: str) -> Iterator[tuple[str, ProtocolStep]]:
    for i, step in enumerate(steps, 1):
        path = f"{prefix}.{i}"
        yield path, step
        for part, inner in step.inner():
            if part[0] != "r" or part == "r1":  # the first round stands for all
                yield from _walk(inner, f"{path}.{part}")


def _lists(protocol: StudyProtocol, parts: list[str]) -> list[tuple[Any, tuple[ProtocolStep, ...], int]]:
    """The lists of steps along a path, from outside.

    Of each the group that it is in (None: the phase), and how many parts of the path lead to it.
    """
    try:
        steps = protocol.phases[int(parts[0]) - 1].steps
        lists: list[tuple[Any, tuple[ProtocolStep, ...], int]] = [(None, steps, 1)]
        for i in range(2, len(parts) - 1, 2):
            group = steps[int(parts[i - 1]) - 1]
            steps = group.inside(parts[i]) or ()
            lists.append((group, steps, i + 1))
    except (IndexError, KeyError, ValueError):
        raise StudyError(f"there is no step {'.'.join(parts)} in protocol {protocol.name}") from None
    return lists


def _rounds(protocol: StudyProtocol, parts: list[str], values: Mapping[str, Any]) -> dict[str, int]:
    found = {}
    for group, _, length in _lists(protocol, [*parts, "1"] if len(parts) % 2 else parts):
        if isinstance(group, RoundsStep) and group.name:
            path = ".".join(parts[: length - 1])
            found[group.name] = group.value(int(parts[length - 1][1:]), path, values)
    return found


def _first(steps: tuple[ProtocolStep, ...], prefix: list[str], values: Mapping[str, Any], start: int) -> list[str]:
    """Path of the first step that is done in a list, from a place on, counted from 0; empty if there is none."""
    for i, step in enumerate(steps[start:], start + 1):
        path = [*prefix, str(i)]
        if isinstance(step, BranchStep):
            number = step.branch(values)
            path = _first(step.branches[number - 1][1], [*path, f"b{number}"], values, 0) if number else []
        elif isinstance(step, RoundsStep):
            path = _first_round(step, path, values, 1)
        if path:
            return path
    return []


def _first_round(group: RoundsStep, path: list[str], values: Mapping[str, Any], start: int) -> list[str]:
    for number in range(start, group.count + 1):
        known = {**values, group.name: group.value(number, ".".join(path), values)} if group.name else values
        found = _first(group.steps, [*path, f"r{number}"], known, 0)
        if found:
            return found
    return []
