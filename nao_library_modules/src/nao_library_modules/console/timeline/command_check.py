"""Whether a robot can do what a command asks of it: server, functions, fields, names, numbers, stored behaviours."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

from naoqi.errors import NaoError

from ...base.suggestion import of_those
from ...behaviors.language.servers import FunctionTables
from ...functions.server_types import ServerType
from ..robots.commands import BEHAVIORS, RUN, Describe, RobotCommand, command_problems, goal_of, type_of
from ..robots.errors import NotThere
from .stored import StoredBehaviors, problems_in

_LATER = re.compile(r"\{[A-Za-z_]\w*\}")
"""A name in a text whose value is not known before the command is sent."""


class CommandCheck:
    """Checks commands against the servers and behaviours that there are.

    Args:
        describe: Has a server that runs describe itself. Those of this package that do not run are looked at in the
            code.
        running: Relative names of the servers that run.
        ask: Calls `NaoBehavior/list` with fields of its request; raises NotThere if it does not run.
    """

    def __init__(self, describe: Describe, running: Callable[[], Iterable[str]], ask: Callable[..., Any]) -> None:
        self._live, self._running = describe, running
        self._stored = StoredBehaviors(ask, self._describe)
        self._tables = FunctionTables()
        self._told: dict[str, list[str]] = {}

    def problems(self, command: RobotCommand) -> list[str]:
        """What is wrong with a command, for people."""
        key = repr((command.server, command.chain, command.unusual))
        if key not in self._told:
            self._told[key] = command_problems(command, self._describe) or self._values(command)
        return self._told[key]

    def _values(self, command: RobotCommand) -> list[str]:
        """What is wrong with the values of a command whose fields are right."""
        if command.stops:
            return []
        if command.server == BEHAVIORS:
            return [text for name, fields in command.chain if name == RUN for text in self._behavior(fields)]
        return value_problems(command, type_of(command.server, self._describe), self._tables)

    def _behavior(self, fields: Mapping[str, Any]) -> list[str]:
        name, given = str(fields.get("str_param", "")), list(fields.get("parameters", []))
        if _LATER.search(name):
            return []
        try:
            text, _ = self._stored.text(name)
        except NaoError as error:
            return [str(error)]
        try:
            parameters = self._stored.load(name).parameters
        except NaoError:
            parameters = {}  # its file is wrong, which the check tells
        # A value that only the trial has cannot be looked at; that there is its parameter can.
        given = [each for each in given if not (_LATER.search(each) and each.partition("=")[0] in parameters)]
        told = problems_in(self._stored.check(text, f"{name}.yaml", given))
        return [f"behavior {name}: {replace(each, file='', line=0)}" for each in told]

    def _describe(self, server: str) -> Any:
        running = list(self._running())
        if server in running:
            return self._live(server)
        declared = _declared()
        if server in declared:
            return declared[server]()
        names = list(dict.fromkeys([*declared, *running]))
        raise NotThere(
            f"there is no server {server!r} in this package, and none of that name runs{of_those(server, names)}"
        )


def value_problems(command: RobotCommand, types: ServerType, tables: FunctionTables) -> list[str]:
    """What is wrong with the values of a command, as far as it is known without its server, and what is not usual.

    `types`: of its server. `tables`: functions of the servers.
    """
    if not types.ours or _LATER.search(repr(command.chain)):
        return []
    goal = goal_of(command, types).goal
    single = len(command.chain) == 1
    found = [each.text if single else str(each) for each in tables.check_goals(types.name, [goal]).problems]
    unusual = [] if command.unusual else tables.unusual(types, goal.functions)
    return [*found, *(str(each.cause if single else each) for each in unusual)]


@lru_cache(maxsize=None)
def _declared() -> Mapping[str, Callable[[], Any]]:
    """Servers of this package -> what they say of themselves, as the code has it."""
    from nao_library_msgs.srv import DescribeFunctionsRequest

    from ...functions.describe_offline import offline_servers

    return {each.name: partial(each.service.answer, DescribeFunctionsRequest()) for each in offline_servers()}
