"""Whether a module could carry out goals, by the checks that it runs before the first function; nothing is done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import CallCanceled, CallTimeout, NaoError, RobotUnreachable

from ..base.errors import BadGoal, FunctionFailed, UnknownFunction, cut


class NotKnownHere(NaoError):
    """A check asks for what is not known where it runs; only the server with its robot knows."""


CANNOT_TELL = (NotKnownHere, RobotUnreachable, CallTimeout, CallCanceled)
"""Errors of a check that say nothing about the goal."""
WRONG_GOAL = (BadGoal, UnknownFunction)
"""Errors that do, wherever it is checked."""


@dataclass(frozen=True)
class GoalProblem:
    """What is wrong with a function message of a goal, or what could not be told of it."""

    goal: int  # which of the goals, counted from 0
    index: int  # place of the function in it, counted from 0; -1: the goal as a whole
    function: str  # its name
    field: str  # the field that is wrong; empty if it is none alone
    text: str  # what is wrong, and what would be right

    def __str__(self) -> str:
        return f"function {self.index + 1} ({self.function}): {self.text}" if self.index >= 0 else self.text


@dataclass(frozen=True)
class GoalCheck:
    """What came of a check."""

    problems: Sequence[GoalProblem] = ()  # all that is wrong, in the order of the goals and their functions
    unchecked: Sequence[GoalProblem] = ()  # functions whose checks could not be finished, and why


def check_goals(module: Any, goals: Sequence[Any], elsewhere: bool = False) -> GoalCheck:
    """Check goals of a module, in the order in which they would be sent. Any thread; a goal that runs goes on.

    The first goal finds the robot as it is. Of the others, and while a goal runs, it is not known where the joints will
    be and how stiff: they are taken for able to move.

    Args:
        module: Of the family of NaoBasic.
        goals: What one makes, as a group of lights, the later ones have.
        elsewhere: The module only looks like the one that would carry them out: nothing is known of what that one's
            goals have left, nor of where the robot is.
    """
    view = module.view_for_checks()
    if elsewhere:
        for owner in view.copies.values():
            _forget(owner)
    cannot_tell = (Exception,) if elsewhere else CANNOT_TELL
    context: dict[str, Any] = {}
    problems: list[GoalProblem] = []
    unchecked: list[GoalProblem] = []
    with module.asking():
        for number, goal in enumerate(goals):
            view.begin_goal_check(number == 0 and not elsewhere and not module.busy)
            try:
                failures = module.chain.failures(
                    getattr(goal, goal.__slots__[0]),
                    view.begin_check,
                    context,
                    lambda owner: view.copies.get(id(owner), owner),
                )
            except BadGoal as error:
                problems.append(GoalProblem(number, -1, "", error.field, cut(str(error))))
                continue
            for failed in failures:
                told = isinstance(failed.cause, WRONG_GOAL) or not isinstance(failed.cause, cannot_tell)
                (problems if told else unchecked).append(_problem(number, failed))
    return GoalCheck(tuple(problems), tuple(unchecked))


def _forget(owner: Any) -> None:
    """See that a check which asks for what goals have left does not get an answer."""

    def unknown(_: Any) -> Any:
        raise NotKnownHere("only the server knows what its goals have left")

    kind = type(owner)
    if kind.left_by_goals:
        owner.__class__ = type(kind.__name__, (kind,), dict.fromkeys(kind.left_by_goals, property(unknown)))


def _problem(goal: int, failed: FunctionFailed) -> GoalProblem:
    cause = failed.cause
    field = cause.field if isinstance(cause, BadGoal) else ""
    text = str(cause) if isinstance(cause, NaoError) else f"{type(cause).__name__}: {cause}"
    return GoalProblem(goal, failed.position - 1, failed.function, field, cut(text))
