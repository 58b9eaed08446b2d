"""Words as the robot speaks them: events of its memory, told while this server has something said."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError

from .event_relay import EventRelay

log = logging.getLogger(__name__)

WORD, SENTENCE = "ALTextToSpeech/CurrentWord", "ALTextToSpeech/CurrentSentence"


class SpokenWords:
    """Tells words while something is said.

    Events come from threads of libqi, the rest from the thread that executes goals. The lock is held while a word is
    told, so that none is told after `stop`.
    """

    def __init__(self, memory: Callable[[], Any], tell: Callable[[str, str], None]) -> None:
        """Begin without subscriptions.

        Args:
            memory: Gives the proxy of ALMemory.
            tell: Called with each word and the sentence that it belongs to; it must not block.
        """
        self._events = EventRelay(memory, self._take)
        self._tell = tell
        self._lock = threading.Lock()
        self._texts: set[object] = set()  # under way
        self._sentence = ""

    def begin(self) -> object:
        """Something is said from now on; what is returned tells `end` what."""
        for event in (SENTENCE, WORD):
            try:
                self._events.subscribe(event)
            except NaoError as error:
                log.debug("%s is not watched: %s", event, error)  # it is said all the same
        text = object()
        with self._lock:
            self._texts.add(text)
        return text

    def end(self, text: object) -> None:
        """It is said; when nothing else is, no more words are told."""
        with self._lock:
            self._texts.discard(text)

    @contextmanager
    def told(self) -> Iterator[None]:
        """Tell words while the block runs."""
        text = self.begin()
        try:
            yield
        finally:
            self.end(text)

    def stop(self) -> None:
        """Tell no more of what has begun."""
        with self._lock:
            self._texts.clear()

    def renew(self) -> None:
        """Subscribe again: the robot behind a new connection knows nothing of it."""
        self._events.renew()

    def close(self) -> None:
        """Unsubscribe."""
        self.stop()
        self._events.close()

    def _take(self, event: str, value: Any) -> None:
        """Called from a thread of libqi."""
        text = str(value or "").strip()
        with self._lock:
            if event == SENTENCE:
                self._sentence = text
            elif self._texts and text:
                self._tell(text, self._sentence)
