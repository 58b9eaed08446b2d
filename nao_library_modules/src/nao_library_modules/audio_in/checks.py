"""Checks of the hearing functions, made before a chain begins. Parameters are fields of AudioInFunction."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Any, Protocol

from ..audio.checks import DEVICE_PARAMETERS, check_device_setting
from ..base.errors import BadGoal
from ..base.field_checks import require_known

MICROPHONES = ("left", "right", "front", "rear")
"""In the order in which NAOqi has them in recordings."""
ONE_CHANNEL, ALL_CHANNELS = 16000, 48000
"""Rates in Hz of recordings of one microphone, and of all."""
CHANNELS = f"one of {', '.join(MICROPHONES)} at {ONE_CHANNEL} Hz, or all of them at {ALL_CHANNELS} Hz"
DEFAULT_MICROPHONE = "front"
FILE_TYPES = ("wav", "ogg")
PHRASES = "at least one word or phrase"
PHRASES_OR_SET = f"{PHRASES}, here or by setVocabulary before"
PHRASE = "words of letters, digits, apostrophes, hyphens, with blanks in between"
LONGEST_PHRASE = 200
# What grammars of speech recognisers are written with, and what nobody can say.
STRANGE = re.compile(r"[<>|{}\[\]()*+=;:#$%^~_@\"/\\\x00-\x1f\x7f]")
SENSES = {"speech": "ALSpeechRecognition", "detection": "ALSoundDetection", "localization": "ALSoundLocalization"}
"""What hears, and its NAOqi module."""


class KnowsLanguages(Protocol):
    """The module, as far as the checks need it."""

    vocabulary_is_set: bool
    paused: bool
    recording_runs: bool

    def languages(self) -> Sequence[str]:
        """Languages that the robot recognises."""
        ...

    def require_new_file(self, path: str, overwrite: bool) -> None:
        """Check that no file is replaced unasked."""
        ...


def require_phrases(vocabulary: Sequence[str]) -> list[str]:
    """Words and phrases that can be said, at least one, without blanks around them."""
    if not vocabulary:
        raise BadGoal("vocabulary", [], PHRASES, problem="it is empty")
    return [_phrase(phrase) for phrase in vocabulary]


def _phrase(phrase: str) -> str:
    bare = " ".join(phrase.split())
    if not bare:
        raise BadGoal("vocabulary", phrase, PHRASE, problem="there is an empty phrase in it")
    if len(bare) > LONGEST_PHRASE:
        problem = f"{bare[:20]!r}... is too long"
        raise BadGoal("vocabulary", phrase, f"phrases of up to {LONGEST_PHRASE} characters", problem=problem)
    strange = STRANGE.search(bare)
    if strange or any(unicodedata.category(character) in ("Cc", "Cs", "Co", "Cn", "So") for character in bare):
        what = f"{strange.group()!r} in {bare!r}" if strange else f"a character of {bare!r}"
        raise BadGoal("vocabulary", phrase, PHRASE, problem=f"{what} cannot be said")
    if not any(character.isalnum() for character in bare):
        raise BadGoal("vocabulary", phrase, PHRASE, problem=f"there is nothing to say in {bare!r}")
    return bare


def recording_format(rate: int, channels: Sequence[str]) -> tuple[int, list[str]]:
    """Rate in Hz and microphones of a recording, in NAOqi's order.

    The robot records one microphone at 16000 Hz, or all at 48000 Hz.
    """
    if not channels:
        channels = MICROPHONES if rate == ALL_CHANNELS else (DEFAULT_MICROPHONE,)
    wanted = {1: ONE_CHANNEL, len(MICROPHONES): ALL_CHANNELS}.get(len(channels))
    if wanted is None or rate not in (0, wanted):
        at = f" at {rate} Hz" if rate else ""
        raise BadGoal("channels", list(channels), CHANNELS, problem=f"{len(channels)} channel(s){at}")
    return wanted, [name for name in MICROPHONES if name in channels]


def recording_file(name: str, file_type: str) -> tuple[str, str]:
    """Name of a recording and what kind of file it is: wav or ogg."""
    path, wanted = name.strip(), file_type.strip()
    kind = PurePosixPath(path).suffix.lower()[1:]
    if wanted and wanted != kind:
        raise BadGoal("file_type", file_type, f"{kind}, as the file's name ends", problem=f"{path!r} is no {wanted}")
    return path, kind


# Checks of functions


def check_recording_begin(
    self: KnowsLanguages,
    str_param: str,
    rate: int,
    channels: Sequence[str],
    file_type: str,
    overwrite: bool,
    context: dict[str, Any],
) -> None:
    """A file that is new or may be replaced, of its type, a format, and no recording that runs."""
    path, _ = recording_file(str_param, file_type)
    self.require_new_file(path, overwrite)
    recording_format(rate, channels)
    if context.get("recording", self.recording_runs):
        problem = "a recording of this server runs already"
        raise BadGoal("function", "startRecording", "stopRecording comes first", problem=problem)
    context["recording"] = True


def check_recording_end(_self: object, context: dict[str, Any]) -> None:
    """Nothing can be wrong; later functions of the chain may record."""
    context["recording"] = False


def check_record(
    self: KnowsLanguages,
    str_param: str,
    rate: int,
    channels: Sequence[str],
    file_type: str,
    overwrite: bool,
    context: dict[str, Any],
) -> None:
    """As startRecording; later functions of the chain may record."""
    check_recording_begin(self, str_param, rate, channels, file_type, overwrite, context)
    context["recording"] = False


def check_vocabulary(_self: object, context: dict[str, Any]) -> None:
    """Nothing can be wrong; later functions of the chain may recognise the words."""
    context["vocabulary"] = True


def check_recognition(self: KnowsLanguages, vocabulary: Sequence[str], context: dict[str, Any]) -> None:
    """Words and phrases here, or those of setVocabulary."""
    if not vocabulary and not context.get("vocabulary", self.vocabulary_is_set):
        raise BadGoal("vocabulary", [], PHRASES_OR_SET, problem="it is empty")


def check_pause(_self: object, context: dict[str, Any]) -> None:
    """Nothing can be wrong; later functions of the chain would hear nothing."""
    context["paused"] = True


def check_resume(_self: object, context: dict[str, Any]) -> None:
    """Nothing can be wrong; later functions of the chain hear again."""
    context["paused"] = False


def check_listen(self: KnowsLanguages, vocabulary: Sequence[str], str_param: str, context: dict[str, Any]) -> None:
    """Words and phrases, no pause, and a language that the robot knows if one is named."""
    check_recognition(self, vocabulary, context)
    if context.get("paused", self.paused):
        raise BadGoal("function", "listen", "resume comes first", problem="the recognition is paused")
    if str_param.strip():
        check_language(self, str_param)


def check_language(self: KnowsLanguages, str_param: str) -> None:
    """A language that the robot recognises."""
    require_known("str_param", str_param, self.languages(), "language that the robot recognises")


def check_setting(_self: object, str_param: str, values: Sequence[float]) -> None:
    """A value that the parameter may have, where it is one of the sound card; others the robot knows."""
    name = str_param.strip()
    if name in DEVICE_PARAMETERS:
        check_device_setting(_self, name, values)
