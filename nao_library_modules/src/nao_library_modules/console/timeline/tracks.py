"""A behaviour as boxes on tracks: which row each is in, how long it takes, and what becomes of it while it runs."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, Tuple

import yaml

from naoqi.errors import NaoError

from ...behaviors.behavior_errors import Problem
from ...behaviors.behavior_reader import name_on_timeline
from ...behaviors.binder import Library, bind_what_can_be
from ...behaviors.checking import times_of
from ...behaviors.model import (
    Barrier,
    Behavior,
    Box,
    Composite,
    Functions,
    GoalNode,
    Node,
    OnTimeline,
    Parallel,
    ParallelNode,
    Pause,
    Race,
    RaceNode,
    Repeat,
    RepeatNode,
    SequenceNode,
    Step,
    Timeline,
    Wait,
    path_text,
    walk,
)
from ...behaviors.parameters import UNKNOWN, given_as_text
from ...behaviors.server_functions import FunctionTables
from ...behaviors.strict_yaml import dump_line
from ...core.files import config_file
from ...motion.recorded_motion import motion_of
from .document import BehaviorDocument, can_shift, can_stretch, step_path

USUAL = 1.0
"""s of a goal of which nothing is known."""
AT_ONCE = 0.1
"""s of a goal that sets something."""
OF_CHARACTER, OF_SPEECH = 0.065, 0.4
"""s that a character takes to be said, and every speech beside that: as the simulator's voice speaks."""
OF_POSTURE = 2.0
WALK, TURN = 0.08, 0.3
"""m/s and rad/s of a walk with its first and last step."""
_SETTING = ("set", "on", "off", "reset", "stop", "enable", "disable", "get", "list")


class Length(NamedTuple):
    """How long a goal takes, s. `sure`: whether its fields say so, or it was measured; else it is a guess."""

    seconds: float
    sure: bool


class Lengths:
    """Lengths of the nodes of a program. `measured`: path -> s that a step took when it ran."""

    def __init__(self, measured: Mapping[str, float] | None = None) -> None:
        self._measured = dict(measured or {})

    def of(self, node: Node) -> float:
        """S that a node takes."""
        inside = self._inside(node)
        return inside if node.limit is None else min(inside, node.limit)

    def sure(self, node: Node) -> bool:
        """Whether that is more than a guess."""
        if isinstance(node, GoalNode):
            return node.where in self._measured or length_of_goal(node).sure
        return all(map(self.sure, node.parts))

    def begins(self, timeline: OnTimeline) -> dict[str, float]:
        """When the entries of a timeline begin, s from its beginning, by path."""
        begins, _ = times_of(timeline, self.of)
        return {timeline.nodes[i].where: begin for i, begin in begins.items()}

    def _inside(self, node: Node) -> float:
        if isinstance(node, Pause):
            return node.duration
        if isinstance(node, GoalNode):
            return self._measured.get(node.where, length_of_goal(node).seconds)
        lengths = [self.of(part) for part in node.parts] if not isinstance(node, OnTimeline) else []
        if isinstance(node, RepeatNode):
            return node.count * sum(lengths)
        if isinstance(node, RaceNode):
            return min(lengths, default=0.0)
        if isinstance(node, ParallelNode):
            return max(lengths, default=0.0)
        if isinstance(node, OnTimeline):
            return max(times_of(node, self.of)[1].values(), default=0.0)
        return sum(lengths)


def length_of_goal(node: GoalNode) -> Length:
    """How long a goal takes."""
    lengths = [_length(node.server, message) for message in getattr(node.goal, node.goal.__slots__[0])]
    return Length(sum(each.seconds for each in lengths), all(each.sure for each in lengths))


def _length(server: str, message: Any) -> Length:
    wait = message.time.to_sec()
    own = _own_length(server, message)
    return Length(own.seconds + wait, own.sure)


