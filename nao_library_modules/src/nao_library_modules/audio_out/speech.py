"""Functions that speak, and body language."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError

from ..audio.fields import Revert
from ..audio.sound_card import decimal
from ..base.errors import BadGoal
from ..functions.chain import checked_by
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
from .files import FileNotes
from .settings import VoiceFunctions
from .sounds import ANIMATED, PLAYER, Sounds
from .speech_checks import check_animated_say, check_say, check_say_to_file, check_spoken
from .voices import SPEECH
from .words import SpokenWords

log = logging.getLogger(__name__)


class SpeechFunctions(VoiceFunctions, Sounds):
    """Functions of ALTextToSpeech and ALAnimatedSpeech. Parameters are fields of AudioOutFunction.

    Attributes:
        words: Words as they are spoken.
        files: Files that the chain played or wrote.
    """

    words: SpokenWords
    files: FileNotes

    # Speaking

    @checked_by(check_say)
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

    @checked_by(check_animated_say)
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
        with self._spoken_with(language, voice, volume):
            self._speak(ANIMATED, "say", *arguments, background=background)

    @checked_by(check_say_to_file)
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
        self.require_new_file(file, overwrite)  # which an earlier function may have written
        with self._spoken_with(language, voice, volume):
            self.sound(SPEECH, "sayToFile", _tagged(str_param, speed, pitch), file)
        duration = self._length(file)
        self.files.note(file, duration)
        return duration

    @checked_by(check_spoken)
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
            self.put_back(ANIMATED, "setBodyLanguageModeFromStr", self.get_body_language_mode())
        self.call(self.robot.proxy(ANIMATED), "setBodyLanguageModeFromStr", body_language.strip())

    def get_body_language_mode(self) -> str:
        """Gestures that go with animatedSay: disabled, random or contextual."""
        return str(self.call(self.robot.proxy(ANIMATED), "getBodyLanguageModeToStr"))

    def add_tags_to_words(self, str_param: Tag, texts: TagWords) -> None:
        """Link words to a tag, whose animations then go with them."""
        self.call(self.robot.proxy(ANIMATED), "addTagsToWords", {str_param.strip(): list(texts)})

    def declare_tag_for_animations(self, str_param: Tag, texts: TagAnimations) -> None:
        """Link animations to a tag."""
        self.call(self.robot.proxy(ANIMATED), "declareTagForAnimations", {str_param.strip(): list(texts)})

    def declare_animations_package(self, str_param: Package) -> None:
        """Add a package of animations."""
        self.call(self.robot.proxy(ANIMATED), "declareAnimationsPackage", str_param.strip())

    # Inside

    def _speak(self, module: str, method: str, *args: Any, background: bool = False) -> None:
        if background:
            said = self.words.begin()
            self.sound(module, method, *args, background=True, ended=lambda: self.words.end(said))
        else:
            began = self.clock.now()
            with self.words.told():
                self.sound(module, method, *args)
            self.happened = self.words.span(began)

    @contextmanager
    def _spoken_with(self, language: str, voice: str, volume: float) -> Iterator[None]:
        """Settings for one text, which go back when it is said, however that ends."""
        undo: list[tuple[str, Any]] = []
        try:
            if language.strip() or voice.strip():
                undo = [("setLanguage", self.speech("getLanguage")), ("setVoice", self.speech("getVoice"))]
            if volume:
                undo.append(("setVolume", decimal(self.speech("getVolume"))))
            for method, value in (
                ("setLanguage", language.strip()),
                ("setVoice", voice.strip()),
                ("setVolume", volume),
            ):
                if value:
                    self.speech(method, value)
            yield
        except BaseException:
            self._undo_settings(undo, quietly=True)
            raise
        self._undo_settings(undo, quietly=False)

    def _undo_settings(self, undo: Sequence[tuple[str, Any]], quietly: bool) -> None:
        for method, value in undo:
            try:
                self.call_now(self.robot.proxy(SPEECH), method, value)
            except NaoError as error:
                if not quietly:
                    raise
                log.warning("clean-up failed: %s", error)

    def require_new_file(self, file: str, overwrite: bool) -> None:
        """Check that a text replaces no sound file of the robot unasked.

        Raises:
            BadGoal: There is such a file.
        """
        if overwrite:
            return
        player = self.robot.proxy(PLAYER)
        try:
            sound = self.call(player, "loadFile", file)
        except NaoError:  # there is none that could be played
            return
        self.call_now(player, "unloadFile", sound)
        problem = f"{file} is there already, in the robot's folder"
        raise BadGoal("file_name", file, "another name, or overwrite", problem=problem)

    def _length(self, file: str) -> float:
        """Length of a file on the robot, s; 0 if the robot does not tell."""
        player = self.robot.proxy(PLAYER)
        try:
            sound = self.call(player, "loadFile", file)
            try:
                return decimal(self.call(player, "getFileLength", sound))
            finally:
                self.call_now(player, "unloadFile", sound)
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
