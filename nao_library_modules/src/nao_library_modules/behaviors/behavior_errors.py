"""What is wrong with a behaviour, or went wrong while it ran.

NaoError                 (naoqi.errors)
    BehaviorError        a behaviour cannot be run: name, problems
    NoSuchBehavior       nothing is stored under a name: name, known
    PlanFailure          (process_modules) something that a running plan expects
        StepFailed       a step of a running behaviour failed: path, what
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ..core.errors import cut, did_you_mean
from ..process_modules.failures import PlanFailure

MOST_TOLD = 10
"""Problems that the text of an error tells; the others are counted."""


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong."""

    where: str  # path of the step, or the part of the file: "step 2.1", "parameters"; empty: the file as a whole
    text: str  # what is wrong, and what is allowed
    line: int = 0  # of the file, counted from 1; 0 if it is not known
    file: str = ""  # path of the file; empty: a text of no file

    def __str__(self) -> str:
        if self.file:
            return place(self.file, self.line) + (f"{self.where}: {self.text}" if self.where else self.text)
        line = f"line {self.line}" if self.line else ""
        where = f"{self.where} ({line})" if self.where and line else self.where or line
        return f"{where}: {self.text}" if where else self.text


def place(file: str, line: int) -> str:
    """What a text begins with that is about a line of a file: "hello.yaml:9: "; empty without a file."""
    return f"{file}:{line}: " if file and line else f"{file}: " if file else ""


class BehaviorError(NaoError):
    """A behaviour cannot be run.

    `problems`: what is wrong, in the order of the file. `readable`: the `model.Behavior` with all that could be read of
    its file; None if nothing is known of that.
    """

    def __init__(self, name: str, problems: Sequence[Problem], readable: Any = None) -> None:
        told = "; ".join(map(str, problems[:MOST_TOLD]))
        more = f"; and {len(problems) - MOST_TOLD} more" if len(problems) > MOST_TOLD else ""
        super().__init__(cut(f"behavior {name}: {told}{more}"))
        self.name = name
        self.problems = tuple(problems)
        self.readable = readable


class NoSuchBehavior(NaoError):
    """Nothing is stored under a name. `known`: names there are, sorted."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        self.name = name
        self.known = sorted(known)
        there = f"there are {', '.join(self.known)}" if self.known else "none is stored"
        super().__init__(cut(f"there is no behavior {name!r}{did_you_mean(name, self.known)}; {there}"))


class StepFailed(PlanFailure):
    """A step of a running behaviour failed."""

    def __init__(self, path: str, what: str, problem: str, file: str = "", line: int = 0) -> None:
        text = f"{place(file, line)}step {path} ({what}): {problem}"
        super().__init__(text, path=path, what=what, problem=problem)
