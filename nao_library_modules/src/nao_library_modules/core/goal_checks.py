"""Checks of goals before anything is done, by a running module or by one with a table in place of the robot."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

from naoqi.errors import CallCanceled, CallTimeout, NaoError, RobotError, RobotUnreachable

from .errors import BadGoal, FunctionFailed, UnknownFunction, cut
from .files import config_file
from .waiting import WallClock


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


FACTS = "robot_facts.json"
"""File in `config`: NAOqi module -> method -> pairs of arguments and answer."""


@lru_cache(maxsize=None)
def robot_facts() -> dict[str, dict[str, list[Any]]]:
    return json.loads(config_file(FACTS).read_text(encoding="utf-8"))


class KnownRobot:
    """Takes the place of `robot.Robot`; what the table does not have is not known here."""

    address = "no robot"

    def __init__(self) -> None:
        """Be there at once, for ever."""
        ignore = lambda *_: None  # noqa: E731
        self.connection = SimpleNamespace(
            state="not connected",
            generation=1,
            last_error="",
            silent=0.0,
            add_listener=ignore,
            remove_listener=ignore,
            in_background=ignore,
        )

    def proxy(self, name: str) -> _KnownModule:
        return _KnownModule(name)


class _KnownModule:
    def __init__(self, name: str) -> None:
        self._name = name

    def call_async(self, method: str, *arguments: Any) -> _Answered:
        """Ask the table."""
        rows = robot_facts().get(self._name, {}).get(method)
        if rows is None:
            return _Answered(error=NotKnownHere(f"only a robot can tell {self._name}.{method}"))
        for known, answer in rows:
            if known == list(arguments):
                return _Answered(answer)
        return _Answered(error=RobotError(self._name, method, f"no {', '.join(map(repr, arguments))}"))


class _Answered:
    """A call that is over."""

    def __init__(self, answer: Any = None, error: NaoError | None = None) -> None:
        self._answer = answer
        self._error = error

    def wait(self, _timeout: float) -> bool:
        return True

    def done(self) -> bool:
        return True

    def add_done_callback(self, callback: Any) -> None:
        callback(self)

    def cancel(self) -> None:
        """It is over."""

    def result(self, timeout: float | None = None) -> Any:
        if self._error is not None:
            raise self._error
        return self._answer


def offline_module(kind: type) -> Any:
    """A module of a class of this package; it connects to nothing and serves nothing."""
    return kind("127.0.0.1", 9559, robot=KnownRobot(), node=_OfflineNode())


def _nothing(*_: Any) -> None:
    """What is published goes nowhere, what is served is never asked, and nothing is kept."""


class _OfflineNode:
    """Takes the place of `ServerNode`."""

    namespace = "/"
    driver = on_shutdown = publish_diagnostics = serve = serve_description = subscribe = staticmethod(_nothing)

    def __init__(self) -> None:
        self.clock = WallClock()

    def action_server(self, *_: Any) -> SimpleNamespace:
        """An action server that gets no goals."""
        return SimpleNamespace(start=_nothing)

    def event_sink(self) -> Callable[[str, Any], None]:
        return _nothing

    def frame_prefix(self) -> str:
        return ""

    def kept(self) -> SimpleNamespace:
        """What stands for `Kept`: a module that belongs to no node outlives nothing."""
        return SimpleNamespace(load=_nothing, save=_nothing, forget=_nothing)

    def seconds(self, _name: str, default: float) -> float:
        return default
