"""Recognition of words. No ROS."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ...core.health import Report
from ...core.robot import ask
from ...core.robot_events import EventRelay
from ..base.lazy_subscription import LazySubscription
from .robot_speech import SpeechSettings

RECOGNITION = "ALSpeechRecognition"
HEARD = "WordRecognized"
CLOSE_LIMIT = 1.0
SPOTTED = re.compile(r"<\.\.\.>")
"""What stands for the words before and after one that was spotted."""


@dataclass(frozen=True)
class RecognizedWords:
    """Recognised words or phrases, the best first."""

    words: tuple[str, ...]
    confidences: tuple[float, ...]  # 0 to 1, one each


class WordRecognition:
    """Has the robot listen for words on behalf of one subscriber. Any thread may call."""

    def __init__(
        self,
        robot: Any,
        subscriber: str,
        settings: Callable[[], SpeechSettings],
        sink: Callable[[RecognizedWords], None],
    ) -> None:
        """Start without listening; the robot need not be connected yet.

        Args:
            subscriber: Name of the subscriber at the robot.
            settings: Gives vocabulary and expressions.
            sink: Gets recognised words, also of a recognition that another client started; in a thread of libqi.
        """
        self._robot = robot
        self._subscriber = subscriber
        self._settings = settings
        self._sink = sink
        self._lock = threading.Lock()
        self._former_audio: bool | None = None
        self._relay = EventRelay(lambda: robot.proxy("ALMemory"), self._on_event)
        self._listening = LazySubscription(robot, "recognition of words", self._begin, self._end)
        self._hearing = LazySubscription(robot, f"event {HEARD}", self._hear, lambda: self._relay.unsubscribe(HEARD))
        self._hearing.want(True)

    def start(self) -> None:
        """Start listening, again after a lost connection. No effect if it listens.

        Raises:
            NaoError: If the vocabulary is empty, the robot cannot be asked, or another subscriber uses the recognition.
        """
        self._listening.start_now()

    def stop(self) -> None:
        """Listen no longer. No effect if it does not. Raises NaoError if the robot cannot be asked."""
        self._listening.stop_now()

    def apply(self) -> None:
        """Use the present settings, if it listens.

        Raises NaoError if the robot cannot; then it listens as before, or not at all.
        """
        if not self._listening.running:
            return
        with self._lock:
            self._ask("pause", True)
            try:
                self._set(self._settings())
            finally:
                self._ask("pause", False)

    def report(self) -> Report:
        words = " / ".join(self._settings().vocabulary)
        values = {"vocabulary": words, "last error": self._listening.problem or self._hearing.problem}
        return self._listening.report("does not listen", "listens", "cannot listen", values)

    def close(self) -> None:
        self._listening.close(CLOSE_LIMIT)
        self._hearing.close(CLOSE_LIMIT)

    # --- what the robot is asked ----------------------------------------------------------------------------------

    def _begin(self) -> None:
        settings = self._settings()
        if not settings.vocabulary:
            raise NaoError("the vocabulary is empty: set ~vocabulary, or send one to speech_vocabulary_action")
        owners = [info[0] for info in self._ask("getSubscribersInfo")]
        if self._subscriber in owners:  # left over from a process that was killed
            self._ask("unsubscribe", self._subscriber)
            owners.remove(self._subscriber)
        if owners:  # a new vocabulary would take theirs away
            raise NaoError(f"the recognition of words is in use by {', '.join(owners)}: stop it there first")
        with self._lock:
            self._former_audio = self._ask("getAudioExpression")
            self._set(settings)
        self._ask("subscribe", self._subscriber)

    def _set(self, settings: SpeechSettings) -> None:
        self._ask("setVocabulary", list(settings.vocabulary), settings.word_spotting)
        self._ask("setAudioExpression", settings.audio_expression)
        self._ask("setVisualExpression", settings.visual_expression)

    def _end(self) -> None:
        self._ask("unsubscribe", self._subscriber)
        if self._former_audio is not None:
            self._ask("setAudioExpression", self._former_audio)

    def _hear(self) -> None:
        self._relay.close()  # events of a connection that was lost
        self._relay.subscribe(HEARD)

    def _ask(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, RECOGNITION, method, *arguments)

    def _on_event(self, _name: str, value: Any) -> None:
        heard = read_heard(value)
        if heard is not None:
            self._sink(heard)


def read_heard(value: Any) -> RecognizedWords | None:
    """Words from an event: [phrase, confidence, ...], the best first; "<...> phrase <...>" if spotted.

    None for an event that only takes back earlier words.
    """
    if not isinstance(value, (list, tuple)) or len(value) < 2:
        return None
    pairs = [(SPOTTED.sub("", str(word)).strip(), float(share)) for word, share in zip(value[::2], value[1::2])]
    pairs = [(word, share) for word, share in pairs if word]
    if not pairs:
        return None
    words, confidences = zip(*pairs)
    return RecognizedWords(words, confidences)
