"""Parts of a behaviour as its file states them: values may still hold `${...}`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any, Mapping, Tuple

from ...base.failure_policy import FailurePolicy
from .parameters import Parameter
from .times import At

PathParts = Tuple[Tuple[str, int], ...]
"""Separators and numbers: (("", 2), (".", 1)) is 2.1."""


def path_text(path: PathParts) -> str:
    """A path as text: 2.1, 3/1, 4#2.1."""
    return "".join(f"{separator}{number}" for separator, number in path)


def child(path: PathParts, number: int, separator: str = ".") -> PathParts:
    """Path of a part, counted from 1."""
    return (*path, (separator if path else "", number))


@dataclass(frozen=True)
class Step(ABC):
    """Common fields of all steps.

    Attributes:
        line: Of the file; 0 if unknown.
        label: Name on a timeline; may be empty.
        policy: What happens when it fails.
        limit: s after which it is ended and counts as done; None for no limit. May hold `${}`.
        at: Start, on a timeline.
        whole: The step itself is fully readable; steps inside it do not count.
    """

    path: PathParts
    line: int = 0
    label: str = ""
    policy: FailurePolicy = FailurePolicy()
    limit: Any = None
    at: At | None = None
    whole: bool = True

    @property
    @abstractmethod
    def what(self) -> str:
        """A word or two for error texts and previews."""

    @property
    def parts(self) -> tuple[Step, ...]:
        """Steps inside it, in the same file."""
        return ()


@dataclass(frozen=True)
class Unreadable(Step):
    """Placeholder for a step that cannot be read."""

    whole: bool = False

    @property
    def what(self) -> str:
        return "step"


@dataclass(frozen=True)
class Functions(Step):
    """One goal for a server: a function, or a chain of them."""

    server: str = ""
    functions: Tuple[Mapping[str, Any], ...] = ()
    chained: bool = False

    @property
    def what(self) -> str:
        """The server and its function."""
        if self.chained:
            return f"chain {self.server}"
        return f"{self.server}.{self.functions[0].get('function', '')}"


@dataclass(frozen=True)
class Wait(Step):
    """Let time pass.

    Attributes:
        duration: s of ROS time.
    """

    duration: Any = 0.0

    @property
    def what(self) -> str:
        return "wait"


@dataclass(frozen=True)
class Barrier(Step):
    """On a timeline: waits for all entries above. In a parallel: waits for the other branches that have it."""

    name: str = ""

    @property
    def what(self) -> str:
        return f"barrier {self.name}"


@dataclass(frozen=True)
class Composite(Step):
    steps: Tuple[Step, ...] = ()

    @property
    def parts(self) -> tuple[Step, ...]:
        return self.steps


@dataclass(frozen=True)
class Sequence(Composite):
    @property
    def what(self) -> str:
        return "sequence"


@dataclass(frozen=True)
class Parallel(Composite):
    @property
    def what(self) -> str:
        return "parallel"


@dataclass(frozen=True)
class Timeline(Composite):
    """Steps that start at given times."""

    @property
    def what(self) -> str:
        return "timeline"


@dataclass(frozen=True)
class Repeat(Composite):
    """A sequence that runs several times.

    Attributes:
        variable: Parameter that holds the number of the round, counted from 1; may be empty.
    """

    count: Any = 1
    variable: str = ""

    @property
    def what(self) -> str:
        return "repeat"


@dataclass(frozen=True)
class Box(Step):
    """A step that runs another behaviour."""

    name: str = ""
    arguments: Mapping[str, Any] = field(default_factory=dict)

    @property
    def what(self) -> str:
        return f"behavior {self.name}"


@dataclass(frozen=True)
class Behavior:
    """A behaviour.

    Attributes:
        help: What it does, in a line.
        file: Path of its file; empty if it is none.
    """

    name: str
    help: str
    parameters: Mapping[str, Parameter]
    body: Sequence
    tags: Tuple[str, ...] = ()
    file: str = ""
