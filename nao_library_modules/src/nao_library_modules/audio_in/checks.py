"""Checks of the hearing functions, made before a chain begins. Parameters are fields of AudioInFunction."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Any, Protocol

from ..audio.checks import DEVICE_PARAMETERS, check_device_setting, require_file
from ..base.errors import BadGoal
from ..base.field_checks import require_known, require_text, require_within
from ..base.limits import limit

MICROPHONES = ("left", "right", "front", "rear")
"""In the order in which NAOqi has them in recordings."""
ONE_CHANNEL, ALL_CHANNELS = 16000, 48000
"""Rates in Hz of recordings of one microphone, and of all."""
DEFAULT_MICROPHONE = "front"
FILE_TYPES = ("wav", "ogg")
TIMEOUT, LENGTH, SHARE, SETTING = limit("timeout"), limit("recording"), limit("share"), limit("setting")
LONGEST = TIMEOUT.highest
"""s, of waits."""
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


def require_timeout(timeout: float) -> None:
    """Check how long to wait, s; 0 for the default."""
    require_within("timeout", timeout, TIMEOUT, f"up to {LONGEST:g} s, or 0 for the default")


def require_confidence(confidence: float) -> None:
    """Check the least confidence that counts."""
    require_within("confidence", confidence, SHARE)


def require_phrases(vocabulary: Sequence[str]) -> list[str]:
    """Words and phrases that can be said, at least one, without blanks around them."""
    if not vocabulary:
        raise BadGoal("vocabulary", [], "at least one word or phrase", problem="it is empty")
    return [_phrase(phrase) for phrase in vocabulary]


def _phrase(phrase: str) -> str:
    bare = " ".join(phrase.split())
    allowed = "words of letters, digits, apostrophes, hyphens, with blanks in between"
    if not bare:
        raise BadGoal("vocabulary", phrase, allowed, problem="there is an empty phrase in it")
    if len(bare) > LONGEST_PHRASE:
        problem = f"{bare[:20]!r}... is too long"
        raise BadGoal("vocabulary", phrase, f"phrases of up to {LONGEST_PHRASE} characters", problem=problem)
    strange = STRANGE.search(bare)
    if strange or any(unicodedata.category(character) in ("Cc", "Cs", "Co", "Cn", "So") for character in bare):
        what = f"{strange.group()!r} in {bare!r}" if strange else f"a character of {bare!r}"
        raise BadGoal("vocabulary", phrase, allowed, problem=f"{what} cannot be said")
    if not any(character.isalnum() for character in bare):
        raise BadGoal("vocabulary", phrase, allowed, problem=f"there is nothing to say in {bare!r}")
    return bare


def recording_format(rate: int, channels: Sequence[str]) -> tuple[int, list[str]]:
    """Rate in Hz and microphones of a recording, in NAOqi's order.

    The robot records one microphone at 16000 Hz, or all at 48000 Hz.
    """
    if rate not in (0, ONE_CHANNEL, ALL_CHANNELS):
        raise BadGoal("rate", rate, f"{ONE_CHANNEL}, {ALL_CHANNELS} (Hz), or 0: as the channels need")
    for name in channels:
        if name not in MICROPHONES:
            require_known("channels", name, MICROPHONES, "microphone")
            raise BadGoal("channels", name, f"one of {', '.join(MICROPHONES)}")
    if len(set(channels)) != len(channels):
        raise BadGoal("channels", list(channels), "each microphone once")
    if not channels:
        channels = MICROPHONES if rate == ALL_CHANNELS else (DEFAULT_MICROPHONE,)
    wanted = {1: ONE_CHANNEL, len(MICROPHONES): ALL_CHANNELS}.get(len(channels))
    if wanted is None or rate not in (0, wanted):
        allowed = f"one of {', '.join(MICROPHONES)} at {ONE_CHANNEL} Hz, or all of them at {ALL_CHANNELS} Hz"
        at = f" at {rate} Hz" if rate else ""
        raise BadGoal("channels", list(channels), allowed, problem=f"{len(channels)} channel(s){at}")
    return wanted, [name for name in MICROPHONES if name in channels]


def recording_file(name: str, file_type: str) -> tuple[str, str]:
    """Name of a recording and what kind of file it is: wav or ogg."""
    path = require_file("str_param", name, [f".{kind}" for kind in FILE_TYPES])
    kind = PurePosixPath(path).suffix.lower()[1:]
    if file_type and require_known("file_type", file_type, FILE_TYPES, "type of recordings") != kind:
        raise BadGoal("file_type", file_type, f"{kind}, as the file's name ends", problem=f"{path!r} is no {file_type}")
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
    """A file that is new or may be replaced, a format, and no recording that runs."""
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
    duration: float,
    overwrite: bool,
    context: dict[str, Any],
) -> None:
    """As startRecording, and a length."""
    require_within("duration", duration, LENGTH)
    check_recording_begin(self, str_param, rate, channels, file_type, overwrite, context)
    context["recording"] = False


def check_input_file(_self: object, str_param: str) -> None:
    """A sound file."""
    require_file("str_param", str_param, [".wav", ".ogg", ".flac", ".mp3"])


def check_vocabulary(_self: object, vocabulary: Sequence[str], context: dict[str, Any]) -> None:
    """Words and phrases; later functions of the chain may recognise them."""
    require_phrases(vocabulary)
    context["vocabulary"] = True


def check_recognition(self: KnowsLanguages, vocabulary: Sequence[str], context: dict[str, Any]) -> None:
    """Words and phrases, or those of setVocabulary."""
    if vocabulary:
        require_phrases(vocabulary)
    elif not context.get("vocabulary", self.vocabulary_is_set):
        allowed = "at least one word or phrase, here or by setVocabulary before"
        raise BadGoal("vocabulary", [], allowed, problem="it is empty")


def check_pause(_self: object, context: dict[str, Any]) -> None:
    """Nothing can be wrong; later functions of the chain would hear nothing."""
    context["paused"] = True


def check_resume(_self: object, context: dict[str, Any]) -> None:
    """Nothing can be wrong; later functions of the chain hear again."""
    context["paused"] = False


def check_listen(
    self: KnowsLanguages,
    vocabulary: Sequence[str],
    timeout: float,
    confidence: float,
    str_param: str,
    context: dict[str, Any],
) -> None:
    """Words and phrases, a timeout, a confidence, and a language that the robot knows if one is named."""
    check_recognition(self, vocabulary, context)
    if context.get("paused", self.paused):
        raise BadGoal("function", "listen", "resume comes first", problem="the recognition is paused")
    require_timeout(timeout)
    require_confidence(confidence)
    if str_param.strip():
        check_language(self, str_param)


def check_language(self: KnowsLanguages, str_param: str) -> None:
    """A language that the robot recognises."""
    require_text("str_param", str_param, "a language by NAOqi's name, such as English")
    require_known("str_param", str_param, self.languages(), "language that the robot recognises")


def check_detection(_self: object, timeout: float, confidence: float) -> None:
    """A timeout and a confidence."""
    require_timeout(timeout)
    require_confidence(confidence)


def check_localization(_self: object, timeout: float, confidence: float, duration: float) -> None:
    """A timeout, a confidence, and how long to wait for better ones."""
    check_detection(_self, timeout, confidence)
    check_mean(_self, duration)


def check_sensitivity(_self: object, sensitivity: float, str_param: str) -> None:
    """A sensitivity of something that hears."""
    if not 0.0 < sensitivity <= 1.0:
        raise BadGoal("sensitivity", sensitivity, "above 0 to 1")
    if str_param.strip():
        require_known("str_param", str_param, list(SENSES), "sense")


def check_mean(_self: object, duration: float) -> None:
    """How long to look."""
    require_within("duration", duration, TIMEOUT)


def check_setting(_self: object, str_param: str, values: Sequence[float]) -> None:
    """A parameter and its value; which ones the recognition has the robot knows."""
    name = require_text("str_param", str_param, "the name of a parameter")
    if name in DEVICE_PARAMETERS:
        check_device_setting(_self, name, values)
    if len(values) != 1:
        raise BadGoal("values", list(values), "one number")
    require_within("values", values[0], SETTING)


def check_parameter(_self: object, str_param: str) -> None:
    """A parameter; which ones there are the robot knows."""
    require_text("str_param", str_param, "the name of a parameter")
