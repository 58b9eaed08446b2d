"""The robot's speech recognition as one of several programs uses it: settings change while it runs, and go back."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import RobotError, UnknownMethod

from ..base.once_per_connection import OncePerConnection
from ..functions.memory_functions import MEMORY
from ..functions.parts import Part
from ..robot.event_times import Event
from ..server.nao_basic import NaoBasic
from ..server.simulated_keys import SimulatedKey
from .hearing import Hearing, Span

log = logging.getLogger(__name__)

RECOGNITION = "ALSpeechRecognition"
RUNNING = "ALSpeechRecognition/IsRunning"
STATUS = "ALSpeechRecognition/Status"
HEARS, DEAF = ("ListenOn", "SpeechDetected", "EndOfProcess"), ("Idle", "ListenOff", "Stop")
"""Values of the status: it hears what is said, or it does not."""
SPEECH = "SpeechDetected"
TIMES = "NaoSimulation/WordTimes"
"""A key of simulated robots: [value of WordRecognized, [[onset, end], ...] of its phrases, s of the robot]."""


class Recogniser(Part):
    def __init__(self, module: NaoBasic, hearing: Hearing, onset_delay: float, end_delay: float) -> None:
        """Delays: s from the begin and the end of speech to the robot's events."""
        self._module = module
        self._hearing = hearing
        self._delays = (onset_delay, end_delay)
        self._times_key = SimulatedKey(module.robot, TIMES)
        self.languages = OncePerConnection(module.robot, lambda: list(self.call("getAvailableLanguages")))
        """Languages that the robot recognises."""

    def word_times(self) -> WordTimes:
        """Times of words, for one function that listens."""
        return WordTimes(self._hearing, self._times_key, *self._delays)

    def hears(self) -> bool:
        """Whether what is said now is heard, when somebody is subscribed; a robot that hides it hears at once."""
        for key, heard in ((STATUS, HEARS), (RUNNING, (True,))):
            try:
                return self._module.call(self._module.robot.proxy(MEMORY), "getData", key) in heard
            except RobotError as error:
                log.debug("%s is not known: %s", key, error)
        return True

    def keep_settings(self) -> bool:
        """Have the robot keep vocabulary and grammars until popContexts; returns whether it can."""
        try:
            # The first recogniser of a busy robot takes its time to start.
            self._idly_with(
                lambda _, method: self._hearing.begin(RECOGNITION, method, (), "popContexts"), "pushContexts"
            )
        except UnknownMethod:
            log.info("this robot cannot keep the vocabulary that was set before: it is replaced for good")
            return False
        return True

    def call(self, method: str, *args: Any) -> Any:
        """Call ALSpeechRecognition; preemption ends the call."""
        return self._module.call(self._module.robot.proxy(RECOGNITION), method, *args)

    def call_now(self, method: str, *args: Any) -> Any:
        """Call a quick method of ALSpeechRecognition that preemption must not end."""
        return self._module.call_now(self._module.robot.proxy(RECOGNITION), method, *args)

    def idly(self, method: str, *args: Any) -> None:
        """Call a method that the recogniser may refuse while it runs; preemption ends the call."""
        self._idly_with(self._module.call, method, *args)

    def idly_now(self, method: str, *args: Any) -> None:
        """As `idly`, but preemption does not end the call."""
        self._idly_with(self._module.call_now, method, *args)

    def _idly_with(self, call: Callable[..., Any], method: str, *args: Any) -> None:
        proxy = self._module.robot.proxy(RECOGNITION)
        try:
            call(proxy, method, *args)
            return
        except RobotError:
            # A pause that another program wanted must stay, so only one that runs is paused.
            if not self._runs():
                raise
        self.call_now("pause", True)
        with self._hearing.ended_by(lambda: self.call_now("pause", False), "the recognition may stay paused"):
            call(proxy, method, *args)

    def _runs(self) -> bool:
        try:
            return bool(self._module.call_now(self._module.robot.proxy(MEMORY), "getData", RUNNING))
        except RobotError:
            return False


class WordTimes:
    """Times of the words that one function hears.

    A simulated robot knows them, and is asked for them when it has recognised something. Any other robot raises
    SpeechDetected when speech begins and ends, as soon as it has noticed it: its time less what that takes counts, for
    all words of a value. `events`: what the function is to subscribe for it.
    """

    def __init__(self, hearing: Hearing, key: SimulatedKey, onset_delay: float, end_delay: float) -> None:
        self._exact = key.known(hearing.call)
        self.events: Sequence[str] = () if self._exact else (SPEECH,)
        self._hearing = hearing
        self._key = key
        self._delays = (onset_delay, end_delay)
        self._speech = Span()

    def note(self, event: Event) -> None:
        """Take an event SpeechDetected."""
        when = self._hearing.event_time(event)
        onset_delay, end_delay = self._delays
        if event.value:
            self._speech = Span(when - onset_delay)
        elif self._speech.onset:
            self._speech = Span(self._speech.onset, max(self._speech.onset, when - end_delay))

    def of(self, value: Any, count: int) -> list[Span]:
        """When the phrases of a value of WordRecognized, `count` of them, were said."""
        if not self._exact:
            return [self._speech] * count
        call, clock = self._hearing.call, self._hearing.robot_clock
        try:
            said, times = self._key.value(call)
        except (RobotError, ValueError, TypeError):
            return [Span()] * count
        if said != value or len(times) != count:  # something else has been recognised since
            return [Span()] * count
        return [Span(*(clock.ros_time(call, time) for time in span)) for span in times]
