"""The robot's speech: calls of ALTextToSpeech, and its voices and languages, read when they are needed."""

from __future__ import annotations

from typing import Any

from ..base.field_checks import require_known
from ..functions.parts import Part
from ..server.nao_basic import NaoBasic

SPEECH = "ALTextToSpeech"


class Synthesiser(Part):
    """Calls of ALTextToSpeech.

    Its voices and languages are read once a connection, and again when a name is not among them.

    Used from the thread that executes goals; checks without a goal have their own.
    """

    def __init__(self, module: NaoBasic) -> None:
        self._module = module
        self.prepare_for_checks()

    def prepare_for_checks(self) -> None:
        """Know no voices and no languages yet."""
        self._known: dict[str, list[str]] = {}
        self._generation: int | None = None

    def call(self, method: str, *args: Any) -> Any:
        """Call ALTextToSpeech; preemption ends the call."""
        return self._module.call(self._module.robot.proxy(SPEECH), method, *args)

    def require_voice(self, field: str, voice: str) -> str:
        """A voice that the robot has; BadGoal names those it has."""
        return self._require(field, voice, "getAvailableVoices", "voice of the robot")

    def require_language(self, field: str, language: str) -> str:
        """A language that the robot speaks; BadGoal names those it speaks."""
        return self._require(field, language, "getAvailableLanguages", "language that the robot speaks")

    def _require(self, field: str, name: str, method: str, kind: str) -> str:
        if name.strip() not in self._names(method):
            self._known.pop(method)  # it may have been installed meanwhile
        return require_known(field, name, self._names(method), kind)

    def _names(self, method: str) -> list[str]:
        generation = self._module.robot.connection.generation
        if generation != self._generation:  # the robot behind a new connection may be another one
            self._known.clear()
            self._generation = generation
        if method not in self._known:
            self._known[method] = [str(name) for name in self.call(method)]
        return self._known[method]
