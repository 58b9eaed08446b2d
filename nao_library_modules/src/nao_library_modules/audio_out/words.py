"""Speech as the robot speaks it: its words, published as they are spoken, and when a text was to be heard."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import WORD_TIMES_LIMIT, wait_while_answering

from ..functions.memory_functions import MEMORY
from ..robot.event_relay import EventRelay
from ..server.nao_basic import NaoBasic
from ..server.simulated_keys import SimulatedKey, checked_span

log = logging.getLogger(__name__)

WORD, SENTENCE = "ALTextToSpeech/CurrentWord", "ALTextToSpeech/CurrentSentence"
STARTED = "ALTextToSpeech/TextStarted"
ENDS = ("ALTextToSpeech/TextDone", "ALTextToSpeech/TextInterrupted")
TIMES = "NaoSimulation/SpeechTimes"
"""A key of simulated robots: [onset, end] of the text that was spoken last, s of the robot."""


class SpokenWords:
    """Publishes words while something is said, and knows when a text was to be heard.

    A simulated robot knows when the first and the last sound of a text were. Of any other, the times of the events
    TextStarted and TextDone or TextInterrupted count.

    Events come from threads of libqi, the rest from the thread that executes goals. The lock is held while a word is
    published, so that none is published after `stop`.
    """

    def __init__(self, module: NaoBasic) -> None:
        """Begin without subscriptions; words are published as feedback of the module."""
        self._module = module
        self._exact = SimulatedKey(module.robot, TIMES)
        self._events = EventRelay(lambda: module.robot.proxy(MEMORY), self._take)
        self._lock = threading.Lock()
        self._answered = threading.Condition(self._lock)
        self._texts: set[object] = set()  # under way
        self._sentence = ""
        self._asked = 0  # events whose times the robot has not answered yet
        self._started = self._ended = 0.0  # the last text, ROS time, s

    def begin(self) -> object:
        """Something is said from now on; returns what `end` takes."""
        try:
            events = (SENTENCE, WORD) if self._exact.known(self._module.call) else (SENTENCE, WORD, STARTED, *ENDS)
            self._module.robot_clock.compare(self._module.call)
        except NaoError as error:
            log.debug("times of speech are not known: %s", error)
            events = (SENTENCE, WORD)
        for event in events:
            try:
                self._events.subscribe(event)
            except NaoError as error:
                log.debug("%s is not watched: %s", event, error)  # it is said all the same
        text = object()
        with self._lock:
            self._texts.add(text)
        return text

    def end(self, text: object) -> None:
        """It is said; when nothing else is, no more words are published."""
        with self._lock:
            self._texts.discard(text)

    @contextmanager
    def published(self) -> Iterator[None]:
        """Publish words while the block runs."""
        text, begun = self.begin(), self._module.clock.now()
        try:
            yield
            self._await_times(begun)
        finally:
            self.end(text)

    def span(self, began: float) -> tuple[float, float]:
        """ROS times, s, of the first and the last sound of a text that was said just now; 0 where they are not known.

        `began`: ROS time at which it was asked for, s. Raises NaoError if the robot cannot be asked.
        """
        if self._exact.known(self._module.call):
            return self._exact.span(self._module.call, self._module.robot_clock, began)
        with self._lock:
            return checked_span([self._started, self._ended], began)

    def stop(self) -> None:
        """Publish no more of what has begun."""
        with self._lock:
            self._texts.clear()

    def renew(self) -> None:
        """Subscribe again: the robot behind a new connection knows nothing of it."""
        self._events.renew()

    def close(self) -> None:
        self.stop()
        self._events.close()

    # In threads of libqi

    def _take(self, event: str, value: Any) -> None:
        if event == SENTENCE:
            with self._lock:
                self._sentence = str(value or "").strip()
            return
        text = str(value or "").strip()
        with self._lock:
            sentence, wanted = self._sentence, bool(self._texts)
        if not wanted or not value or (event == WORD and not text):
            return
        arrived = self._module.clock.now()
        call = self._module.robot.proxy(MEMORY).call_async("getTimestamp", event)
        with self._lock:
            self._asked += 1
        call.add_done_callback(lambda answer: self._dated(answer, event, value, sentence, arrived))

    def _dated(self, answer: Any, event: str, value: Any, sentence: str, arrived: float) -> None:
        """Take an event whose time the robot has answered, or could not answer."""
        when = arrived
        try:
            last, seconds, microseconds = answer.result(timeout=0)
            if last == value:
                when = self._module.robot_clock.mapped(seconds + 1e-6 * microseconds, arrived)
        except (NaoError, ValueError, TypeError) as error:
            log.debug("the time of %s is not known: %s", event, error)
        with self._lock:
            self._asked -= 1
            self._answered.notify_all()
            if event == STARTED:
                self._started = when
            elif event in ENDS:
                self._ended = when
            elif self._texts:
                self._module.publish_feedback(stamp=when, word=str(value).strip(), sentence=sentence)

    # In the thread that executes goals

    def _await_times(self, begun: float) -> None:
        unknown = not set(ENDS).intersection(self._events.names)  # no event comes at the end
        with self._lock:
            known = lambda: not self._asked and (unknown or self._ended > begun)  # noqa: E731
            wait_while_answering(
                lambda left: self._answered.wait_for(known, left),
                self._module.robot.connection.answering_time,
                WORD_TIMES_LIMIT,
            )
