"""What a behaviour is made of: steps as they stand in its file, and nodes as they run.

Values of steps may still hold `${...}`. `binder` makes nodes of them, with values, boxes unfolded and
goals built.
An entry of a timeline begins `At` a time: `1.5`, `eyes`, `eyes.end`, `eyes.end + 0.5`, `${pause}`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Callable, ClassVar, Mapping, Tuple

from ..core.errors import BadGoal
from ..core.fields import FailurePolicy
from .parameters import Parameter

LABEL = r"[A-Za-z_][A-Za-z0-9_-]*"
_REFERENCE = re.compile(rf"\s*({LABEL})(\.end)?\s*(?:\+\s*(\S.*?))?\s*")
ALLOWED = "s from the beginning of the timeline, LABEL, LABEL.end, or one of these with '+ seconds'"


@dataclass(frozen=True)
class At:
    """When an entry begins."""

    offset: Any = 0.0  # s, >= 0, from the beginning of the timeline or from the label; may hold `${}`
    label: str = ""  # entry or barrier that it depends on; empty: the beginning of the timeline
    of_end: bool = False  # whether it is the end of that entry that counts, not its beginning


def at_of(value: Any) -> At:
    """What a value of `at` means. Raises BadGoal if it means nothing."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return At(value)
    if not isinstance(value, str):
        raise BadGoal("at", value, ALLOWED)
    match = _REFERENCE.fullmatch(value)
    offset = match[3] or "0" if match else value.strip()
    try:
        seconds = offset if offset.startswith("${") else float(offset)
    except ValueError:
        raise BadGoal("at", value, ALLOWED) from None
    return At(seconds, match[1], match[2] is not None) if match else At(seconds)


# --- steps of a file --------------------------------------------------------------------------------------------------

PathParts = Tuple[Tuple[str, int], ...]
"""Separators and numbers: (("", 2), (".", 1)) is 2.1."""


def path_text(path: PathParts) -> str:
    """A path as people read it: 2.1, 3/1, 4#2.1."""
    return "".join(f"{separator}{number}" for separator, number in path)


def child(path: PathParts, number: int, separator: str = ".") -> PathParts:
    """Path of a part, counted from 1."""
    return (*path, (separator if path else "", number))


@dataclass(frozen=True)
class Step:
    """What all steps have."""

    what: ClassVar[str]  # what it is, in a word or two
    path: PathParts  # where it stands
    line: int = 0  # of the file; 0 if it is not known
    label: str = ""  # its name on a timeline; may be empty
    policy: FailurePolicy = FailurePolicy()  # what happens when it fails
    limit: Any = None  # s after which it is ended and counts as done; None for no limit. May hold `${}`
    at: At | None = None  # when it begins, on a timeline
    unusual: bool = False  # whether its numbers are meant though they are not usual
    whole: bool = True  # whether all of it could be read; what is inside of it does not count

    @property
    def parts(self) -> tuple[Step, ...]:
        """Steps inside of it, in the same file."""
        return ()


@dataclass(frozen=True)
class Unreadable(Step):
    """Something in the place of a step that is none."""

    what = "step"
    whole: bool = False


@dataclass(frozen=True)
class Functions(Step):
    """One goal for a server: a function, or a chain of them."""

    server: str = ""
    functions: Tuple[Mapping[str, Any], ...] = ()  # fields of each function message
    chained: bool = False

    @property
    def what(self) -> str:
        if self.chained:
            return f"chain {self.server}"
        return f"{self.server}.{self.functions[0].get('function', '')}"


@dataclass(frozen=True)
class Wait(Step):
    """Let time pass."""

    what = "wait"
    duration: Any = 0.0  # s of ROS time


@dataclass(frozen=True)
class Barrier(Step):
    """On a timeline: when all above has ended. In a parallel: where the branches that have it wait for each other."""

    name: str = ""

    @property
    def what(self) -> str:
        return f"barrier {self.name}"


@dataclass(frozen=True)
class Composite(Step):
    """Steps in steps."""

    steps: Tuple[Step, ...] = ()

    @property
    def parts(self) -> tuple[Step, ...]:
        return self.steps


@dataclass(frozen=True)
class Sequence(Composite):
    """One after the other."""

    what = "sequence"


@dataclass(frozen=True)
class Parallel(Composite):
    """All at once."""

    what = "parallel"


@dataclass(frozen=True)
class Race(Parallel):
    """All at once, until the first is over: the others are ended then."""

    what = "race"


@dataclass(frozen=True)
class Timeline(Composite):
    """Each at its time."""

    what = "timeline"


