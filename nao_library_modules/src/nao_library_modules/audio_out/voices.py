"""What the robot's speech knows: its voices and languages, read when they are needed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..base.field_checks import require_known

SPEECH = "ALTextToSpeech"


class Voices:
    """Voices and languages of the robot, read once a connection, and again when a name is not among them.

    Used from the thread that executes goals.
    """

    def __init__(self, robot: Any, call: Callable[..., Any]) -> None:
        """Keep the way to ask.

        Args:
            robot: Proxies and connection.
            call: Calls a method; preemption interrupts it.
        """
        self._robot = robot
        self._call = call
        self._known: dict[str, list[str]] = {}
        self._generation: int | None = None

    def require_voice(self, field: str, voice: str) -> str:
        """A voice that the robot has.

        Raises:
            BadGoal: If it has no such voice; the text names those it has.
            NaoError: If the robot cannot be asked.
        """
        return self._require(field, voice, "getAvailableVoices", "voice of the robot")

    def require_language(self, field: str, language: str) -> str:
        """A language that the robot speaks.

        Raises:
            BadGoal: If it does not; the text names those it speaks.
            NaoError: If the robot cannot be asked.
        """
        return self._require(field, language, "getAvailableLanguages", "language that the robot speaks")

    def _require(self, field: str, name: str, method: str, kind: str) -> str:
        if name.strip() not in self._names(method):
            self._known.pop(method)  # it may have been installed meanwhile
        return require_known(field, name, self._names(method), kind)

    def _names(self, method: str) -> list[str]:
        generation = self._robot.connection.generation
        if generation != self._generation:  # the robot behind a new connection may be another one
            self._known.clear()
            self._generation = generation
        if method not in self._known:
            self._known[method] = [str(name) for name in self._call(self._robot.proxy(SPEECH), method)]
        return self._known[method]
