"""From a behaviour to what runs: values for `${}`, boxes, goals; and everything that can be checked on the way."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Callable

from naoqi.errors import NaoError

from ..core.errors import BadGoal
from ..core.fields import limit, require_usual, usual
from .behavior_errors import BehaviorError, Problem
from .model import (
    At,
    Barrier,
    BarrierNode,
    Behavior,
    Box,
    Functions,
    GoalNode,
    Node,
    OnTimeline,
    Parallel,
    ParallelNode,
    PathParts,
    Pause,
    Race,
    RaceNode,
    Repeat,
    RepeatNode,
    SequenceNode,
    Step,
    Timeline,
    Unreadable,
    Wait,
    path_text,
    servers_in,
)
from .parameters import UNKNOWN, NotKnown, arguments, substitute, text_of
from .server_functions import FunctionTables, message_of

MOST_NODES = 10_000
"""Steps of a program, boxes unfolded: a few boxes in boxes can stand for more than any memory holds."""
MOST_ROUNDS, LONGEST = limit("rounds").highest, limit("wait").highest
"""s that a step may wait."""

Library = Callable[[str], Behavior]
"""Gives the behaviour of a name, or raises NaoError."""


def bind(
    behavior: Behavior, values: Mapping[str, Any], library: Library, tables: FunctionTables | None = None
) -> SequenceNode:
    """Make a program of a behaviour. Nothing is asked of servers or robot.

    `values`: name -> value of some or all of its parameters. `tables`: functions of the servers; without them only
    messages and fields are checked. Raises BehaviorError with everything that is wrong; BadGoal: a value for a
    parameter will not do.
    """
    program, problems = bind_what_can_be(behavior, values, library, tables)
    if problems:
        raise BehaviorError(behavior.name, problems)
    return program


def bind_what_can_be(
    behavior: Behavior, values: Mapping[str, Any], library: Library, tables: FunctionTables | None = None
) -> tuple[SequenceNode, list[Problem]]:
    """As `bind`: the program of all steps that could be read, and what is wrong with them and the others.

    Raises BadGoal if a value for a parameter will not do.
    """
    binder = _Binder(library, tables or FunctionTables(), tables is not None)
    program = binder.behavior(behavior, arguments(behavior.parameters, values), (), behavior.name)
    return program, binder.problems


@dataclass(frozen=True)
class _Scope:
    """Where steps stand."""

    behavior: str
    file: str
    values: Mapping[str, Any]  # of the parameters
    prefix: PathParts  # path of the box or round
    boxes: tuple[str, ...]  # behaviours that they are in, the outermost first

    def path(self, path: PathParts) -> PathParts:
        """Path from the outermost behaviour on."""
        if not self.prefix or not path:
            return self.prefix + path
        return (*self.prefix, ("/" if not path[0][0] else path[0][0], path[0][1]), *path[1:])


class _Binder:
    """Makes nodes of steps, and notes what is wrong."""

    def __init__(self, library: Library, tables: FunctionTables, checks: bool) -> None:
        self.problems: list[Problem] = []
        self._library = library
        self._tables = tables
        self._checks = checks
        self._loaded: dict[str, Behavior] = {}
        self._nodes = 0

    def behavior(self, behavior: Behavior, values: Mapping[str, Any], prefix: PathParts, *boxes: str) -> SequenceNode:
        """The program of a behaviour, on its own or in a box.

        `prefix`: path of the box. `boxes`: names of the behaviours that it is in, itself the last.
        """
        scope = _Scope(behavior.name, behavior.file, values, prefix, boxes)
        body = behavior.body
        return SequenceNode(
            scope.path(body.path),
            behavior.name,
            "",
            f"behavior {behavior.name}",
            file=behavior.file,
            nodes=self._all(body.parts, scope),
        )

    def _all(self, steps: Iterable[Step], scope: _Scope, home: tuple[PathParts, int] | None = None) -> tuple[Node, ...]:
        return tuple(node for node in (self._guarded(step, scope, home) for step in steps) if node is not None)

    def _guarded(self, step: Step, scope: _Scope, home: tuple[PathParts, int] | None) -> Node | None:
        self._nodes += 1
        if self._nodes > MOST_NODES:
            if self._nodes == MOST_NODES + 1:
                self._note(step, scope, f"with all its boxes, the behavior has more than {MOST_NODES} steps")
            return None
        try:
            return self._node(step, scope, home)
        except NotKnown:
            pass  # the value that it depends on is told already
        except BehaviorError as error:
            for problem in error.problems:
                self._note(step, scope, f"behavior {error.name}: {problem}")
        except NaoError as error:
            self._note(step, scope, str(error))
        return None

    def _note(self, step: Step, scope: _Scope, text: str) -> None:
        inside = f" in {scope.behavior}" if len(scope.boxes) > 1 else ""
        problem = Problem(f"step {path_text(scope.path(step.path))}{inside}", text, step.line, scope.file)
        if problem not in self.problems:  # a repetition is looked at in its first and its last round
            self.problems.append(problem)

    def _node(self, step: Step, scope: _Scope, home: tuple[PathParts, int] | None) -> Node | None:
        common: dict[str, Any] = {
            "path": scope.path(step.path),
            "behavior": scope.behavior,
            "label": step.label,
            "what": step.what,
            "policy": step.policy,
            "file": scope.file,
            "line": step.line,
        }
        if step.limit is not None:
            common["limit"] = self._seconds("for", step.limit, step, scope)
        if step.at is not None:
            at = step.at
            common["at"] = At(self._seconds("at", at.offset, step, scope), at.label, at.of_end)
        if isinstance(step, Unreadable):
            return None
        if isinstance(step, Functions):
            return self._goal(step, scope, common)
        if isinstance(step, Wait):
            return Pause(**common, duration=self._seconds("wait", step.duration, step, scope))
        if isinstance(step, Barrier):
            where, branch = home or (None, 0)
            return BarrierNode(**common, name=step.name, home=where, branch=branch)
        if isinstance(step, Box):
            return self._box(step, scope, common)
        if isinstance(step, Repeat):
            return self._rounds(step, scope, common)
        if isinstance(step, Parallel):
            return self._parallel(step, scope, common)
        if isinstance(step, Timeline):
            return OnTimeline(**common, nodes=self._all(step.parts, scope))
        return SequenceNode(**common, nodes=self._all(step.parts, scope, home))

    def _seconds(self, key: str, value: Any, step: Step, scope: _Scope) -> float:
        """A time of a step, s; noted where it is not usual, unless the step says that it is meant."""
        found = _seconds(key, value, scope.values)
        if self._checks and not step.unusual:
            try:
                require_usual(key, found, usual("wait"))
            except BadGoal as error:
                self._note(step, scope, str(error))
        return found

    def _goal(self, step: Functions, scope: _Scope, common: dict[str, Any]) -> Node | None:
        server = self._tables.server(step.server)
        messages, wrong = [], set()
        for position, fields in enumerate(step.functions, start=1):
            where = f"function {position}" if len(step.functions) > 1 else ""
            message = server.function()
            taken = self._tables.fields(server, fields.get("function", "")) if self._checks else []
            for name, value in fields.items():
                try:
                    filled = message_of(server.function, {name: substitute(value, scope.values)}, where, taken)
                    setattr(message, name, getattr(filled, name))
                except NotKnown:
                    wrong.add(position)
                except NaoError as error:
                    wrong.add(position)
                    self._note(step, scope, str(error))
            messages.append(message)
        failures = self._tables.check(server, messages)[0] if self._checks else []
        if self._checks and not step.unusual:
            failures += self._tables.unusual(server, messages)
        for failed in failures:
            if failed.position not in wrong:  # a field without its value would be told as another mistake
                self._note(step, scope, str(failed if len(messages) > 1 else failed.cause))
        return None if wrong else GoalNode(**common, server=server.name, goal=server.goal(messages))

    def _box(self, step: Box, scope: _Scope, common: dict[str, Any]) -> Node:
        if step.name in scope.boxes:
            circle = " -> ".join((*scope.boxes[scope.boxes.index(step.name) :], step.name))
            raise BadGoal("behavior", step.name, "a behavior that does not come back here", f"a circle: {circle}")
        if step.name not in self._loaded:
            self._loaded[step.name] = self._library(step.name)
        behavior = self._loaded[step.name]
        values = arguments(
            behavior.parameters, {name: _or_unknown(each, scope) for name, each in step.arguments.items()}
        )
        inside = self.behavior(behavior, values, common["path"], *scope.boxes, step.name)
        return SequenceNode(**common, nodes=inside.nodes, box=step.name)

    def _parallel(self, step: Parallel, scope: _Scope, common: dict[str, Any]) -> Node:
        nodes: list[Node] = []
        for number, part in enumerate(step.steps, start=1):
            nodes += self._all([part], scope, (common["path"], number))
        users: dict[str, Node] = {}
        for node in nodes:
            for server in servers_in(node):
                if server in users:
                    remedy = "put these steps one after the other, or on a timeline"
                    text = (
                        f"its branches {users[server].where} and {node.where} both need {server}, which runs one goal"
                    )
                    self._note(step, scope, f"{text} at a time: {remedy}")
                users.setdefault(server, node)
        kind = RaceNode if isinstance(step, Race) else ParallelNode
        return kind(**common, nodes=tuple(nodes))

    def _rounds(self, step: Repeat, scope: _Scope, common: dict[str, Any]) -> Node:
        count = substitute(step.count, scope.values)
        whole = isinstance(count, int) or (isinstance(count, float) and count.is_integer())
        if isinstance(count, bool) or not whole or not 0 <= count <= MOST_ROUNDS:
            raise BadGoal("repeat", count, f"a whole number 0..{MOST_ROUNDS}")
        path: PathParts = common["path"]

        def one(number: int, binder: _Binder) -> SequenceNode:
            values = {**scope.values, step.variable: number} if step.variable else scope.values
            # Steps of a round stand at 4#2.1: the path of the repetition makes way for the one with the round.
            inside = replace(scope, values=values, prefix=(*path, ("#", number)))
            nodes = binder._all((_moved(part, len(step.path)) for part in step.steps), inside)
            return SequenceNode(inside.prefix, scope.behavior, "", "round", nodes=nodes)

        if not count:
            return RepeatNode(**common, count=0)
        first = one(1, self)
        if step.variable and count > 1:
            one(int(count), self)

        def round_(number: int) -> SequenceNode:
            if number == 1:
                return first
            binder = _Binder(self._library, self._tables, checks=False)
            bound = one(number, binder)
            if binder.problems:
                raise BehaviorError(scope.behavior, binder.problems)
            return bound

        return RepeatNode(**common, count=int(count), round=round_)


def _moved(step: Step, depth: int) -> Step:
    """A step, and those inside, with paths that begin behind the first `depth` parts."""
    changes: dict[str, Any] = {"path": step.path[depth:]}
    if step.parts:
        changes["steps"] = tuple(_moved(part, depth) for part in step.parts)
    return replace(step, **changes)


def _or_unknown(value: Any, scope: _Scope) -> Any:
    try:
        return substitute(value, scope.values)
    except NotKnown:
        return UNKNOWN


def _seconds(key: str, value: Any, values: Mapping[str, Any]) -> float:
    number = substitute(value, values)
    if isinstance(number, bool) or not isinstance(number, (int, float)) or not 0.0 <= number <= LONGEST:
        problem = f"{text_of(number)!r} is not allowed" if number == value else f"{value} is {text_of(number)}"
        raise BadGoal(key, number, f"0 to {LONGEST:g} s", problem)
    return float(number)
