"""The robot's speech recognition as one of several programs uses it: settings change while it runs, and go back."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import RobotError, UnknownMethod

from .audio_in_base import AudioInBase
from .memory_functions import MEMORY

log = logging.getLogger(__name__)

RECOGNITION = "ALSpeechRecognition"
RUNNING = "ALSpeechRecognition/IsRunning"


class RecogniserAccess(AudioInBase):
    """Calls of ALSpeechRecognition. To be mixed into NaoBasic."""

    _languages: list[str] | None = None
    _languages_of = 0  # generation of the connection

    def languages(self) -> Sequence[str]:
        """Languages that the robot recognises, asked once a connection."""
        generation = self.robot.connection.generation
        if self._languages is None or self._languages_of != generation:
            self._languages, self._languages_of = list(self.recogniser("getAvailableLanguages")), generation
        return self._languages

    def keep_settings(self) -> bool:
        """Have the robot keep vocabulary and grammars until `restore_settings`; tells whether it can."""
        try:
            self.idly_now("pushContexts")  # interrupted, nobody would know whether to put something back
        except UnknownMethod:
            log.info("this robot cannot keep the vocabulary that was set before: it is replaced for good")
            return False
        return True

    def restore_settings(self) -> None:
        """Put back what `keep_settings` had kept; preemption does not interrupt this."""
        self.idly_now("popContexts")

    def recogniser(self, method: str, *args: Any) -> Any:
        """Call ALSpeechRecognition; preemption ends the call."""
        return self.call(self.robot.proxy(RECOGNITION), method, *args)

    def idly(self, method: str, *args: Any) -> None:
        """Call a method that the recogniser may refuse while it runs; preemption ends the call."""
        self._idly_with(self.call, method, *args)

    def idly_now(self, method: str, *args: Any) -> None:
        """As `idly`, but preemption does not end the call."""
        self._idly_with(self.call_now, method, *args)

    def _idly_with(self, call: Callable[..., Any], method: str, *args: Any) -> None:
        proxy = self.robot.proxy(RECOGNITION)
        try:
            call(proxy, method, *args)
            return
        except RobotError:
            # A pause that another program wanted must stay, so only one that runs is paused.
            if not self._runs():
                raise
        self.call_now(proxy, "pause", True)
        with self.ended_by(lambda: self.call_now(proxy, "pause", False), "the recognition may stay paused"):
            call(proxy, method, *args)

    def _runs(self) -> bool:
        try:
            return bool(self.call_now(self.robot.proxy(MEMORY), "getData", RUNNING))
        except RobotError:
            return False
