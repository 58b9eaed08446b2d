"""What a behaviour is made of, as it stands in its file: values may still hold `${...}`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, Mapping, Tuple

from ...base.failure_policy import FailurePolicy
from .parameters import Parameter
from .times import At

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
