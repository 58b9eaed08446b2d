"""What runs: a behaviour with values for its parameters, its boxes unfolded, its goals built."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Callable, Tuple

from ...base.failure_policy import FailurePolicy
from .model import PathParts, path_text
from .times import At


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
