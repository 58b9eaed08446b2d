"""Hearing functions that recognise words: the recogniser, its settings, phrases and grammars."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from naoqi.errors import NaoError, RobotError, UnknownMethod

from ..core.chain import Part, checked_by
from ..core.errors import BadGoal
from ..core.fields import require_known
from ..core.memory_functions import MEMORY
from ..core.robot_events import Event, Events, SimulatedKey
from ..core.waiting import OncePerConnection
from ..nao_audio import Revert, put_back
from ..nao_basic import NaoBasic
from .audio_in_fields import (
    PHRASES_OR_SET,
    AudioExpression,
    CompiledGrammar,
    Confidence,
    Context,
    ContextParameter,
    ContextSet,
    ContextValue,
    GrammarFiles,
    GrammarLanguage,
    Language,
    LanguageMeanwhile,
    Overwrite,
    Phrases,
    PhrasesOrSet,
    ReplacedSet,
    Rule,
    RuleType,
    Slot,
    SlotWords,
    Timeout,
    VisualExpression,
    WordSpotting,
    require_phrases,
    timeout_of,
)
from .heard_sounds import SoundRecordingFunctions
from .hearing import HeardWord, Hearing, LeftGoing, Recognition, Span, recognised, tells_later

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


class ContextFunctions(Part):
    """Grammars. `str_param` names the context; further names are in `vocabulary`, in NAOqi's order.

    What a running recognition would refuse is done in a pause of it. Contexts stay until they are removed.
    `saved_sets`: names under which this server has saved contexts; NAOqi does not report which there are.
    """

    left_by_goals = frozenset({"saved_sets"})

    def __init__(self, recogniser: Recogniser, recordings: SoundRecordingFunctions) -> None:
        self._recogniser = recogniser
        self._recordings = recordings
        self.saved_sets: set[str] = set()

    def _check_compile(self, vocabulary: Sequence[str], overwrite: bool, context: dict[str, Any]) -> None:
        """A file to write that is new or may be replaced."""
        file, written = vocabulary[1], context.setdefault("grammars", set())
        self._recordings.require_new_file(file, overwrite, "vocabulary")
        if file in written and not overwrite:
            problem = f"an earlier function writes {file}"
            raise BadGoal("vocabulary", file, "another name, or overwrite", problem=problem)
        written.add(file)

    @checked_by(_check_compile)
    def compile(self, str_param: GrammarLanguage, vocabulary: GrammarFiles, overwrite: Overwrite) -> None:
        """Check a grammar file (BNF) of a language and write it in the form that `addContext` takes."""
        self._recordings.require_new_file(vocabulary[1], overwrite, "vocabulary")
        self._recogniser.call("compile", *vocabulary, str_param.strip())

    def add_context(self, str_param: Context, vocabulary: CompiledGrammar) -> None:
        """Listen for what a compiled grammar has, too."""
        self._recogniser.idly("addContext", vocabulary[0], str_param.strip())

    def remove_context(self, str_param: Context) -> None:
        """Forget a context."""
        self._recogniser.idly("removeContext", str_param.strip())

    def remove_all_context(self) -> None:
        """Forget all contexts."""
        self._recogniser.idly("removeAllContext")

    def _check_new_set(self, str_param: str, overwrite: bool, context: dict[str, Any]) -> None:
        """A name that this server has saved no contexts under, or that may be replaced."""
        name, sets = str_param.strip(), context.setdefault("sets", {})
        if not overwrite and (sets[name] if name in sets else name in self.saved_sets):
            problem = f"{name!r} is saved already"
            raise BadGoal("str_param", str_param, "another name, or overwrite", problem=problem)
        sets[name] = True

    @checked_by(_check_new_set)
    def save_context_set(self, str_param: ContextSet, overwrite: ReplacedSet) -> None:
        """Keep the contexts as they are under a name; `overwrite` replaces those that this server saved."""
        self._recogniser.call("saveContextSet", str_param.strip())
        self.saved_sets.add(str_param.strip())

    def load_context_set(self, str_param: ContextSet) -> None:
        """Put saved contexts in the place of those there are."""
        self._recogniser.idly("loadContextSet", str_param.strip())

    def _check_erased_set(self, str_param: str, context: dict[str, Any]) -> None:
        """Nothing can be wrong; the name is free then."""
        context.setdefault("sets", {})[str_param.strip()] = False

    @checked_by(_check_erased_set)
    def erase_context_set(self, str_param: ContextSet) -> None:
        """Forget saved contexts."""
        self._recogniser.call("eraseContextSet", str_param.strip())
        self.saved_sets.discard(str_param.strip())

    def get_rules(self, str_param: Context, vocabulary: RuleType) -> list[str]:
        """Names of the rules of a type."""
        return list(self._recogniser.call("getRules", str_param.strip(), vocabulary[0].strip()))

    def activate_rule(self, str_param: Context, vocabulary: Rule) -> None:
        """Switch a rule on."""
        self._recogniser.idly("activateRule", str_param.strip(), vocabulary[0])

    def deactivate_rule(self, str_param: Context, vocabulary: Rule) -> None:
        """Switch a rule off."""
        self._recogniser.idly("deactivateRule", str_param.strip(), vocabulary[0])

    def activate_all_rules(self, str_param: Context) -> None:
        """Switch all rules of a context on."""
        self._recogniser.idly("activateAllRules", str_param.strip())

    def deactivate_all_rules(self, str_param: Context) -> None:
        """Switch all rules of a context off."""
        self._recogniser.idly("deactivateAllRules", str_param.strip())

    def add_word_list_to_slot(self, str_param: Context, vocabulary: SlotWords) -> None:
        """Fill a slot with words, beside those that it has."""
        self._recogniser.idly("addWordListToSlot", str_param.strip(), vocabulary[0], list(vocabulary[1:]))

    def remove_word_list_from_slot(self, str_param: Context, vocabulary: Slot) -> None:
        """Empty a slot."""
        self._recogniser.idly("removeWordListFromSlot", str_param.strip(), vocabulary[0])

    def set_context_param(self, str_param: Context, vocabulary: ContextParameter, values: ContextValue) -> None:
        """Change a parameter of a context: ConfidenceThreshold, 0..1, below which it tells nothing."""
        self._recogniser.call("setContextParam", str_param.strip(), vocabulary[0], float(values[0]))

    def get_context_param(self, str_param: Context, vocabulary: ContextParameter) -> float:
        """A parameter of a context."""
        return float(self._recogniser.call("getContextParam", str_param.strip(), vocabulary[0]))

    functions = {
        "compile": compile,
        "addContext": add_context,
        "removeContext": remove_context,
        "removeAllContext": remove_all_context,
        "saveContextSet": save_context_set,
        "loadContextSet": load_context_set,
        "eraseContextSet": erase_context_set,
        "getRules": get_rules,
        "activateRule": activate_rule,
        "deactivateRule": deactivate_rule,
        "activateAllRules": activate_all_rules,
        "deactivateAllRules": deactivate_all_rules,
        "addWordListToSlot": add_word_list_to_slot,
        "removeWordListFromSlot": remove_word_list_from_slot,
        "setContextParam": set_context_param,
        "getContextParam": get_context_param,
    }
