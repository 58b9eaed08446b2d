"""An executable behaviour: parameters have values, boxes are expanded, goals are built."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Callable, Tuple

from ...base.failure_policy import FailurePolicy
from .model import PathParts, path_text
from .times import At


@dataclass(frozen=True)
class Node:
    """An executable step.

    Attributes:
        path: Includes boxes and rounds.
        behavior: Behaviour whose file holds it.
        policy: What happens when it fails.
        limit: s after which it is ended and counts as done; None for no limit.
        at: Start, on a timeline.
        file: Path of the file; empty: the text comes from no file.
        line: Of the file; 0 if unknown.
    """

    path: PathParts
    behavior: str
    label: str
    what: str
    policy: FailurePolicy = FailurePolicy()
    limit: float | None = None
    at: At = At()
    file: str = ""
    line: int = 0

    @property
    def where(self) -> str:
        """Its path as text."""
        return path_text(self.path)

    @property
    def parts(self) -> tuple[Node, ...]:
        """Nodes inside it; of a repetition those of the first round."""
        return ()


@dataclass(frozen=True)
class GoalNode(Node):
    server: str = ""
    goal: Any = None


@dataclass(frozen=True)
class Pause(Node):
    """A wait; duration in s."""

    duration: float = 0.0


@dataclass(frozen=True)
class BarrierNode(Node):
    """A barrier.

    Attributes:
        home: Path of the parallel whose branches meet here; None on a timeline.
        branch: Number of its branch, counted from 1.
    """

    name: str = ""
    home: PathParts | None = None
    branch: int = 0


@dataclass(frozen=True)
class Group(Node):
    nodes: Tuple[Node, ...] = ()

    @property
    def parts(self) -> tuple[Node, ...]:
        return self.nodes


@dataclass(frozen=True)
class SequenceNode(Group):
    """Nodes that run one after the other.

    Attributes:
        box: Behaviour of the box that it expands; empty: no box.
    """

    box: str = ""


class ParallelNode(Group):
    """All at the same time."""


class OnTimeline(Group):
    """Nodes that start at given times."""


@dataclass(frozen=True)
class RepeatNode(Node):
    """A sequence that runs several times.

    Attributes:
        round: Gives the sequence of a round, counted from 1.
    """

    count: int = 0
    round: Callable[[int], Node] = lambda number: Node((), "", "", "")

    @property
    def parts(self) -> tuple[Node, ...]:
        """The first round."""
        return self.round(1).parts if self.count else ()


def walk(node: Node) -> Iterator[Node]:
    """A node and all inside it, in file order."""
    yield node
    for part in node.parts:
        yield from walk(part)


def walk_rounds(
    node: Node, left_out: Callable[[PathParts], bool], rounds: tuple[tuple[int, int], ...] = ()
) -> Iterator[Node]:
    """As `walk`, but with every round of a repetition; rounds after the first are cheap plain nodes.

    Args:
        left_out: Whether to skip the repetition at a path with all its rounds.
        rounds: Position in the path of `node`, and round number, for each round other than the first.
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
    """A node of a first round, with its path moved to the given rounds."""
    if not rounds:
        return node
    path = list(node.path)
    for depth, number in rounds:
        path[depth] = ("#", number)
    return Node(tuple(path), node.behavior, node.label, node.what, file=node.file, line=node.line)


def servers_in(node: Node) -> dict[str, None]:
    """Servers that a node uses, in order of first use."""
    return dict.fromkeys(each.server for each in walk(node) if isinstance(each, GoalNode))


def name_of(node: Node) -> str:
    """The name by which timeline times refer to it."""
    return node.name if isinstance(node, BarrierNode) else node.label
