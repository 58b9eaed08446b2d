"""Whether a behaviour can be run, told before anything moves; what it would do; what its servers say of its goals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from naoqi.errors import NaoError

from ..core.describe import NotValidated
from ..core.goal_checks import GoalCheck, GoalProblem
from .behavior_errors import BehaviorError, Problem
from .binder import Library, bind, bind_what_can_be
from .model import (
    BarrierNode,
    Behavior,
    GoalNode,
    Node,
    OnTimeline,
    ParallelNode,
    Pause,
    RaceNode,
    RepeatNode,
    SequenceNode,
    name_of,
    servers_in,
    walk,
)
from .parameters import given_as_text
from .server_functions import FunctionTables, fields_of
from .strict_yaml import dump_line

MOST_STEPS = 200
"""Steps that are told one by one."""
LONGEST = 200
"""Characters that tell of a step."""


@dataclass(frozen=True)
class Preview:
    """What there is to know of a program.

    Attributes:
        steps: Path of each step, what it is, and its fields; of repetitions the first round.
        boxes: Behaviours that it runs, also by way of its boxes.
        waits: s that its waits take if nothing fails, repetitions as their first round; goals take what they take.
        unchecked: Functions with fields that only their server knows together with its robot.
    """

    steps: tuple[str, ...] = ()
    boxes: tuple[str, ...] = ()
    waits: float = 0.0
    unchecked: tuple[str, ...] = ()


def preview_of(program: SequenceNode, tables: FunctionTables) -> Preview:
    nodes = [node for part in program.parts for node in walk(part)]
    boxes = dict.fromkeys(node.box for node in nodes if isinstance(node, SequenceNode) and node.box)
    return Preview(
        _few([_told(node) for node in nodes]),
        tuple(boxes),
        waits_of(program),
        _few([text for node in nodes if isinstance(node, GoalNode) for text in _unchecked(node, tables)]),
    )


def waits_of(node: Node) -> float:
    """S that the waits of a node take."""
    own = _waits_inside(node)
    return own if node.limit is None else min(own, node.limit)


def _waits_inside(node: Node) -> float:
    if isinstance(node, Pause):
        return node.duration
    if isinstance(node, GoalNode):
        return sum(message.time.to_sec() for message in _messages(node))
    if isinstance(node, RepeatNode):
        return node.count * sum(map(waits_of, node.parts))
    if isinstance(node, RaceNode):
        return min(map(waits_of, node.parts), default=0.0)
    if isinstance(node, ParallelNode):
        return max(map(waits_of, node.parts), default=0.0)
    if isinstance(node, OnTimeline):
        return max(times_of(node)[1].values(), default=0.0)
    return sum(map(waits_of, node.parts))


def in_order_of_time(node: Node) -> Sequence[Node]:
    """Parts of a node as they begin if goals take no time; of a timeline that may be another order than its own."""
    if not isinstance(node, OnTimeline):
        return node.parts
    begins, _ = times_of(node)
    return [node.nodes[i] for i in sorted(begins, key=lambda i: (begins[i], i))]


def times_of(
    timeline: OnTimeline, length: Callable[[Node], float] = waits_of
) -> tuple[dict[int, float], dict[int, float]]:
    """When the entries of a timeline begin and end, s from its beginning. None waits for itself: that was checked.

    Of one from which others are missing, as something is wrong with them, as much as can be told. `length`: s that an
    entry takes.
    """
    entries = timeline.nodes
    named = {name_of(entry): i for i, entry in enumerate(entries) if name_of(entry)}
    begins: dict[int, float] = {}
    ends: dict[int, float] = {}
    while len(ends) < len(entries):  # once is enough where nobody refers to what stands below
        for i, entry in enumerate(entries):
            other = named.get(entry.at.label) if entry.at.label else None
            if i in ends or not (other is None or other in ends):
                continue
            if isinstance(entry, BarrierNode):
                if any(above not in ends for above in range(i)):
                    continue
                begins[i] = max((ends[above] for above in range(i)), default=0.0)
            else:
                since = 0.0 if other is None else (ends if entry.at.of_end else begins)[other]
                begins[i] = since + entry.at.offset
            ends[i] = begins[i] + length(entry)
    return begins, ends


def _told(node: Node) -> str:
    text = f"{node.where} {node.what}"
    if isinstance(node, Pause):
        text += f" {node.duration:g} s"
    elif isinstance(node, RepeatNode):
        text += f" {node.count} times"
    elif isinstance(node, GoalNode):
        told = [_fields(message) for message in _messages(node)]
        text += f": {'; '.join(told)}" if any(told) else ""
    return _cut(text)


def _unchecked(node: GoalNode, tables: FunctionTables) -> Iterator[str]:
    messages = _messages(node)
    for position in tables.check(tables.server(node.server), messages)[1]:
        message = messages[position - 1]
        yield _cut(f"{node.where} {node.server}.{message.function}: {_fields(message)}")


def _messages(node: GoalNode) -> list[Any]:
    return list(getattr(node.goal, node.goal.__slots__[0]))


def _fields(message: Any) -> str:
    """Fields of a message that say what its function does, in one line."""
    fields = {name: value for name, value in fields_of(message).items() if name not in ("function", "on_error", "time")}
    return ", ".join(f"{name} {dump_line(value)}" for name, value in fields.items())


def _few(texts: list[str]) -> tuple[str, ...]:
    more = len(texts) - MOST_STEPS
    return (*texts[:MOST_STEPS], *([f"... and {more} more"] if more > 0 else []))


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


# --- what the servers say ---------------------------------------------------------------------------------------------

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


# --- checks -----------------------------------------------------------------------------------------------------------


def check(
    behavior: Behavior,
    library: Library,
    values: Mapping[str, Any] | None = None,
    tables: FunctionTables | None = None,
) -> SequenceNode:
    """Check a behaviour as a whole, without servers: functions, fields, boxes, times, and names that all robots have.

    Returns what would run. Raises BehaviorError with everything that is wrong; BadGoal: a value for a parameter will
    not do.

    Args:
        library: Gives the behaviours of its boxes by name.
        values: Of its parameters; the defaults for those that are not named.
        tables: Functions of the servers, if they are known already.
    """
    tables = tables or FunctionTables()
    program, problems = bind_what_can_be(behavior, values or {}, library, tables)
    _require_none(behavior, [*problems, *validate(program, ask_nobody, tables).problems])
    return program


def check_given(
    behavior: Behavior,
    library: Library,
    given: Sequence[str],
    tables: FunctionTables,
    ask: Ask | None = None,
    read_wrong: Sequence[Problem] = (),
) -> tuple[SequenceNode, Validation]:
    """What would run with values as "name=value", if nothing is wrong.

    Raises BehaviorError with everything that is wrong.

    Args:
        behavior: The behaviour.
        library: Gives the behaviours of its boxes by name.
        given: Values of its parameters.
        ask: Has the servers check their goals; None: only what is true of any robot is looked at.
    """
    problems = [*read_wrong]
    values = given_as_text(behavior.parameters, given, problems, behavior.file)
    program, more = bind_what_can_be(behavior, values, library, tables)
    validation = Validation() if ask is None else validate(program, ask, tables)
    _require_none(behavior, [*problems, *more, *validation.problems])
    return program, validation


def _require_none(behavior: Behavior, problems: Sequence[Problem]) -> None:
    if problems:
        once = dict.fromkeys(problems)  # what is true of any robot the servers tell, too
        own = sorted(once, key=lambda problem: (problem.file != behavior.file, problem.file, problem.line))
        raise BehaviorError(behavior.name, own)


def problems_of(
    load: Callable[[], Behavior],
    library: Library,
    tables: FunctionTables | None = None,
    given: Sequence[str] = (),
    ask: Ask = ask_nobody,
) -> list[str]:
    """What is wrong with a behaviour; nothing if it can be run.

    Args:
        library: For its boxes.
        tables: Functions of the servers, if they are known already.
        given: Values of its parameters as "name=value".
        ask: Has the servers check their goals, where there are any.
    """
    try:
        behavior, wrong = _as_far_as_read(load)
        check_given(behavior, library, given, tables or FunctionTables(), ask, wrong)
    except NaoError as error:
        return [str(problem) for problem in _problems(error)]
    return []


def _as_far_as_read(load: Callable[[], Behavior]) -> tuple[Behavior, Sequence[Problem]]:
    """A behaviour, and what was wrong with its file."""
    try:
        return load(), ()
    except BehaviorError as error:
        if error.readable is None:
            raise
        return error.readable, error.problems


def _problems(error: NaoError) -> tuple[Problem, ...]:
    return error.problems if isinstance(error, BehaviorError) else (Problem("", str(error)),)


@dataclass(frozen=True)
class Facts:
    """What there is to know about a stored behaviour."""

    name: str
    behavior: Behavior | None  # it; None if its file cannot be read
    servers: tuple[str, ...]
    problem: str  # what is wrong with it, in one text that may be cut; empty if it can be run
    problems: tuple[Problem, ...] = ()  # all that is wrong with it, one by one; none if it can be run
    preview: Preview = Preview()  # what it would do; empty where nobody asked for that
    unvalidated: tuple[str, ...] = ()  # servers that did not check their goals, and why


def facts_of(name: str, library: Library, tables: FunctionTables) -> Facts:
    """Look at a stored behaviour."""
    behavior = None
    try:
        behavior = library(name)
        return Facts(name, behavior, tuple(servers_in(bind(behavior, {}, library, tables))), "")
    except NaoError as error:
        return Facts(name, behavior, (), str(error), _problems(error))


def preview_facts(
    name: str,
    load: Callable[[], Behavior],
    library: Library,
    tables: FunctionTables,
    given: Sequence[str] = (),
    ask: Ask | None = None,
) -> Facts:
    """As `facts_of`, with what it would do. `ask`: has the servers check their goals, as `check_given` takes it."""
    behavior = None
    try:
        readable, wrong = _as_far_as_read(load)
        behavior = None if wrong else readable
        program, validation = check_given(readable, library, given, tables, ask, wrong)
    except NaoError as error:
        return Facts(name, behavior, (), str(error), _problems(error))
    preview = preview_of(program, tables)
    if ask is not None:
        preview = replace(preview, unchecked=tuple(validation.unchecked))
    return Facts(
        name, behavior, tuple(servers_in(program)), "", preview=preview, unvalidated=tuple(validation.unvalidated)
    )
