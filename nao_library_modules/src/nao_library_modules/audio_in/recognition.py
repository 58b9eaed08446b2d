"""Hearing functions that recognise words."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ..audio.fields import Revert
from ..functions.chain import checked_by
from .base import Events, timeout_of
from .checks import (
    check_language,
    check_listen,
    check_pause,
    check_recognition,
    check_resume,
    check_vocabulary,
    require_phrases,
)
from .events import recognised
from .fields import (
    AudioExpression,
    Confidence,
    Language,
    LanguageMeanwhile,
    Phrases,
    PhrasesOrSet,
    Timeout,
    VisualExpression,
    WordSpotting,
)
from .heard import HeardWord
from .recogniser import DEAF, HEARS, RECOGNITION, STATUS, RecogniserAccess
from .times import SPEECH, WordTimes

log = logging.getLogger(__name__)

WORDS = "WordRecognized"
LISTENING = "listening"
"""Status in the feedback: what is said from now on is heard."""


@dataclass
class Recognition:
    """A recognition that a goal left running.

    Attributes:
        vocabulary: Its words and phrases; empty for those that were set before.
        word_spotting: Whether they are also found within longer sentences.
        kept: Whether the robot keeps what was set before, to be put back.
        told: Whether it passes events on that nobody had passed on before.
    """

    vocabulary: list[str]
    word_spotting: bool
    kept: bool
    told: bool


class RecognitionFunctions(RecogniserAccess):
    """Recognition of words. Parameters are fields of AudioInFunction.

    Whatever another program has set (vocabulary, grammars, language) is back when a function that changed it for
    itself is over.

    Attributes:
        vocabulary_is_set: Whether setVocabulary has been called, so that functions need not bring words.
        paused: Whether this server has paused the recognition.
    """

    events: Any  # EventRelay of NaoBasic: what it subscribes is published
    put_back: Callable[..., None]  # of NaoAudio
    after_wait: Callable[[Callable[[], None]], None]  # of NaoBasic
    vocabulary_is_set = False
    paused = False
    keep_left: Callable[[], None]  # of NaoAudioInput
    _recognition: Recognition | None = None

    # Functions

    @checked_by(check_listen)
    def listen(
        self,
        vocabulary: PhrasesOrSet,
        word_spotting: WordSpotting,
        timeout: Timeout,
        confidence: Confidence,
        str_param: LanguageMeanwhile,
    ) -> list[Any]:
        """Wait until something is recognised; answers words and confidences, the best first, nothing if none came."""
        with self._settings_for(vocabulary, word_spotting, str_param.strip()):
            times = self.word_times()
            with self.events_of(WORDS, STATUS, *times.events) as events, self.subscribed(RECOGNITION, "listen"):
                words = self._first_words(events, self.clock.now() + timeout_of(timeout), confidence, times)
        if words:
            self.happened = words[0].span
        else:
            self.remark(f"nothing recognised within {timeout_of(timeout):g} s")
        self.heard.add_words(words)
        return [part for heard in words for part in (heard.word, heard.confidence)]

    @checked_by(check_recognition)
    def start_recognition(self, vocabulary: PhrasesOrSet, word_spotting: WordSpotting) -> None:
        """Recognise words also beyond the end of the goal; they come as event WordRecognized on `memory_events`."""
        self.stop_recognition()  # one that runs already is replaced
        phrases = require_phrases(vocabulary) if vocabulary else []
        kept = bool(phrases) and self.keep_settings()
        recognition = Recognition(phrases, word_spotting, kept, WORDS not in self.events.names)
        try:
            if phrases:
                self.idly("setVocabulary", phrases, word_spotting)
            if recognition.told:
                self.events.subscribe(WORDS)
            self.start_extractor(RECOGNITION, "recognition")
        except BaseException:
            with suppress(NaoError):  # the error that ended it is the one to tell
                self._put_back(recognition)
            raise
        self._recognition = recognition
        self.keep_left()

    def stop_recognition(self) -> None:
        """End what startRecognition began, and put back what was set before; no effect if nothing runs."""
        recognition, self._recognition = self._recognition, None
        if recognition is None:
            return
        self.keep_left()
        with self.ended_by(lambda: self._put_back(recognition), "another vocabulary may be lost"):
            self.stop_extractor(RECOGNITION, "recognition")

    @checked_by(check_vocabulary)
    def set_vocabulary(self, vocabulary: Phrases, word_spotting: WordSpotting) -> None:
        """Set the words and phrases to recognise, for good."""
        self.idly("setVocabulary", require_phrases(vocabulary), word_spotting)
        self.vocabulary_is_set = True
        self.keep_left()

    @checked_by(check_pause)
    def pause(self) -> None:
        """Recognise nothing for the time being, whoever wants it; until `resume` or the end of the server."""
        self.begin(RECOGNITION, "pause", [True], "pause", False)
        self.paused = True
        self.keep_left()

    @checked_by(check_resume)
    def resume(self) -> None:
        """Recognise again."""
        self.recogniser("pause", False)
        self.paused = False
        self.keep_left()

    @checked_by(check_language)
    def set_language(self, str_param: Language, revert: Revert) -> None:
        """Set the language that is recognised."""
        if revert:
            former = self.get_language()
            self.after_wait(lambda: self.idly_now("setLanguage", former))
        self.idly("setLanguage", str_param.strip())

    def get_language(self) -> str:
        """The language that is recognised."""
        return str(self.recogniser("getLanguage"))

    def get_available_languages(self) -> list[str]:
        """Languages that the robot recognises."""
        return list(self.recogniser("getAvailableLanguages"))

    def set_audio_expression(self, enable: AudioExpression, revert: Revert) -> None:
        """Have the robot bip when it begins and ends to listen, or not."""
        if revert:
            self.put_back(RECOGNITION, "setAudioExpression", bool(self.recogniser("getAudioExpression")))
        self.recogniser("setAudioExpression", bool(enable))

    def get_audio_expression(self) -> bool:
        """Whether the robot bips when it begins and ends to listen."""
        return bool(self.recogniser("getAudioExpression"))

    def set_visual_expression(self, enable: VisualExpression) -> None:
        """Have the eyes show that the robot listens, or not."""
        self.recogniser("setVisualExpression", bool(enable))

    # For the module

    def drop_recognition(self) -> None:
        """End what goals have left, a recognition and a pause; raises nothing."""
        try:
            self.stop_recognition()
            if self.paused:
                self.paused = False
                self.call_now(self.robot.proxy(RECOGNITION), "pause", False)
        except NaoError as error:
            log.warning("the speech recognition is not as it was: %s", error)

    def take_up_recognition(self, recognition: Recognition) -> None:
        """Go on with a recognition that this node had left running before it died.

        Raises:
            NaoError: The robot does not answer.
        """
        if recognition.told:
            self.events.subscribe(WORDS)
        if recognition.vocabulary:
            self.idly_now("setVocabulary", recognition.vocabulary, recognition.word_spotting)
        self.call_now(self.robot.proxy(RECOGNITION), "subscribe", self.subscriber_for("recognition"))
        self._recognition = recognition

    def pause_again(self) -> None:
        """Be paused as this node was before it died.

        Raises:
            NaoError: The robot does not answer.
        """
        self.call_now(self.robot.proxy(RECOGNITION), "pause", True)
        self.paused = True

    def renew_recognition(self) -> None:
        """Begin again what a goal left running: the robot behind a new connection may know nothing of it."""
        recognition = self._recognition
        if recognition is None:
            return
        try:
            proxy = self.robot.proxy(RECOGNITION)
            if self.subscriber_for("recognition") in [row[0] for row in self.call_now(proxy, "getSubscribersInfo")]:
                return
            if recognition.vocabulary:
                recognition.kept = False
                self.call_now(proxy, "setVocabulary", recognition.vocabulary, recognition.word_spotting)
            self.call_now(proxy, "subscribe", self.subscriber_for("recognition"))
        except NaoError as error:
            log.warning("the recognition that a goal began does not run any more: %s", error)
        else:
            log.info("the recognition that a goal began runs again")

    # Inside

    def _first_words(self, events: Events, end: float, confidence: float, times: WordTimes) -> list[HeardWord]:
        hears = self.hears()
        if hears:
            self.tell(LISTENING)
        for event in events.until(end):
            if event.name == STATUS:
                when = self.event_time(event)
                self.tell(str(event.value), stamp=when)
                if event.value in HEARS and not hears:
                    self.tell(LISTENING, stamp=when)
                hears = (hears or event.value in HEARS) and event.value not in DEAF
            elif event.name == SPEECH:
                times.note(event)
            else:
                words = self._heard_words(event.value, times)
                if words:
                    self.tell(WORDS, words, words[0].span.onset or self.event_time(event))
                words = [heard for heard in words if heard.confidence >= confidence]
                if words:
                    return words
        return []

    def _heard_words(self, value: Any, times: WordTimes) -> list[HeardWord]:
        try:
            words = recognised(value)
        except ValueError as error:
            log.warning("%s", error)
            return []
        spans = times.of(value, len(words)) if words else []
        return [HeardWord(word, confidence, span) for (word, confidence), span in zip(words, spans)]

    @contextmanager
    def _settings_for(self, vocabulary: Sequence[str], word_spotting: bool, language: str) -> Iterator[None]:
        """Have the robot recognise words in a language during a block; afterwards it does what it did before."""
        if not vocabulary and not language:
            yield
            return
        former = str(self.recogniser("getLanguage")) if language else ""
        if former == language:
            former = ""
        kept = bool(vocabulary) and self.keep_settings()

        def restore() -> None:
            if former:
                self.idly_now("setLanguage", former)
            if kept:
                self.restore_settings()

        with self.ended_by(restore, "the speech recognition is not as it was"):
            if former:
                self.idly("setLanguage", language)
            if vocabulary:
                self.idly("setVocabulary", require_phrases(vocabulary), word_spotting)
            yield

    def _put_back(self, recognition: Recognition) -> None:
        if recognition.told:
            self.events.unsubscribe(WORDS)
        if recognition.kept:
            self.restore_settings()

    functions = {
        "listen": listen,
        "startRecognition": start_recognition,
        "stopRecognition": stop_recognition,
        "setVocabulary": set_vocabulary,
        "pause": pause,
        "resume": resume,
        "setLanguage": set_language,
        "getLanguage": get_language,
        "getAvailableLanguages": get_available_languages,
        "setAudioExpression": set_audio_expression,
        "getAudioExpression": get_audio_expression,
        "setVisualExpression": set_visual_expression,
    }
