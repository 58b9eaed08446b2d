"""Functions that speak, the words as they are spoken, and settings: voices, languages, parameters, the dictionary."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError, RobotError
from naoqi.limits import WORD_TIMES_LIMIT, wait_while_answering

from ..core.chain import Part, checked_by
from ..core.errors import BadGoal
from ..core.fields import require_known
from ..core.memory_functions import MEMORY
from ..core.nao_facts import without_sign
from ..core.robot_events import EventRelay, SimulatedKey, checked_span
from ..core.waiting import OncePerConnection
from ..nao_audio import DEVICE_PARAMETERS, NaoAudio, Revert, check_device_setting, decimal, put_back
from ..nao_basic import NaoBasic
from .audio_out_fields import (
    ALL_PARAMETERS,
    EFFECTS,
    PARAMETERS,
    VOICE_PARAMETERS,
    Background,
    DeletedTexts,
    Gestures,
    Language,
    Overwrite,
    Package,
    ParameterNames,
    ParameterValues,
    Preference,
    ReadParameter,
    SetParameter,
    SpokenText,
    Tag,
    TagAnimations,
    TagWords,
    TextGestures,
    TextLanguage,
    TextPitch,
    TextSpeed,
    TextVoice,
    TextVolume,
    Voice,
    VoiceOfLanguage,
    Word,
    WordTexts,
    WrittenFile,
    range_of,
)
from .played_sounds import ANIMATED, PLAYER, SPEECH, Sounds

log = logging.getLogger(__name__)


class Synthesiser(Part):
    """Calls of ALTextToSpeech.

    Its voices and languages are read once a connection, and again when a name is not among them.

    Used from the thread that executes goals; checks without a goal have their own.
    """

    def __init__(self, module: NaoBasic) -> None:
        self._module = module
        self.prepare_for_checks()

    def prepare_for_checks(self) -> None:
        """Know no voices and no languages yet."""
        self._known: OncePerConnection[dict[str, list[str]]] = OncePerConnection(self._module.robot, dict)

    def call(self, method: str, *args: Any) -> Any:
        """Call ALTextToSpeech; preemption ends the call."""
        return self._module.call(self._module.robot.proxy(SPEECH), method, *args)

    def require_voice(self, field: str, voice: str) -> str:
        """A voice that the robot has; BadGoal names those it has."""
        return self._require(field, voice, "getAvailableVoices", "voice of the robot")

    def require_language(self, field: str, language: str) -> str:
        """A language that the robot speaks; BadGoal names those it speaks."""
        return self._require(field, language, "getAvailableLanguages", "language that the robot speaks")

    def _require(self, field: str, name: str, method: str, kind: str) -> str:
        if name.strip() not in self._names(method):
            self._known().pop(method, None)  # it may have been installed meanwhile
        return require_known(field, name, self._names(method), kind)

    def _names(self, method: str) -> list[str]:
        known = self._known()
        if method not in known:
            known[method] = [str(name) for name in self.call(method)]
        return known[method]


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


class SpeechFunctions(Part):
    """Functions of ALTextToSpeech and ALAnimatedSpeech. Parameters are fields of AudioOutFunction."""

    def __init__(self, module: NaoBasic, synthesiser: Synthesiser, sounds: Sounds, words: SpokenWords) -> None:
        self._module = module
        self._synthesiser = synthesiser
        self._sounds = sounds
        self._words = words

    # Speaking

    def _check_spoken(self, language: str, voice: str) -> None:
        if language.strip():
            self._synthesiser.require_language("language", language)
        if voice.strip():
            self._synthesiser.require_voice("voice", voice)

    def _check_say(self, language: str, voice: str, volume: float, background: bool) -> None:
        _require_no_changes(background, voice=voice.strip(), volume=volume)
        self._check_spoken(language, voice)

    @checked_by(_check_say)
    def say(
        self,
        str_param: SpokenText,
        language: TextLanguage,
        voice: TextVoice,
        volume: TextVolume,
        speed: TextSpeed,
        pitch: TextPitch,
        background: Background,
    ) -> None:
        """Say a text, and wait until it is said."""
        arguments = [_tagged(str_param, speed, pitch)]
        if language.strip() and not voice.strip():
            arguments.append(language.strip())  # the robot takes it for this text only
            language = ""
        with self._spoken_with(language, voice, volume):
            self._speak(SPEECH, "say", *arguments, background=background)

    def _check_animated_say(self, language: str, voice: str, volume: float, background: bool) -> None:
        _require_no_changes(background, language=language.strip(), voice=voice.strip(), volume=volume)
        self._check_spoken(language, voice)

    @checked_by(_check_animated_say)
    def animated_say(
        self,
        str_param: SpokenText,
        language: TextLanguage,
        voice: TextVoice,
        volume: TextVolume,
        speed: TextSpeed,
        pitch: TextPitch,
        background: Background,
        body_language: TextGestures,
    ) -> None:
        """Say a text with gestures, annotated ones and those of the mode of body language."""
        arguments: list[Any] = [_tagged(str_param, speed, pitch)]
        if body_language.strip():
            arguments.append({"bodyLanguageMode": body_language.strip()})
        if body_language.strip() != "disabled" or "^" in str_param:
            self._remark_limpness()
        with self._spoken_with(language, voice, volume):
            self._speak(ANIMATED, "say", *arguments, background=background)

    def _remark_limpness(self) -> None:
        """NAOqi says a text without its gestures where the robot is limp, and does not tell."""
        motion = self._module.robot.proxy("ALMotion")
        if not any(self._module.call(motion, "getStiffnesses", ["Head", "Arms"])):
            self._module.remark("no gestures, as head and arms are limp: wakeUp of NaoMotion first")

    def _check_say_to_file(self, file_name: str, language: str, voice: str, overwrite: bool) -> None:
        self._require_new_file(file_name.strip(), overwrite)
        self._check_spoken(language, voice)

    @checked_by(_check_say_to_file)
    def say_to_file(
        self,
        str_param: SpokenText,
        file_name: WrittenFile,
        language: TextLanguage,
        voice: TextVoice,
        volume: TextVolume,
        speed: TextSpeed,
        pitch: TextPitch,
        overwrite: Overwrite,
    ) -> float:
        """Write a text as speech to a file, unheard; answers how long it is, s, 0 if the robot does not tell."""
        file = file_name.strip()
        self._require_new_file(file, overwrite)  # which an earlier function may have written
        with self._spoken_with(language, voice, volume):
            self._sounds.sound(SPEECH, "sayToFile", _tagged(str_param, speed, pitch), without_sign(file))
        duration = self._length(file)
        self._sounds.note_file(file, duration)
        return duration

    @checked_by(_check_spoken)
    def say_to_file_and_play(
        self,
        str_param: SpokenText,
        language: TextLanguage,
        voice: TextVoice,
        volume: TextVolume,
        speed: TextSpeed,
        pitch: TextPitch,
    ) -> None:
        """Say a text by way of a file of the robot."""
        with self._spoken_with(language, voice, volume):
            self._speak(SPEECH, "sayToFileAndPlay", _tagged(str_param, speed, pitch))

    # Body language

    def set_body_language_mode(self, body_language: Gestures, revert: Revert) -> None:
        """Choose the gestures that go with animatedSay."""
        if revert:
            put_back(self._module, ANIMATED, "setBodyLanguageModeFromStr", self.get_body_language_mode())
        self._animated("setBodyLanguageModeFromStr", body_language.strip())

    def get_body_language_mode(self) -> str:
        """Gestures that go with animatedSay: disabled, random or contextual."""
        return str(self._animated("getBodyLanguageModeToStr"))

    def add_tags_to_words(self, str_param: Tag, texts: TagWords) -> None:
        """Link words to a tag, whose animations then go with them."""
        self._animated("addTagsToWords", {str_param.strip(): list(texts)})

    def declare_tag_for_animations(self, str_param: Tag, texts: TagAnimations) -> None:
        """Link animations to a tag."""
        self._animated("declareTagForAnimations", {str_param.strip(): list(texts)})

    def declare_animations_package(self, str_param: Package) -> None:
        """Add a package of animations."""
        self._animated("declareAnimationsPackage", str_param.strip())

    # Inside

    def _animated(self, method: str, *args: Any) -> Any:
        return self._module.call(self._module.robot.proxy(ANIMATED), method, *args)

    def _speak(self, module: str, method: str, *args: Any, background: bool = False) -> None:
        if background:
            said = self._words.begin()
            self._sounds.sound(module, method, *args, background=True, ended=lambda: self._words.end(said))
        else:
            began = self._module.clock.now()
            with self._words.published():
                self._sounds.sound(module, method, *args)
            self._module.happened = self._words.span(began)

    @contextmanager
    def _spoken_with(self, language: str, voice: str, volume: float) -> Iterator[None]:
        """Settings for one text, which go back when it is said, however that ends."""
        undo: list[tuple[str, Any]] = []
        try:
            if language.strip() or voice.strip():
                undo = [(f"set{what}", self._synthesiser.call(f"get{what}")) for what in ("Language", "Voice")]
            if volume:
                undo.append(("setVolume", decimal(self._synthesiser.call("getVolume"))))
            for method, value in (
                ("setLanguage", language.strip()),
                ("setVoice", voice.strip()),
                ("setVolume", volume),
            ):
                if value:
                    self._synthesiser.call(method, value)
            yield
        except BaseException:
            self._undo_settings(undo, quietly=True)
            raise
        self._undo_settings(undo, quietly=False)

    def _undo_settings(self, undo: Sequence[tuple[str, Any]], quietly: bool) -> None:
        for method, value in undo:
            try:
                self._module.call_now(self._module.robot.proxy(SPEECH), method, value)
            except NaoError as error:
                if not quietly:
                    raise
                log.warning("clean-up failed: %s", error)

    def _require_new_file(self, file: str, overwrite: bool) -> None:
        """Raise BadGoal where a text would replace a sound file of the robot unasked."""
        if overwrite:
            return
        player = self._module.robot.proxy(PLAYER)
        try:
            sound = self._module.call(player, "loadFile", without_sign(file))
        except RobotError:  # there is none that could be played
            return
        self._module.call_now(player, "unloadFile", sound)
        problem = f"{file} is there already, in the robot's folder"
        raise BadGoal("file_name", file, "another name, or overwrite", problem=problem)

    def _length(self, file: str) -> float:
        """Length of a file on the robot, s; 0 if the robot does not report it."""
        player = self._module.robot.proxy(PLAYER)
        try:
            sound = self._module.call(player, "loadFile", without_sign(file))
            try:
                return decimal(self._module.call(player, "getFileLength", sound))
            finally:
                self._module.call_now(player, "unloadFile", sound)
        except NaoError as error:
            log.warning("the length of %s is not known: %s", file, error)  # it is written all the same
            return 0.0

    functions = {
        "say": say,
        "animatedSay": animated_say,
        "sayToFile": say_to_file,
        "sayToFileAndPlay": say_to_file_and_play,
        "setBodyLanguageMode": set_body_language_mode,
        "getBodyLanguageMode": get_body_language_mode,
        "addTagsToWords": add_tags_to_words,
        "declareTagForAnimations": declare_tag_for_animations,
        "declareAnimationsPackage": declare_animations_package,
    }


def _tagged(text: str, speed: float, pitch: float) -> str:
    """A text with NAOqi's tags for speed and pitch in front, %; 0 leaves one out."""
    tags = [f"\\{tag}={value:.0f}\\" for tag, value in (("rspd", speed), ("vct", pitch)) if value]
    return "".join(tags) + (" " if tags else "") + text


