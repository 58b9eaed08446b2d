"""Whether the servers could carry out the goals of a program, asked before any of them is sent."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ...functions.check_service import NotValidated
from ...functions.goal_checks import GoalCheck, GoalProblem
from .errors import Problem
from .preview import in_order_of_time
from .program import GoalNode, Node, RepeatNode
from .servers import FunctionTables

Ask = Callable[[str, Sequence[Any]], GoalCheck]
"""Has a server check goals; raises NotValidated if it does not."""


@dataclass(frozen=True)
class Validation:
    """What came of asking.

    `unvalidated`: servers that did not check their goals, and why. `unchecked`: path of a step and its function, for
    all that nobody could check to the end and all that would be skipped.
    """

    problems: Sequence[Problem] = ()
    unvalidated: Sequence[str] = ()
    unchecked: Sequence[str] = ()


def ask_nobody(_server: str, _goals: Sequence[Any]) -> GoalCheck:
    raise NotValidated("no server was asked")


def validate(program: Node, ask: Ask, tables: FunctionTables) -> Validation:
    """Have all goals of a program checked. What a server does not check is compared with what all robots have."""
    problems: list[Problem] = []
    unvalidated: list[str] = []
    unchecked: list[str] = []
    of_server: dict[str, list[GoalNode]] = {}
    may_fail: set[int] = set()
    for node, skipped in goals_of(program):
        of_server.setdefault(node.server, []).append(node)
        if skipped:
            may_fail.add(id(node))
    for server, nodes in of_server.items():
        goals = [node.goal for node in nodes]
        try:
            check = ask(server, goals)
            doubtful = [(each.goal, each.index) for each in check.unchecked]
            reason = "; ".join(dict.fromkeys(each.text for each in check.unchecked))
        except NotValidated as error:
            check, doubtful, reason = GoalCheck(), None, str(error)
        found = list(check.problems)
        if reason:
            unvalidated.append(f"{server}: {reason}")
            known = tables.check_goals(server, goals)
            found += [each for each in known.problems if doubtful is None or (each.goal, each.index) in doubtful]
            unchecked += [_step_and_function(nodes[each.goal], each) for each in known.unchecked]
        for each in found:
            node = nodes[each.goal]
            if id(node) in may_fail:  # as a recorded goal that failed
                unchecked.append(f"{_step_and_function(node, each)}: it would be skipped: {each.text}")
            else:
                problems.append(_problem(node, each))
    return Validation(problems, unvalidated, unchecked)


def goals_of(node: Node, skipped: bool = False) -> Iterator[tuple[GoalNode, bool]]:
    """Goals of a program in the order in which they are sent, as far as that is known.

    Of repetitions those of the first round, and those of the last one that differ.

    Yields:
        Goal, and whether the behaviour goes on if it fails.
    """
    skipped = skipped or node.policy.skip
    if isinstance(node, GoalNode):
        yield node, skipped
        return
    first = [pair for part in in_order_of_time(node) for pair in goals_of(part, skipped)]
    yield from first
    if isinstance(node, RepeatNode) and node.count > 1:
        for goal, of_last in goals_of(node.round(node.count), skipped):
            if all(goal.goal != each.goal for each, _ in first):
                yield goal, of_last


def _problem(node: GoalNode, problem: GoalProblem) -> Problem:
    inside = f" in {node.behavior}" if any(separator == "/" for separator, _ in node.path) else ""
    single = len(getattr(node.goal, node.goal.__slots__[0])) == 1
    return Problem(f"step {node.where}{inside}", problem.text if single else str(problem), node.line, node.file)


def _step_and_function(node: GoalNode, problem: GoalProblem) -> str:
    return f"{node.where} {node.server}.{problem.function}"
