"""Whether a behaviour can be run, told before anything moves; and what there is to know about it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from naoqi.errors import NaoError

from .binder import Library, bind, bind_what_can_be
from .errors import BehaviorError, Problem
from .model import Behavior
from .parameters import given_as_text
from .preview import Preview, preview_of
from .program import SequenceNode, servers_in
from .servers import FunctionTables
from .validation import Ask, Validation, ask_nobody, validate


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
