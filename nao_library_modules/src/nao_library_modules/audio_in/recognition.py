"""Hearing functions that recognise words."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from naoqi.errors import NaoError

from ..audio.fields import Revert
from ..audio.sound_card import put_back
from ..base.errors import BadGoal
from ..base.field_checks import require_known
from ..functions.chain import checked_by
from ..functions.parts import Part
from ..server.extractor_use import Events
from ..server.nao_basic import NaoBasic
from .events import recognised
from .fields import (
    PHRASES_OR_SET,
    AudioExpression,
    Confidence,
    Language,
    LanguageMeanwhile,
    Phrases,
    PhrasesOrSet,
    Timeout,
    VisualExpression,
    WordSpotting,
    require_phrases,
    timeout_of,
)
from .hearing import HeardWord, Hearing, LeftGoing, Recognition, tells_later
from .recogniser import DEAF, HEARS, RECOGNITION, SPEECH, STATUS, Recogniser, WordTimes

log = logging.getLogger(__name__)

WORDS = "WordRecognized"
LISTENING = "listening"
"""Status in the feedback: what is said from now on is heard."""


class RecognitionFunctions(Part):
    """Recognition of words. Parameters are fields of AudioInFunction.

    Whatever another program has set (vocabulary, grammars, language) is back when a function that changed it for
    itself is over.
    """

    def __init__(self, module: NaoBasic, hearing: Hearing, left: LeftGoing, recogniser: Recogniser) -> None:
        self._module = module
        self._hearing = hearing
        self._left = left
        self._recogniser = recogniser

    def _check_recognition(self, vocabulary: Sequence[str], context: dict[str, Any]) -> None:
        if not vocabulary and not context.get("vocabulary", self._left.vocabulary_is_set):
            raise BadGoal("vocabulary", [], PHRASES_OR_SET, problem="it is empty")

    def _check_listen(self, vocabulary: Sequence[str], str_param: str, context: dict[str, Any]) -> None:
        self._check_recognition(vocabulary, context)
        if context.get("paused", self._left.paused):
            raise BadGoal("function", "listen", "resume comes first", problem="the recognition is paused")
        if str_param.strip():
            self._check_language(str_param)

    def _check_language(self, str_param: str) -> None:
        require_known("str_param", str_param, self._recogniser.languages(), "language that the robot recognises")

    @checked_by(_check_listen)
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
            times = self._recogniser.word_times()
            names = (WORDS, STATUS, *times.events)
            with self._hearing.events_of(*names) as events, self._hearing.subscribed(RECOGNITION, "listen"):
                words = self._first_words(events, self._module.clock.now() + timeout_of(timeout), confidence, times)
        if words:
            self._module.happened = words[0].span
        else:
            self._module.remark(f"nothing recognised within {timeout_of(timeout):g} s")
        self._hearing.heard.words += words
        return [part for heard in words for part in (heard.word, heard.confidence)]

    @checked_by(_check_recognition)
    def start_recognition(self, vocabulary: PhrasesOrSet, word_spotting: WordSpotting) -> None:
        """Recognise words also beyond the end of the goal; they come as event WordRecognized on `memory_events`."""
        self.stop_recognition()  # one that runs already is replaced
        phrases = require_phrases(vocabulary) if vocabulary else []
        kept = bool(phrases) and self._recogniser.keep_settings()
        recognition = Recognition(phrases, word_spotting, kept, WORDS not in self._module.events.names)
        try:
            if phrases:
                self._recogniser.idly("setVocabulary", phrases, word_spotting)
            if recognition.publishes:
                self._module.events.subscribe(WORDS)
            self._hearing.start_extractor(RECOGNITION, "recognition")
        except BaseException:
            with suppress(NaoError):  # the error that ended it is raised
                self._put_back(recognition)
            raise
        self._left.recognition = recognition
        self._left.keep()

    def stop_recognition(self) -> None:
        """End what startRecognition began, and put back what was set before; no effect if nothing runs."""
        recognition, self._left.recognition = self._left.recognition, None
        if recognition is None:
            return
        self._left.keep()
        with self._hearing.ended_by(lambda: self._put_back(recognition), "another vocabulary may be lost"):
            self._hearing.stop_extractor(RECOGNITION, "recognition")

    @checked_by(tells_later(vocabulary=True))
    def set_vocabulary(self, vocabulary: Phrases, word_spotting: WordSpotting) -> None:
        """Set the words and phrases to recognise, for good."""
        self._recogniser.idly("setVocabulary", require_phrases(vocabulary), word_spotting)
        self._left.vocabulary_is_set = True
        self._left.keep()

    @checked_by(tells_later(paused=True))
    def pause(self) -> None:
        """Recognise nothing for the time being, whoever wants it; until `resume` or the end of the server."""
        self._hearing.begin(RECOGNITION, "pause", [True], "pause", False)
        self._left.paused = True
        self._left.keep()

    @checked_by(tells_later(paused=False))
    def resume(self) -> None:
        """Recognise again."""
        self._recogniser.call("pause", False)
        self._left.paused = False
        self._left.keep()

    @checked_by(_check_language)
    def set_language(self, str_param: Language, revert: Revert) -> None:
        """Set the language that is recognised."""
        if revert:
            former = self.get_language()
            self._module.after_wait(lambda: self._recogniser.idly_now("setLanguage", former))
        self._recogniser.idly("setLanguage", str_param.strip())

    def get_language(self) -> str:
        """The language that is recognised."""
        return str(self._recogniser.call("getLanguage"))

    def get_available_languages(self) -> list[str]:
        """Languages that the robot recognises."""
        return list(self._recogniser.call("getAvailableLanguages"))

    def set_audio_expression(self, enable: AudioExpression, revert: Revert) -> None:
        """Have the robot bip when it begins and ends to listen, or not."""
        if revert:
            put_back(self._module, RECOGNITION, "setAudioExpression", bool(self._recogniser.call("getAudioExpression")))
        self._recogniser.call("setAudioExpression", bool(enable))

    def get_audio_expression(self) -> bool:
        """Whether the robot bips when it begins and ends to listen."""
        return bool(self._recogniser.call("getAudioExpression"))

    def set_visual_expression(self, enable: VisualExpression) -> None:
        """Have the eyes show that the robot listens, or not."""
        self._recogniser.call("setVisualExpression", bool(enable))

    # For the module

    def drop(self) -> None:
        """End what goals have left, a recognition and a pause; raises nothing."""
        try:
            self.stop_recognition()
            if self._left.paused:
                self._left.paused = False
                self._recogniser.call_now("pause", False)
        except NaoError as error:
            log.warning("the speech recognition is not as it was: %s", error)

    def take_up(self, recognition: Recognition) -> None:
        """Go on with a recognition that this node had left running before it died.

        Raises NaoError if the robot does not answer.
        """
        if recognition.publishes:
            self._module.events.subscribe(WORDS)
        if recognition.vocabulary:
            self._recogniser.idly_now("setVocabulary", recognition.vocabulary, recognition.word_spotting)
        self._recogniser.call_now("subscribe", self._hearing.subscriber_for("recognition"))
        self._left.recognition = recognition

    def pause_again(self) -> None:
        """Be paused as this node was before it died. Raises NaoError if the robot does not answer."""
        self._recogniser.call_now("pause", True)
        self._left.paused = True

    def renew(self) -> None:
        """Begin again what a goal left running: the robot behind a new connection may know nothing of it."""
        recognition = self._left.recognition
        if recognition is None:
            return
        try:
            subscriber = self._hearing.subscriber_for("recognition")
            if subscriber in [row[0] for row in self._recogniser.call_now("getSubscribersInfo")]:
                return
            if recognition.vocabulary:
                recognition.kept = False
                self._recogniser.call_now("setVocabulary", recognition.vocabulary, recognition.word_spotting)
            self._recogniser.call_now("subscribe", subscriber)
        except NaoError as error:
            log.warning("the recognition that a goal began does not run any more: %s", error)
        else:
            log.info("the recognition that a goal began runs again")

    # Inside

    def _first_words(self, events: Events, end: float, confidence: float, times: WordTimes) -> list[HeardWord]:
        hears = self._recogniser.hears()
        if hears:
            self._hearing.publish(LISTENING)
        for event in events.until(end):
            if event.name == STATUS:
                when = self._hearing.event_time(event)
                self._hearing.publish(str(event.value), stamp=when)
                if event.value in HEARS and not hears:
                    self._hearing.publish(LISTENING, stamp=when)
                hears = (hears or event.value in HEARS) and event.value not in DEAF
            elif event.name == SPEECH:
                times.note(event)
            else:
                words = self._heard_words(event.value, times)
                if words:
                    self._hearing.publish(WORDS, words, words[0].span.onset or self._hearing.event_time(event))
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
        former = str(self._recogniser.call("getLanguage")) if language else ""
        if former == language:
            former = ""
        kept = bool(vocabulary) and self._recogniser.keep_settings()

        def restore() -> None:
            if former:
                self._recogniser.idly_now("setLanguage", former)
            if kept:
                self._recogniser.idly_now("popContexts")

        with self._hearing.ended_by(restore, "the speech recognition is not as it was"):
            if former:
                self._recogniser.idly("setLanguage", language)
            if vocabulary:
                self._recogniser.idly("setVocabulary", require_phrases(vocabulary), word_spotting)
            yield

    def _put_back(self, recognition: Recognition) -> None:
        if recognition.publishes:
            self._module.events.unsubscribe(WORDS)
        if recognition.kept:
            self._recogniser.idly_now("popContexts")

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
