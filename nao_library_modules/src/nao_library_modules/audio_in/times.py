"""When words were said, as far as the robot tells: exactly, or by when it noticed speech."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from naoqi.errors import RobotError

from ..server.extractor_use import Event, ExtractorUse
from ..server.simulated_keys import SimulatedKey
from .heard import Span

SPEECH = "SpeechDetected"
TIMES = "NaoSimulation/WordTimes"
"""A key of simulated robots: [value of WordRecognized, [[onset, end], ...] of its phrases, s of the robot]."""


class WordTimes:
    """Times of the words that one function hears.

    A simulated robot knows them, and is asked for them when it has recognised something. Any other robot raises
    SpeechDetected when speech begins and ends, as soon as it has noticed it: its time less what that takes counts, for
    all words of a value.

    Attributes:
        events: What the function is to subscribe for it.
    """

    def __init__(self, user: ExtractorUse, key: SimulatedKey, onset_delay: float, end_delay: float) -> None:
        """Nothing has been said yet.

        Args:
            user: The module that listens.
            key: `TIMES`.
            onset_delay: s from the begin of speech to its event.
            end_delay: s from the end of speech to its event.
        """
        self._exact = key.known(user.call)
        self.events: Sequence[str] = () if self._exact else (SPEECH,)
        self._user = user
        self._key = key
        self._delays = (onset_delay, end_delay)
        self._speech = Span()

    def note(self, event: Event) -> None:
        """Take an event SpeechDetected."""
        when = self._user.event_time(event)
        onset_delay, end_delay = self._delays
        if event.value:
            self._speech = Span(when - onset_delay)
        elif self._speech.onset:
            self._speech = Span(self._speech.onset, max(self._speech.onset, when - end_delay))

    def of(self, value: Any, count: int) -> list[Span]:
        """When the phrases of a value of WordRecognized were said.

        Args:
            value: The value.
            count: How many phrases are in it.
        """
        if not self._exact:
            return [self._speech] * count
        call, clock = self._user.call, self._user.robot_clock
        try:
            said, times = self._key.value(call)
        except (RobotError, ValueError, TypeError):
            return [Span()] * count
        if said != value or len(times) != count:  # something else has been recognised since
            return [Span()] * count
        return [Span(*(clock.ros_time(call, time) for time in span)) for span in times]
