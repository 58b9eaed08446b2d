"""Settings of speech and recognition: parameters of nao_speech, old and new. No ROS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

SEPARATOR = "/"
ROBOTS_OWN = -1
"""Volume that leaves the robot's own."""
FULL_VOLUME = 100
FORMER_NAMES = {
    "audio_expression": "enable_audio_expression",
    "visual_expression": "enable_visual_expression",
    "word_spotting": "enable_word_spotting",
}
"""Parameter -> its name in the first versions of nao_speech."""


@dataclass(frozen=True)
class SpeechSettings:
    """Settings of speech and recognition; `PARAMETERS` of nao_speech describes them."""

    voice: str = ""  # empty: the robot's own
    language: str = ""  # empty: the robot's own
    volume: float | None = None  # 0 to 1; None: the robot's own
    vocabulary: tuple[str, ...] = ()
    audio_expression: bool = True
    visual_expression: bool = True
    word_spotting: bool = False


def from_config(config: Mapping[str, Any]) -> SpeechSettings:
    """Settings from the values of the parameters: volume in percent or -1, vocabulary as "yes / no"."""
    volume = config["volume"]
    return SpeechSettings(
        voice=config["voice"].strip(),
        language=config["language"].strip(),
        volume=None if volume < 0 else volume / FULL_VOLUME,
        vocabulary=split_vocabulary(config["vocabulary"]),
        audio_expression=config["audio_expression"],
        visual_expression=config["visual_expression"],
        word_spotting=config["word_spotting"],
    )


def given_parameters(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Private parameters that are set, in the form of today; raises NaoError for a wrong value.

    The first versions of nao_speech had the volume as a share of 1, the vocabulary as a list, and longer names for the
    switches: all of that is accepted.
    """
    given: dict[str, Any] = {}
    for name in ("voice", "language"):
        if name in parameters:
            given[name] = _checked(name, parameters[name], str, "a text")
    if "volume" in parameters:
        given["volume"] = percent(parameters["volume"])
    if "vocabulary" in parameters:
        given["vocabulary"] = _vocabulary(parameters["vocabulary"])
    for name, former in FORMER_NAMES.items():
        for each in (name, former):  # the node takes former names away when it has read them: one there is new
            if each in parameters:
                given[name] = _checked(each, parameters[each], bool, "true or false")
    return given


def percent(volume: Any) -> int:
    """Volume in percent, or -1 for the robot's own.

    Takes an integer in percent, or a float as a share of 1; raises NaoError for anything else.
    """
    if isinstance(volume, float) and 0.0 <= volume <= 1.0:
        return round(FULL_VOLUME * volume)
    whole = isinstance(volume, int) or (isinstance(volume, float) and volume.is_integer())
    if whole and not isinstance(volume, bool) and ROBOTS_OWN <= volume <= FULL_VOLUME:
        return int(volume)
    raise NaoError(f"~volume is {volume!r}: 0 to 100 %, 0.0 to 1.0, or -1 for the robot's own")


def split_vocabulary(text: str) -> tuple[str, ...]:
    """Words and phrases of "yes / no / good morning"."""
    return tuple(word.strip() for word in text.split(SEPARATOR) if word.strip())


def join_vocabulary(words: Sequence[str]) -> str:
    """The inverse of `split_vocabulary`; raises NaoError if a word is empty or holds the separator."""
    for word in words:
        if SEPARATOR in word:
            raise NaoError(f"field words: {word!r} holds {SEPARATOR!r}, which separates words")
        if not word.strip():
            raise NaoError(f"field words: {word!r} is empty")
    return f" {SEPARATOR} ".join(word.strip() for word in words)


def _vocabulary(value: Any) -> str:
    if isinstance(value, str):
        return join_vocabulary(split_vocabulary(value))
    if isinstance(value, (list, tuple)) and all(isinstance(word, str) for word in value):
        return join_vocabulary(value)
    raise NaoError(f"~vocabulary is {value!r}: a text as 'yes / no', or a list of texts")


def _checked(name: str, value: Any, kind: type, allowed: str) -> Any:
    if not isinstance(value, kind):
        raise NaoError(f"~{name} is {value!r}: {allowed}")
    return value
