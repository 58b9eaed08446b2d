"""Whether the robot can do what a protocol asks of it: servers, functions, fields, names, stored behaviours."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

from naoqi.errors import NaoError

from ...base.suggestion import of_those
from ...behaviors.language.errors import Problem
from ...behaviors.language.expressions import text_of
from ...behaviors.language.servers import FunctionTables
from ...functions.server_types import ServerType
from ..robots.commands import BEHAVIORS, Describe, RobotCommand, command_problems, goal_of, type_of
from ..robots.errors import NotThere
from ..timeline.stored import SERVICE, StoredBehaviors, problems_in
from .course import all_steps
from .order import conditions_of
from .protocol import CommandStep, StudyProtocol

RUN = "runBehavior"
_LATER = re.compile(r"\{[A-Za-z_]\w*\}")
"""A name in a text whose value only the trial has, as an answer."""


class ProtocolCheck:
    """Checks protocols against the servers and behaviours that there are.

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

    def problems(self, protocol: StudyProtocol) -> list[Problem]:
        """What the robot would refuse, in the order of the file; each step in all conditions."""
        found: dict[Problem, None] = {}
        for path, step in all_steps(protocol):
            if isinstance(step, CommandStep):
                for values in _all_values(protocol):
                    for text in self._command(step.command.filled(values)):
                        found[Problem(f"step {path}", text, step.line)] = None
        return list(found)

    def _command(self, command: RobotCommand) -> list[str]:
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
        types = type_of(command.server, self._describe)
        if not types.ours or _LATER.search(repr(command.chain)):
            return []
        return self._goal(command, types)

    def _goal(self, command: RobotCommand, types: ServerType) -> list[str]:
        goal = goal_of(command, types).goal
        single = len(command.chain) == 1
        found = [each.text if single else str(each) for each in self._tables.check_goals(types.name, [goal]).problems]
        unusual = [] if command.unusual else self._tables.unusual(types, goal.functions)
        return [*found, *(str(each.cause if single else each) for each in unusual)]

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


def checked_for(robot: Any, protocol: StudyProtocol) -> list[Problem]:
    """What a robot would refuse; calls services, so not for the event loop. `robot`: a `RobotClient`."""
    from nao_library_msgs.srv import ListBehaviors

    ask = partial(robot.call, SERVICE, ListBehaviors)
    return ProtocolCheck(robot.describe, robot.servers, ask).problems(protocol)


def _all_values(protocol: StudyProtocol) -> Iterator[Mapping[str, str]]:
    """Values of texts in each condition that there is."""
    for between in conditions_of(protocol, within=False):
        for within in conditions_of(protocol, within=True):
            values = protocol.values_in({**between, **within})
            yield {name: text_of(value) for name, value in values.items()}


@lru_cache(maxsize=None)
def _declared() -> Mapping[str, Callable[[], Any]]:
    """Servers of this package -> what they say of themselves, as the code has it."""
    from nao_library_msgs.srv import DescribeFunctionsRequest

    from ...functions.describe_offline import offline_servers

    return {each.name: partial(each.service.answer, DescribeFunctionsRequest()) for each in offline_servers()}
