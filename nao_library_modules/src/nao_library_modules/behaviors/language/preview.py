"""What a program would do, told before it does it: its steps, boxes, waits, and what could not be checked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from .messages import fields_of
from .program import (
    BarrierNode,
    GoalNode,
    Node,
    OnTimeline,
    ParallelNode,
    Pause,
    RaceNode,
    RepeatNode,
    SequenceNode,
    name_of,
    walk,
)
from .servers import FunctionTables
from .yaml_text import dump_line

MOST_STEPS = 200
"""Steps that are told one by one."""
LONGEST = 200
"""Characters that tell of a step."""


@dataclass(frozen=True)
class Preview:
    """What there is to know of a program.

    Attributes:
        steps: Path of each step, what it is, and its fields; of repetitions the first round.
        boxes: Behaviours that it runs, also by way of its boxes.
        waits: s that its waits take if nothing fails, repetitions as their first round; goals take what they take.
        unchecked: Functions with fields that only their server knows together with its robot.
    """

    steps: tuple[str, ...] = ()
    boxes: tuple[str, ...] = ()
    waits: float = 0.0
    unchecked: tuple[str, ...] = ()


def preview_of(program: SequenceNode, tables: FunctionTables) -> Preview:
    nodes = [node for part in program.parts for node in walk(part)]
    boxes = dict.fromkeys(node.box for node in nodes if isinstance(node, SequenceNode) and node.box)
    return Preview(
        _few([_told(node) for node in nodes]),
        tuple(boxes),
        waits_of(program),
        _few([text for node in nodes if isinstance(node, GoalNode) for text in _unchecked(node, tables)]),
    )


def waits_of(node: Node) -> float:
    """S that the waits of a node take."""
    own = _waits_inside(node)
    return own if node.limit is None else min(own, node.limit)


def _waits_inside(node: Node) -> float:
    if isinstance(node, Pause):
        return node.duration
    if isinstance(node, GoalNode):
        return sum(message.time.to_sec() for message in _messages(node))
    if isinstance(node, RepeatNode):
        return node.count * sum(map(waits_of, node.parts))
    if isinstance(node, RaceNode):
        return min(map(waits_of, node.parts), default=0.0)
    if isinstance(node, ParallelNode):
        return max(map(waits_of, node.parts), default=0.0)
    if isinstance(node, OnTimeline):
        return max(times_of(node)[1].values(), default=0.0)
    return sum(map(waits_of, node.parts))


def in_order_of_time(node: Node) -> Sequence[Node]:
    """Parts of a node as they begin if goals take no time; of a timeline that may be another order than its own."""
    if not isinstance(node, OnTimeline):
        return node.parts
    begins, _ = times_of(node)
    return [node.nodes[i] for i in sorted(begins, key=lambda i: (begins[i], i))]


def times_of(
    timeline: OnTimeline, length: Callable[[Node], float] = waits_of
) -> tuple[dict[int, float], dict[int, float]]:
    """When the entries of a timeline begin and end, s from its beginning. None waits for itself: that was checked.

    Of one from which others are missing, as something is wrong with them, as much as can be told. `length`: s that an
    entry takes.
    """
    entries = timeline.nodes
    named = {name_of(entry): i for i, entry in enumerate(entries) if name_of(entry)}
    begins: dict[int, float] = {}
    ends: dict[int, float] = {}
    while len(ends) < len(entries):  # once is enough where nobody refers to what stands below
        for i, entry in enumerate(entries):
            other = named.get(entry.at.label) if entry.at.label else None
            if i in ends or not (other is None or other in ends):
                continue
            if isinstance(entry, BarrierNode):
                if any(above not in ends for above in range(i)):
                    continue
                begins[i] = max((ends[above] for above in range(i)), default=0.0)
            else:
                since = 0.0 if other is None else (ends if entry.at.of_end else begins)[other]
                begins[i] = since + entry.at.offset
            ends[i] = begins[i] + length(entry)
    return begins, ends


def _told(node: Node) -> str:
    text = f"{node.where} {node.what}"
    if isinstance(node, Pause):
        text += f" {node.duration:g} s"
    elif isinstance(node, RepeatNode):
        text += f" {node.count} times"
    elif isinstance(node, GoalNode):
        told = [_fields(message) for message in _messages(node)]
        text += f": {'; '.join(told)}" if any(told) else ""
    return _cut(text)


def _unchecked(node: GoalNode, tables: FunctionTables) -> Iterator[str]:
    messages = _messages(node)
    for position in tables.check(tables.server(node.server), messages)[1]:
        message = messages[position - 1]
        yield _cut(f"{node.where} {node.server}.{message.function}: {_fields(message)}")


def _messages(node: GoalNode) -> list[Any]:
    return list(getattr(node.goal, node.goal.__slots__[0]))


def _fields(message: Any) -> str:
    """Fields of a message that say what its function does, in one line."""
    fields = {name: value for name, value in fields_of(message).items() if name not in ("function", "on_error", "time")}
    return ", ".join(f"{name} {dump_line(value)}" for name, value in fields.items())


def _few(texts: list[str]) -> tuple[str, ...]:
    more = len(texts) - MOST_STEPS
    return (*texts[:MOST_STEPS], *([f"... and {more} more"] if more > 0 else []))


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
