"""Functions that speak, and body language."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError, RobotError

from ..audio.fields import Revert
from ..audio.sound_card import decimal, put_back
from ..base.errors import BadGoal
from ..functions.chain import checked_by
from ..functions.parts import Part
from ..nao.robot_files import without_sign
from ..server.nao_basic import NaoBasic
from .fields import (
    Background,
    Gestures,
    Overwrite,
    Package,
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
    WrittenFile,
)
from .sounds import ANIMATED, PLAYER, Sounds
from .synthesiser import SPEECH, Synthesiser
from .words import SpokenWords

log = logging.getLogger(__name__)


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
