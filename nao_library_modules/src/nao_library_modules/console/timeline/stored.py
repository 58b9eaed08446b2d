"""The stored behaviours of a robot: listed, read and checked without a goal, so what runs goes on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path, PurePath
from typing import Any

from naoqi.errors import NaoError

from ...base.errors import FunctionFailed
from ...base.paths import config_file
from ...behaviors.language.checking import preview_facts
from ...behaviors.language.errors import NoSuchBehavior, Problem
from ...behaviors.language.model import Behavior
from ...behaviors.language.reader import read
from ...behaviors.language.servers import FunctionTables, NotDescribed
from ...behaviors.language.store import BehaviorStore
from ...functions.server_types import ServerType
from ..robots.errors import NotThere

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
            from ...behaviors.run.running import info_message

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
            from ...behaviors.run.running import info_message

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
        from ...functions.check_service import NotValidated

        raise NotValidated(ALONE)

    @staticmethod
    def _offline() -> BehaviorStore:
        return BehaviorStore(Path(FOLDER).expanduser(), config_file("behaviors"))

    def _offline_info(self, name: str, store: BehaviorStore, info_message: Callable[..., Any]) -> Any:
        from ...behaviors.language.checking import facts_of

        shipped = store.is_shipped(name) and not store.of_user(name)
        return info_message(facts_of(name, store.load, FunctionTables(self._describe)), shipped)


def problems_in(info: Any) -> list[Problem]:
    """What a check found."""
    problems = [Problem(each.where, each.text, each.line, each.file) for each in info.problems]
    return problems or ([Problem("", info.problem)] if info.problem else [])
