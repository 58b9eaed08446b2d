"""A behaviour as boxes on tracks: which row each is in, when it begins and ends, and what can be done to it by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Tuple

from naoqi.errors import NaoError

from ...behaviors.language.binder import Library, bind_what_can_be
from ...behaviors.language.errors import Problem
from ...behaviors.language.expressions import UNKNOWN
from ...behaviors.language.model import (
    Barrier,
    Behavior,
    Box,
    Composite,
    Functions,
    Parallel,
    Race,
    Repeat,
    Step,
    Timeline,
    Wait,
    path_text,
)
from ...behaviors.language.parameters import given_as_text
from ...behaviors.language.program import Node, OnTimeline, RepeatNode, SequenceNode, walk
from ...behaviors.language.servers import FunctionTables
from ...behaviors.language.structure import name_on_timeline
from ...behaviors.language.yaml_text import dump_line
from .document import BehaviorDocument
from .lengths import USUAL, Lengths
from .steps import can_shift, can_stretch, step_path

LONGEST_TEXT = 80
"""Characters that a box says of its fields."""
BY_TIME, BY_ORDER, FIXED = "time", "order", ""
"""How a box is dragged: to another time, among those beside it, or not at all."""


@dataclass(frozen=True)
class TrackBox:
    """A step on the tracks."""

    path: str
    kind: str  # goal, wait, box, parallel, timeline, repeat, sequence, barrier, unreadable
    title: str  # what it is
    text: str  # its fields, in a line
    server: str  # of a goal; empty
    label: str
    row: int  # counted from 0, from the top
    rows: int  # how many it is high
    begin: float  # s from the beginning of the behaviour
    end: float  # s likewise
    sure: bool  # whether its length is more than a guess
    moves: str  # BY_TIME, BY_ORDER or FIXED
    stretches: bool
    line: int  # of the file; 0: not known
    problem: str = ""  # what is wrong with it; empty: nothing


@dataclass(frozen=True)
class Tracks:
    """All boxes, those around others first.

    `links`: path of a step and of one whose time counts from it. `length`: s of the whole.
    """

    boxes: Tuple[TrackBox, ...] = ()
    links: Tuple[Tuple[str, str], ...] = ()
    rows: int = 0
    length: float = 0.0

    def box(self, path: str) -> TrackBox | None:
        return next((box for box in self.boxes if box.path == path), None)

    def to_json(self) -> dict[str, Any]:
        """Plain values for the browser."""
        return asdict(self)


def tracks_of(
    document: BehaviorDocument,
    library: Library,
    tables: FunctionTables,
    given: Sequence[str] = (),
    measured: Mapping[str, float] | None = None,
    problems: Sequence[Problem] = (),
) -> Tracks:
    """Lay out what can be read of a behaviour.

    Args:
        document: The behaviour.
        library: For its boxes.
        tables: Functions of the servers.
        given: Values of its parameters as "name=value"; the defaults for the others and for those that will not do.
        measured: Path -> s that a step took when it ran.
        problems: What a check found: boxes that they are about are marked.
    """
    behavior = document.behavior
    if behavior is None:
        return Tracks()
    program = program_of(behavior, library, tables, given)
    told: dict[str, str] = {}
    for problem in (*document.problems, *problems):
        told.setdefault(step_path(problem.where.partition(" ")[2].partition(" ")[0]), problem.text)
    layout = _Layout(document, program, Lengths(measured), told)
    rows, length = layout.in_order(behavior.body.steps, 0.0, 0)
    return Tracks(tuple(layout.boxes), tuple(layout.links), rows, length)


def program_of(behavior: Behavior, library: Library, tables: FunctionTables, given: Sequence[str] = ()) -> SequenceNode:
    """What can be made of a behaviour, whatever is wrong with the rest of it."""
    values = given_as_text(behavior.parameters, given, [])
    try:
        return bind_what_can_be(behavior, values, library, tables)[0]
    except NaoError:
        return SequenceNode((), behavior.name, "", "")


class _Layout:
    """Collects boxes."""

    def __init__(
        self, document: BehaviorDocument, program: Node, lengths: Lengths, problems: Mapping[str, str]
    ) -> None:
        self.boxes: list[TrackBox] = []
        self.links: list[tuple[str, str]] = []
        self._document = document
        self._lengths = lengths
        self._problems = problems
        self._nodes: dict[str, Node] = {}
        for node in walk(program):
            if not any(separator == "/" for separator, _ in node.path):
                path = tuple(part for part in node.path if part[0] != "#")
                self._nodes.setdefault(path_text(path), node)

    def in_order(self, steps: Sequence[Step], begin: float, row: int) -> tuple[int, float]:
        """Lay out steps one after the other; how many rows that takes, and when the last one ends."""
        most = 1
        for step in steps:
            rows, begin = self._step(step, begin, row, BY_ORDER if len(steps) > 1 else FIXED)
            most = max(most, rows)
        return most, begin

    def _step(self, step: Step, begin: float, row: int, moves: str) -> tuple[int, float]:
        path = path_text(step.path)
        node = self._nodes.get(path)
        if not isinstance(step, Composite):
            end = begin + (self._lengths.of(node) if node is not None else 0.0 if isinstance(step, Barrier) else USUAL)
            self._add(step, path, row, 1, begin, end, moves)
            return 1, end
        here = len(self.boxes)
        if isinstance(step, Parallel):
            rows, end = self._beside(step.steps, begin, row + 1)
            if isinstance(step, Race) and node is not None:
                end = min((begin + self._lengths.of(part) for part in node.parts), default=begin)
        elif isinstance(step, Timeline):
            rows, end = self._timed(step, node, begin, row + 1)
        else:
            rows, end = self.in_order(step.steps, begin, row + 1)
        if isinstance(step, Repeat) and isinstance(node, RepeatNode):
            end = begin + (end - begin) * node.count
        if node is not None and node.limit is not None:
            end = min(end, begin + node.limit)
        self._add(step, path, row, rows + 1, begin, end, moves, here)
        return rows + 1, end

    def _beside(self, steps: Sequence[Step], begin: float, row: int) -> tuple[int, float]:
        rows, end = 0, begin
        for step in steps:
            more, over = self._step(step, begin, row + rows, BY_ORDER if len(steps) > 1 else FIXED)
            rows, end = rows + more, max(end, over)
        return max(rows, 1), end

    def _timed(self, timeline: Timeline, node: Node | None, begin: float, row: int) -> tuple[int, float]:
        """Entries of a timeline: those of a server share a row as long as they do not overlap."""
        begins = self._lengths.begins(node) if isinstance(node, OnTimeline) else {}
        wheres = {path: each.where for path, each in self._nodes.items()}
        named: dict[str, str] = {}
        for entry in timeline.steps:
            named.setdefault(name_on_timeline(entry), path_text(entry.path))
        free: dict[str, list[tuple[int, float]]] = {}  # server -> rows, and when each is free again
        rows, end = 0, begin
        barriers = []
        for entry in timeline.steps:
            path = path_text(entry.path)
            at = begin + begins.get(wheres.get(path, path), _offset(entry))
            if entry.at is not None and entry.at.label and entry.at.label in named and not isinstance(entry, Barrier):
                self.links.append((named[entry.at.label], path))
            if isinstance(entry, Barrier):
                barriers.append((entry, path, at))
                continue
            server = entry.server if isinstance(entry, Functions) else ""
            lane = next((i for i, (_, until) in enumerate(free.get(server, [])) if server and until <= at + 1e-9), None)
            movable = BY_TIME if can_shift(self._document.step(path)) else FIXED
            if lane is None:
                used, over = self._step(entry, at, row + rows, movable)
                free.setdefault(server, []).append((row + rows, over))
                rows += used
            else:
                where = free[server][lane][0]
                _, over = self._step(entry, at, where, movable)
                free[server][lane] = (where, over)
            end = max(end, over)
        for entry, path, at in barriers:
            self._add(entry, path, row, max(rows, 1), at, at, FIXED)
        return max(rows, 1), end

    def _add(
        self,
        step: Step,
        path: str,
        row: int,
        rows: int,
        begin: float,
        end: float,
        moves: str,
        position: int | None = None,
    ) -> None:
        node = self._nodes.get(path)
        kind, text = _kind(step), _text(step, node)
        box = TrackBox(
            path,
            kind,
            step.what,
            text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 1]}…",
            step.server if isinstance(step, Functions) else "",
            step.label,
            row,
            rows,
            round(begin, 4),
            round(end, 4),
            node is not None and self._lengths.sure(node),
            moves,
            can_stretch(self._document.step(path)),
            step.line,
            self._problems.get(path, ""),
        )
        self.boxes.insert(len(self.boxes) if position is None else position, box)


def _offset(entry: Step) -> float:
    offset = entry.at.offset if entry.at is not None else 0.0
    return float(offset) if isinstance(offset, (int, float)) else 0.0


def _kind(step: Step) -> str:
    kinds = {Functions: "goal", Wait: "wait", Box: "box", Parallel: "parallel", Timeline: "timeline"}
    kinds.update({Race: "race", Repeat: "repeat", Barrier: "barrier"})
    return kinds.get(type(step), "sequence" if isinstance(step, Composite) else "unreadable")


def _text(step: Step, node: Node | None) -> str:
    if isinstance(step, Functions):
        fields = [{name: value for name, value in each.items() if name != "function"} for each in step.functions]
        names = [f"{each.get('function', '')} " if step.chained else "" for each in step.functions]
        return "; ".join(name + _line(each) for name, each in zip(names, fields))
    if isinstance(step, Wait):
        return f"{_line(step.duration)} s"
    if isinstance(step, Repeat):
        return f"{_line(step.count)} times"
    if isinstance(step, Box):
        return _line(dict(step.arguments))
    return ""


def _line(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name}: {_line(each)}" for name, each in value.items())
    if value is UNKNOWN:
        return "?"
    return value if isinstance(value, str) else dump_line(value)
