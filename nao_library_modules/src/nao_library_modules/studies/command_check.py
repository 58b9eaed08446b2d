"""Check commands and stored behaviours against a robot without running them.

Server, functions, fields, names, numbers and parameters are checked. `StoredBehaviors` lists and reads behaviours too.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path, PurePath
from typing import Any

from naoqi.errors import NaoError

from ..behaviors.behavior_errors import NoSuchBehavior, Problem
from ..behaviors.behavior_reader import read
from ..behaviors.behavior_store import BehaviorStore
from ..behaviors.checking import preview_facts
from ..behaviors.model import Behavior
from ..behaviors.server_functions import FunctionTables, NotDescribed
from ..core.errors import FunctionFailed, of_those
from ..core.files import config_file
from ..core.server_types import ServerType
from .commands import BEHAVIORS, RUN, Describe, NotThere, RobotCommand, command_problems, goal_of, type_of

SERVICE = "NaoBehavior/list"
FOLDER = "~/.ros/nao_behaviors"
"""Of the user, where no server for behaviours runs."""
ALONE = "the server NaoBehavior does not run: only compared with what every NAO has"


class UncheckedTables(FunctionTables):
    """Finds servers, and lets every goal pass: to draw a behaviour nothing is loaded that only checks need."""

    def fields(self, server: ServerType, function: str) -> list[str]:
        return []

    def check(self, server: ServerType, messages: Sequence[Any]) -> tuple[list[FunctionFailed], list[int]]:
        return [], []


class StoredBehaviors:
    """What there is; where no server for behaviours runs, that of this computer. Any thread may ask.

    Args:
        ask: Calls the service of the robot with fields of its request; raises NotThere if there is none.
        describe: Has a server of the robot describe itself; raises NaoError if it does not.

    `tables`: functions of the servers, for drawing.
    """

    def __init__(self, ask: Callable[..., Any], describe: Callable[[str], Any]) -> None:
        self._ask = ask
        self._describe_server = describe
        self._texts: dict[str, str] = {}
        self.tables = UncheckedTables(self._describe)

    def infos(self) -> list[Any]:
        """A BehaviorInfo of each, by name."""
        self._texts.clear()
        try:
            return list(self._ask().behaviors)
        except NotThere:
            from ..behaviors.behavior_functions import info_message

            store = self._offline()
            return [self._offline_info(name, store, info_message) for name in store.names()]

    def text(self, name: str) -> tuple[str, bool]:
        """The YAML of one, and whether it comes with the library. Raises NoSuchBehavior if there is none."""
        try:
            found = self._ask(name=name).behaviors
        except NotThere:
            store = self._offline()
            return store.text(name), store.is_shipped(name) and not store.of_user(name)
        if not found:
            raise NoSuchBehavior(name, [info.name for info in self.infos()])
        return found[0].text, found[0].shipped

    def load(self, name: str) -> Behavior:
        """A behaviour, for the boxes of others. Raises NaoError if there is none, or its file is wrong."""
        if name not in self._texts:
            self._texts[name] = self.text(name)[0]
        return read(self._texts[name], name)

    def check(self, text: str, file: str, given: Sequence[str] = ()) -> Any:
        """A BehaviorInfo of what a text would do, and of what is wrong with it, as `nao check` tells it."""
        try:
            return self._ask(text=text, file=file, parameters=list(given), validate=True).behaviors[0]
        except NotThere:
            from ..behaviors.behavior_functions import info_message

            store = self._offline()
            name = PurePath(file).stem
            facts = preview_facts(
                name,
                lambda: read(text, name, file),
                store.load,
                FunctionTables(self._describe),
                given,
                self._ask_nobody,
            )
            return info_message(facts, shipped=False)

    def _describe(self, server: str, functions: Sequence[str] | None) -> Any:
        try:
            told = self._describe_server(server)
        except NaoError as error:
            raise NotDescribed(str(error)) from None
        wanted = [each for each in told.functions if not functions or each.name in functions]
        return type(told)(action=told.action, message=told.message, help=told.help, functions=wanted)

    @staticmethod
    def _ask_nobody(_server: str, _goals: Sequence[Any]) -> Any:
        from ..core.describe import NotValidated

        raise NotValidated(ALONE)

    @staticmethod
    def _offline() -> BehaviorStore:
        return BehaviorStore(Path(FOLDER).expanduser(), config_file("behaviors"))

    def _offline_info(self, name: str, store: BehaviorStore, info_message: Callable[..., Any]) -> Any:
        from ..behaviors.checking import facts_of

        shipped = store.is_shipped(name) and not store.of_user(name)
        return info_message(facts_of(name, store.load, FunctionTables(self._describe)), shipped)


def problems_in(info: Any) -> list[Problem]:
    """What a check found."""
    problems = [Problem(each.where, each.text, each.line, each.file) for each in info.problems]
    return problems or ([Problem("", info.problem)] if info.problem else [])


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

    from ..core.describe import offline_servers

    return {each.name: partial(each.service.answer, DescribeFunctionsRequest()) for each in offline_servers()}
