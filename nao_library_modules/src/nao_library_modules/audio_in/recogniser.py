"""The robot's speech recognition as one of several programs uses it: settings change while it runs, and go back."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import RobotError, UnknownMethod

from ..functions.memory_functions import MEMORY
from ..server.simulated_keys import SimulatedKey
from .base import AudioInBase
from .times import TIMES, WordTimes

log = logging.getLogger(__name__)

RECOGNITION = "ALSpeechRecognition"
RUNNING = "ALSpeechRecognition/IsRunning"
STATUS = "ALSpeechRecognition/Status"
HEARS, DEAF = ("ListenOn", "SpeechDetected", "EndOfProcess"), ("Idle", "ListenOff", "Stop")
"""Values of the status: it hears what is said, or it does not."""


class RecogniserAccess(AudioInBase):
    """Calls of ALSpeechRecognition. To be mixed into NaoBasic.

    Attributes:
        speech_onset_delay: s from the begin of speech to the robot's event.
        speech_end_delay: s from the end of speech to the robot's event.
    """

    speech_onset_delay: float
    speech_end_delay: float
    _languages: list[str] | None = None
    _languages_of = 0  # generation of the connection
    _times_key: SimulatedKey | None = None

    def languages(self) -> Sequence[str]:
        """Languages that the robot recognises, asked once a connection."""
        generation = self.robot.connection.generation
        if self._languages is None or self._languages_of != generation:
            self._languages, self._languages_of = list(self.recogniser("getAvailableLanguages")), generation
        return self._languages

    def word_times(self) -> WordTimes:
        """Times of words, for one function that listens."""
        if self._times_key is None:
            self._times_key = SimulatedKey(self.robot, TIMES)
        return WordTimes(self, self._times_key, self.speech_onset_delay, self.speech_end_delay)

    def hears(self) -> bool:
        """Whether what is said now is heard, when somebody is subscribed; a robot that does not tell hears at once."""
        for key, heard in ((STATUS, HEARS), (RUNNING, (True,))):
            try:
                return self.call(self.robot.proxy(MEMORY), "getData", key) in heard
            except RobotError as error:
                log.debug("%s is not known: %s", key, error)
        return True

    def keep_settings(self) -> bool:
        """Have the robot keep vocabulary and grammars until `restore_settings`; tells whether it can."""
        try:
            # The first recogniser of a busy robot takes its time to start.
            self._idly_with(lambda _, method: self.begin(RECOGNITION, method, (), "popContexts"), "pushContexts")
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