@dataclass(frozen=True)
class Repeat(Composite):
    """A sequence several times."""

    what = "repeat"
    count: Any = 1
    variable: str = ""  # parameter that has the number of the round, counted from 1; may be empty


@dataclass(frozen=True)
class Box(Step):
    """Another behaviour."""

    name: str = ""
    arguments: Mapping[str, Any] = field(default_factory=dict)

    @property
    def what(self) -> str:
        return f"behavior {self.name}"


@dataclass(frozen=True)
class Behavior:
    """A behaviour."""

    name: str
    help: str  # what it does, in a line
    parameters: Mapping[str, Parameter]
    body: Sequence
    tags: Tuple[str, ...] = ()  # what it is filed under
    file: str = ""  # path of its file; empty if it is none


# --- nodes that run ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Node:
    """A step that can run."""

    path: PathParts  # where it stands, boxes and rounds included
    behavior: str  # file that it is in
    label: str
    what: str
    policy: FailurePolicy = FailurePolicy()  # what happens when it fails
    limit: float | None = None  # s after which it is ended and counts as done; None for no limit
    at: At = At()  # when it begins, on a timeline
    file: str = ""  # path of the file; empty: a text of no file
    line: int = 0  # of the file; 0 if it is not known

    @property
    def where(self) -> str:
        """Its path as people read it."""
        return path_text(self.path)

    @property
    def parts(self) -> tuple[Node, ...]:
        """Nodes inside of it; of a repetition those of the first round."""
        return ()


@dataclass(frozen=True)
class GoalNode(Node):
    """A goal for a server."""

    server: str = ""
    goal: Any = None


@dataclass(frozen=True)
class Pause(Node):
    """Time that passes, s."""

    duration: float = 0.0


@dataclass(frozen=True)
class BarrierNode(Node):
    """A barrier."""

    name: str = ""
    home: PathParts | None = None  # path of the parallel whose branches meet here; None on a timeline
    branch: int = 0  # number of the branch that it is in, counted from 1


@dataclass(frozen=True)
class Group(Node):
    """Nodes in a node."""

    nodes: Tuple[Node, ...] = ()

    @property
    def parts(self) -> tuple[Node, ...]:
        return self.nodes


@dataclass(frozen=True)
class SequenceNode(Group):
    """One after the other."""

    box: str = ""  # behaviour that runs here, of a box; empty of what is none


class ParallelNode(Group):
    """All at the same time."""


class RaceNode(ParallelNode):
    """All at the same time, until the first is over."""


class OnTimeline(Group):
    """Each at its time."""


@dataclass(frozen=True)
class RepeatNode(Node):
    """A sequence several times."""

    count: int = 0
    round: Callable[[int], Node] = lambda number: Node((), "", "", "")  # the sequence of a round, counted from 1

    @property
    def parts(self) -> tuple[Node, ...]:
        """What it does in the first round."""
        return self.round(1).parts if self.count else ()


def walk(node: Node) -> Iterator[Node]:
    """A node and all inside of it, in the order of the file."""
    yield node
    for part in node.parts:
        yield from walk(part)


def walk_rounds(
    node: Node, left_out: Callable[[PathParts], bool], rounds: tuple[tuple[int, int], ...] = ()
) -> Iterator[Node]:
    """As `walk`, with all rounds of repetitions; those after the first one as plain nodes, which are quickly made.

    `left_out`: whether the repetition at a path is to be passed over with all its rounds. `rounds`: where in its path
    `node` has the number of a round that is not the first one, and that number.
    """
    here = _in_rounds(node, rounds)
    yield here
    if not isinstance(node, RepeatNode):
        for part in node.parts:
            yield from walk_rounds(part, left_out, rounds)
    elif not left_out(here.path):
        parts = node.parts
        for number in range(1, node.count + 1):
            inside = rounds if number == 1 else (*rounds, (len(node.path), number))
            for part in parts:
                yield from walk_rounds(part, left_out, inside)


def _in_rounds(node: Node, rounds: tuple[tuple[int, int], ...]) -> Node:
    """A node of the first rounds as it stands in others."""
    if not rounds:
        return node
    path = list(node.path)
    for depth, number in rounds:
        path[depth] = ("#", number)
    return Node(tuple(path), node.behavior, node.label, node.what, file=node.file, line=node.line)


def servers_in(node: Node) -> dict[str, None]:
    """Servers that a node uses, in the order in which they come."""
    return dict.fromkeys(each.server for each in walk(node) if isinstance(each, GoalNode))


def name_of(node: Node) -> str:
    """What times on a timeline may refer to."""
    return node.name if isinstance(node, BarrierNode) else node.label
