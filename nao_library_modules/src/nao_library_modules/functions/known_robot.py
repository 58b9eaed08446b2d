"""A robot that is only a table: what all robots of the family answer about themselves, for checks where none is."""

from __future__ import annotations

import json
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

from naoqi.errors import NaoError, RobotError

from ..base.paths import config_file
from .goal_checks import NotKnownHere

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
