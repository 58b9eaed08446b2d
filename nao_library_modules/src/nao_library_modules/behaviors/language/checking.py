"""Whether a behaviour can be run, told without robot and servers; and what there is to know about it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from .binder import Library, bind
from .errors import BehaviorError
from .model import Behavior
from .outlook import Outlook, outlook_of
from .parameters import given_as_text
from .program import InOrder, servers_in
from .servers import FunctionTables


def check(
    behavior: Behavior,
    library: Library,
    values: Mapping[str, Any] | None = None,
    tables: FunctionTables | None = None,
) -> InOrder:
    """Check a behaviour as a whole: servers, functions, fields, boxes, times, and what else is known without a robot.

    Args:
        behavior: The behaviour.
        library: Gives the behaviours of its boxes by name.
        values: Of its parameters; the defaults for those that are not named.
        tables: Functions of the servers, if they are known already.

    Returns:
        What would run.

    Raises:
        BehaviorError: With everything that is wrong.
        BadGoal: A value for a parameter will not do.
    """
    return bind(behavior, values or {}, library, tables or FunctionTables())


def check_given(behavior: Behavior, library: Library, given: Sequence[str], tables: FunctionTables) -> InOrder:
    """As `check`, with values as "name=value"."""
    return check(behavior, library, given_as_text(behavior.parameters, given), tables)


def problems_of(
    load: Callable[[], Behavior], library: Library, tables: FunctionTables | None = None, given: Sequence[str] = ()
) -> list[str]:
    """What is wrong with a behaviour; nothing if it can be run.

    Args:
        load: Gives the behaviour.
        library: For its boxes.
        tables: Functions of the servers, if they are known already.
        given: Values of its parameters as "name=value".
    """
    try:
        check_given(load(), library, given, tables or FunctionTables())
    except NaoError as error:
        return list(_problems(error))
    return []


def _problems(error: NaoError) -> tuple[str, ...]:
    return tuple(map(str, error.problems)) if isinstance(error, BehaviorError) else (str(error),)


@dataclass(frozen=True)
class Facts:
    """What there is to know about a stored behaviour.

    Attributes:
        name: Its name.
        behavior: It; None if its file cannot be read.
        servers: Names of the actions that it uses.
        problem: What is wrong with it, in one text that may be cut; empty if it can be run.
        problems: All that is wrong with it, one by one; none if it can be run.
        outlook: What it would do; empty where nobody asked for that.
    """

    name: str
    behavior: Behavior | None
    servers: tuple[str, ...]
    problem: str
    problems: tuple[str, ...] = ()
    outlook: Outlook = Outlook()


def facts_of(name: str, library: Library, tables: FunctionTables) -> Facts:
    """Look at a stored behaviour.

    Args:
        name: Its name.
        library: Where it, and its boxes, are.
        tables: Functions of the servers.
    """
    behavior = None
    try:
        behavior = library(name)
        return Facts(name, behavior, tuple(servers_in(check(behavior, library, None, tables))), "")
    except NaoError as error:
        return Facts(name, behavior, (), str(error), _problems(error))


def outlook_facts(
    name: str, load: Callable[[], Behavior], library: Library, tables: FunctionTables, given: Sequence[str] = ()
) -> Facts:
    """As `facts_of`, with what it would do.

    Args:
        name: What it is called.
        load: Gives the behaviour.
        library: For its boxes.
        tables: Functions of the servers.
        given: Values of its parameters as "name=value".
    """
    behavior = None
    try:
        behavior = load()
        program = check_given(behavior, library, given, tables)
        return Facts(name, behavior, tuple(servers_in(program)), "", outlook=outlook_of(program, tables))
    except NaoError as error:
        return Facts(name, behavior, (), str(error), _problems(error))