def _own_length(server: str, message: Any) -> Length:
    function = message.function
    duration, times = getattr(message, "duration", 0.0), getattr(message, "times", ())
    if getattr(message, "background", False):
        return Length(AT_ONCE, False)
    if duration > 0.0:
        return Length(duration, True)
    if times:
        return Length(max(times), True)
    points = getattr(getattr(message, "trajectory", None), "points", ())
    if points:
        return Length(points[-1].time_from_start.to_sec(), True)
    if function == "playMotion":
        motion = shipped_motion(message.str_param)
        return Length(motion / (message.speed or 1.0), True) if motion else Length(USUAL, False)
    if function.lower().endswith("say"):
        return Length(OF_SPEECH + OF_CHARACTER * len(message.str_param), False)
    if function in ("moveTo", "walkTo") and len(message.values) >= 3:
        x, y, theta = message.values[-3:]
        return Length(AT_ONCE + math.hypot(x, y) / WALK + abs(theta) / TURN, False)
    if function == "goToPosture":
        return Length(OF_POSTURE, False)
    return Length(AT_ONCE if server == "NaoLights" or function.startswith(_SETTING) else USUAL, False)


@lru_cache(maxsize=None)
def shipped_motion(name: str) -> float:
    """S that a motion takes which comes with the library; 0 for others, which only their server knows."""
    folder = config_file("motions")
    path = folder / f"{Path(name).name}.yaml"
    if not path.is_file():
        return 0.0
    try:
        return motion_of(yaml.safe_load(path.read_text(encoding="utf-8")), name).duration
    except (OSError, ValueError, yaml.YAMLError, NaoError):
        return 0.0


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


RUNNING = ("began", "late", "told", "retried")
"""States of a step that goes on."""
OVER = ("ended", "failed", "skipped", "preempted")
MOST_LINES = 2000
"""Steps that are kept of one run."""
_PART = re.compile(r"[./#]?(\d+)")


@dataclass
class StepLine:
    """A step of the tree; times in s from the beginning of the behaviour, -1: not yet."""

    path: str
    what: str
    label: str = ""
    state: str = ""
    text: str = ""
    began: float = -1.0
    ended: float = -1.0

    @property
    def depth(self) -> int:
        """How many steps it is in."""
        return len(_PART.findall(self.path)) - 1 - self.path.count("#")

    @property
    def running(self) -> bool:
        return self.state in RUNNING


class RunView:
    """One run of a behaviour, from its beginning on; one thread tells, others look.

    `behavior`: its name; empty until it has begun.
    """

    def __init__(self) -> None:
        self.behavior = ""
        self._lines: dict[str, StepLine] = {}

    def told(self, feedback: Any) -> None:
        """Take in what the server tells. `feedback`: NaoBehaviorFeedback of a run."""
        if not feedback.path:
            return
        self.behavior = self.behavior or feedback.behavior
        if feedback.path not in self._lines and len(self._lines) >= MOST_LINES:
            return
        line = self._lines.setdefault(feedback.path, StepLine(feedback.path, feedback.what, feedback.label))
        if feedback.state == "began" and line.began < 0.0:
            line.began = feedback.time
        if feedback.state in OVER:
            line.ended = feedback.time
        if feedback.state != "told" or not line.state:
            line.state = feedback.state
        line.text = feedback.text or (line.text if feedback.state == "told" else "")

    def end(self) -> None:
        """The run is over: what has not ended was cut short."""
        for line in list(self._lines.values()):
            if line.running:
                line.state = "preempted"

    @property
    def running(self) -> bool:
        """Whether a step goes on."""
        return any(line.running for line in list(self._lines.values()))

    def tree(self) -> list[StepLine]:
        """All steps that have begun, parents before what is in them."""
        return sorted(list(self._lines.values()), key=lambda line: [int(each) for each in _PART.findall(line.path)])

    def states(self) -> dict[str, str]:
        """State of each step of the file."""
        states: dict[str, str] = {}
        for line in list(self._lines.values()):
            path = step_path(line.path)
            if "/" not in line.path:
                states[path] = line.state
            elif line.running:
                states[path] = "began"
        return states

    def measured(self) -> dict[str, float]:
        """Path -> s that each step took which has ended by itself."""
        return {
            line.path: line.ended - line.began
            for line in self._lines.values()
            if line.state == "ended" and 0.0 <= line.began <= line.ended
        }

    def cursor(self, tracks: Tracks, now: float) -> float:
        """Where the run is on the tracks, s: their times are guesses, so it follows the step that began last.

        `now`: s from the beginning of the behaviour.
        """
        place = 0.0
        latest = -1.0
        for line in list(self._lines.values()):
            box = tracks.box(step_path(line.path))
            if box is None or "/" in line.path or line.began < latest:
                continue
            latest = line.began
            elapsed = max(now - line.began, 0.0) if line.running else box.end - box.begin
            place = min(box.begin + elapsed, box.end)
        return place
