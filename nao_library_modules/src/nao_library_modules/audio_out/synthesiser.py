"""The robot's speech: calls of ALTextToSpeech, and its voices and languages, read when they are needed."""

from __future__ import annotations

from typing import Any

from ..base.field_checks import require_known
from ..base.once_per_connection import OncePerConnection
from ..functions.parts import Part
from ..server.nao_basic import NaoBasic
from .sounds import SPEECH


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
        self._known: OncePerConnection[dict[str, list[str]]] = OncePerConnection(self._module.robot, dict)

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
            self._known().pop(method, None)  # it may have been installed meanwhile
        return require_known(field, name, self._names(method), kind)

    def _names(self, method: str) -> list[str]:
        known = self._known()
        if method not in known:
            known[method] = [str(name) for name in self.call(method)]
        return known[method]