def _require_no_changes(background: bool, **fields: object) -> None:
    """What is set for one text must be put back at its end: somebody has to wait for that."""
    for field, value in fields.items():
        if background and value:
            raise BadGoal(field, value, "nothing, for a text in the background; or set it before")


class VoiceFunctions(Part):
    """Settings of ALTextToSpeech. Parameters are fields of AudioOutFunction."""

    def __init__(self, module: NaoAudio, synthesiser: Synthesiser) -> None:
        self._module = module
        self._synthesiser = synthesiser

    # Voices and languages

    def _check_voice(self, str_param: str) -> None:
        self._synthesiser.require_voice("str_param", str_param.strip())

    @checked_by(_check_voice)
    def set_voice(self, str_param: Voice, revert: Revert) -> None:
        """Change the voice."""
        if revert:
            self._put_back_voice()
        self._synthesiser.call("setVoice", str_param.strip())

    def get_voice(self) -> str:
        """Voice that speaks."""
        return str(self._synthesiser.call("getVoice"))

    def get_available_voices(self) -> list[str]:
        """Voices that the robot has."""
        return list(self._synthesiser.call("getAvailableVoices"))

    def _check_language(self, str_param: str) -> None:
        self._synthesiser.require_language("str_param", str_param.strip())

    @checked_by(_check_language)
    def set_language(self, str_param: Language, revert: Revert) -> None:
        """Change the language."""
        if revert:
            self._put_back_voice()
        self._synthesiser.call("setLanguage", str_param.strip())

    def get_language(self) -> str:
        """Language that is spoken."""
        return str(self._synthesiser.call("getLanguage"))

    def get_available_languages(self) -> list[str]:
        """Languages that the robot speaks."""
        return list(self._synthesiser.call("getAvailableLanguages"))

    def get_supported_languages(self) -> list[str]:
        """Languages that there are, installed or not."""
        return list(self._synthesiser.call("getSupportedLanguages"))

    def _check_default_voice(self, str_param: str, voice: str) -> None:
        self._check_language(str_param)
        self._synthesiser.require_voice("voice", voice.strip())

    @checked_by(_check_default_voice)
    def set_language_default_voice(self, str_param: Language, voice: VoiceOfLanguage) -> None:
        """Choose the voice that a language is spoken with."""
        self._synthesiser.call("setLanguageDefaultVoice", str_param.strip(), voice.strip())

    def locale(self) -> str:
        """Locale of the language, as en_US."""
        return str(self._synthesiser.call("locale"))

    # Parameters

    def _check_parameters(self, str_param: str, names: Sequence[str], values: Sequence[float]) -> None:
        """A value for each parameter of the voice; or, named in `str_param`, for the one of the sound card."""
        if not names and str_param.strip() in DEVICE_PARAMETERS:
            check_device_setting(str_param, values)
            return
        _require_some(names)
        if len(values) != len(names):
            raise BadGoal("values", list(values), f"{len(names)}: one for each of {', '.join(names)}")
        for name, value in zip(map(str.strip, names), values):
            lowest, highest = PARAMETERS[name]
            off = name in EFFECTS and value == 0.0
            if not (off or math.isfinite(value) and lowest <= value <= highest):
                raise BadGoal("values", value, f"{name} is {range_of(name)}")

    @checked_by(_check_parameters)
    def set_parameter(
        self, str_param: SetParameter, names: ParameterNames, values: ParameterValues, revert: Revert
    ) -> None:
        """Set parameters of the voice; or outputSampleRate of the sound card, named in `str_param`."""
        if not names:
            self._module.set_device_parameter(str_param, values, revert)
            return
        for name, value in zip(map(str.strip, names), values):
            if revert:
                put_back(self._module, SPEECH, "setParameter", name, self._parameter(name))
            self._synthesiser.call("setParameter", name, float(value))

    def _check_parameter_names(self, str_param: str, names: Sequence[str]) -> None:
        """Parameters of the voice; or, named in `str_param`, one of it or of the sound card."""
        if names or not str_param.strip():
            _require_some(names)
        else:
            require_known("str_param", str_param, ALL_PARAMETERS, "parameter")

    @checked_by(_check_parameter_names)
    def get_parameter(self, str_param: ReadParameter, names: ParameterNames) -> list[float]:
        """Parameters of the voice; or one, also of the sound card, named in `str_param`."""
        if not names and str_param.strip() in DEVICE_PARAMETERS:
            return [self._module.get_device_parameter(str_param)]
        return [self._parameter(name.strip()) for name in names or [str_param]]

    def reset_speed(self) -> None:
        """Speak at the usual speed again."""
        self._synthesiser.call("resetSpeed")

    def reset(self) -> None:
        """Speak as the robot usually does again."""
        self._synthesiser.call("reset")

    def load_voice_preference(self, str_param: Preference) -> None:
        """Set the parameters of the voice as a preference of the robot says."""
        self._synthesiser.call("loadVoicePreference", str_param.strip())

    # The dictionary

    def add_to_dictionary(self, str_param: Word, texts: WordTexts) -> bool:
        """Teach how a word is spoken."""
        return bool(self._synthesiser.call("addToDictionary", str_param.strip(), *texts))

    def delete_from_dictionary(self, str_param: Word, texts: DeletedTexts) -> bool:
        """Forget how a word is spoken."""
        return bool(self._synthesiser.call("deleteFromDictionary", str_param.strip(), *texts))

    def show_dictionary(self) -> None:
        """Have the robot write the words that it was taught to its log."""
        self._synthesiser.call("showDictionary")

    def _parameter(self, name: str) -> float:
        return decimal(self._synthesiser.call("getParameter", name))

    def _put_back_voice(self) -> None:
        language, voice = self._synthesiser.call("getLanguage"), self._synthesiser.call("getVoice")
        put_back(self._module, SPEECH, "setVoice", voice)
        put_back(self._module, SPEECH, "setLanguage", language)  # the last one left is done first

    functions = {
        "setVoice": set_voice,
        "getVoice": get_voice,
        "getAvailableVoices": get_available_voices,
        "setLanguage": set_language,
        "getLanguage": get_language,
        "getAvailableLanguages": get_available_languages,
        "getSupportedLanguages": get_supported_languages,
        "setLanguageDefaultVoice": set_language_default_voice,
        "locale": locale,
        "setParameter": set_parameter,
        "getParameter": get_parameter,
        "resetSpeed": reset_speed,
        "reset": reset,
        "loadVoicePreference": load_voice_preference,
        "addToDictionary": add_to_dictionary,
        "deleteFromDictionary": delete_from_dictionary,
        "showDictionary": show_dictionary,
    }


def _require_some(names: Sequence[str]) -> None:
    if not names:
        raise BadGoal("names", [], VOICE_PARAMETERS, problem="nothing is named")
