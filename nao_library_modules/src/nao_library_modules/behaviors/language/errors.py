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

from naoqi.errors import NaoError

from ..errors import cut
from ..process_modules.failures import PlanFailure
from ..suggestion import did_you_mean

MOST_TOLD = 10
"""Problems that the text of an error tells; the others are counted."""


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong.

    Attributes:
        where: Path of the step, or the part of the file: "step 2.1", "parameters"; empty: the file as a whole.
        text: What is wrong, and what is allowed.
        line: Of the file, counted from 1; 0 if it is not known.
    """

    where: str
    text: str
    line: int = 0

    def __str__(self) -> str:
        line = f" (line {self.line})" if self.line else ""
        return f"{self.where}{line}: {self.text}" if self.where else self.text


class BehaviorError(NaoError):
    """A behaviour cannot be run.

    Attributes:
        name: Of the behaviour.
        problems: What is wrong, in the order of the file.
    """

    def __init__(self, name: str, problems: Sequence[Problem]) -> None:
        """Compose the text.

        Args:
            name: Of the behaviour.
            problems: At least one.
        """
        told = "; ".join(map(str, problems[:MOST_TOLD]))
        more = f"; and {len(problems) - MOST_TOLD} more" if len(problems) > MOST_TOLD else ""
        super().__init__(cut(f"behavior {name}: {told}{more}"))
        self.name = name
        self.problems = tuple(problems)


class NoSuchBehavior(NaoError):
    """Nothing is stored under a name.

    Attributes:
        name: The name.
        known: Names there are, sorted.
    """

    def __init__(self, name: str, known: Iterable[str]) -> None:
        """Compose the text."""
        self.name = name
        self.known = sorted(known)
        there = f"there are {', '.join(self.known)}" if self.known else "none is stored"
        super().__init__(cut(f"there is no behavior {name!r}{did_you_mean(name, self.known)}; {there}"))


class StepFailed(PlanFailure):
    """A step of a running behaviour failed.

    Attributes:
        path: Of the step.
        what: What it is.
        problem: Why it failed.
    """

    def __init__(self, path: str, what: str, problem: str) -> None:
        """Compose the text."""
        super().__init__(f"step {path} ({what}): {problem}", path=path, what=what, problem=problem)
