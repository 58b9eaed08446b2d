"""Which conditions a participant meets, and in which order: counterbalanced by the participant's number."""

from __future__ import annotations

import itertools
import random
from collections.abc import Mapping, Sequence

from .protocol import StudyProtocol

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
