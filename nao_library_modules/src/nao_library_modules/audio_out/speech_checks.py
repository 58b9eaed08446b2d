"""Checks of the functions that speak, made before a chain begins. Parameters are fields of AudioOutFunction."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

from ..audio.checks import DEVICE_PARAMETERS, check_device_setting, require_file
from ..base.errors import BadGoal
from ..base.field_checks import require_known, require_number, require_text, require_within
from ..base.limits import limit
from .voices import Voices

SPEED, PITCH = limit("speech rate")[:2], limit("speech pitch")[:2]
"""%, 100 is normal."""
BODY_LANGUAGE = ("disabled", "random", "contextual")
# Ranges of the robot; the effects are off with 0.
PARAMETERS: dict[str, tuple[float, float]] = {
    "speed": SPEED,
    "defaultVoiceSpeed": SPEED,
    "pitch": PITCH,
    "volume": (0.0, 100.0),
    "pitchShift": (1.0, 4.0),
    "doubleVoice": (1.0, 4.0),
    "doubleVoiceLevel": (0.0, 4.0),
    "doubleVoiceTimeShift": (0.0, 0.5),
    "enableCompression": (0.0, 1.0),
}
EFFECTS = ("pitchShift", "doubleVoice")


class Speaks(Protocol):
    """The module, as far as the checks need it."""

    voices: Voices
    require_new_file: Callable[[str, bool], None]


def require_volume(volume: float) -> float:
    """A volume 0..1."""
    return require_within("volume", volume, limit("share"))


def _check_speech(
    self: Speaks, str_param: str, language: str, voice: str, volume: float, speed: float, pitch: float
) -> None:
    """A text, and how it is spoken."""
    require_text("str_param", str_param, "the text to say")
    require_volume(volume)
    for field, value, (lowest, highest) in (("speed", speed, SPEED), ("pitch", pitch, PITCH)):
        if value != 0.0:
            require_number(field, value, lowest, highest, f"{lowest:g}..{highest:g} %, or 0 for the robot's own")
    if language.strip():
        self.voices.require_language("language", language)
    if voice.strip():
        self.voices.require_voice("voice", voice)


def _require_no_changes(background: bool, **fields: object) -> None:
    """What is set for one text must be put back at its end: somebody has to wait for that."""
    for field, value in fields.items():
        if background and value:
            raise BadGoal(field, value, "nothing, for a text in the background; or set it before")


def check_say(
    self: Speaks,
    str_param: str,
    language: str,
    voice: str,
    volume: float,
    speed: float,
    pitch: float,
    background: bool,
) -> None:
    """A text, and how it is spoken."""
    _require_no_changes(background, voice=voice.strip(), volume=volume)
    _check_speech(self, str_param, language, voice, volume, speed, pitch)


def check_animated_say(
    self: Speaks,
    str_param: str,
    language: str,
    voice: str,
    volume: float,
    speed: float,
    pitch: float,
    background: bool,
    body_language: str,
) -> None:
    """A text, how it is spoken, and the gestures to it."""
    _require_no_changes(background, language=language.strip(), voice=voice.strip(), volume=volume)
    _check_speech(self, str_param, language, voice, volume, speed, pitch)
    if body_language.strip():
        require_known("body_language", body_language, BODY_LANGUAGE)


def check_say_and_play(
    self: Speaks, str_param: str, language: str, voice: str, volume: float, speed: float, pitch: float
) -> None:
    """A text, and how it is spoken."""
    _check_speech(self, str_param, language, voice, volume, speed, pitch)


def check_say_to_file(
    self: Speaks,
    str_param: str,
    file_name: str,
    language: str,
    voice: str,
    volume: float,
    speed: float,
    pitch: float,
    overwrite: bool,
) -> None:
    """A text, how it is spoken, and the file to write."""
    require_file("file_name", file_name, (".wav",))
    self.require_new_file(file_name.strip(), overwrite)
    _check_speech(self, str_param, language, voice, volume, speed, pitch)


def check_voice(self: Speaks, str_param: str) -> None:
    """A voice of the robot."""
    self.voices.require_voice("str_param", require_text("str_param", str_param, "the name of a voice"))


def check_language(self: Speaks, str_param: str) -> None:
    """A language that the robot speaks."""
    self.voices.require_language("str_param", require_text("str_param", str_param, "the name of a language"))


def check_default_voice(self: Speaks, str_param: str, voice: str) -> None:
    """A language and a voice of the robot."""
    check_language(self, str_param)
    self.voices.require_voice("voice", require_text("voice", voice, "the name of a voice"))


def check_word(_self: object, str_param: str, texts: Sequence[str]) -> None:
    """A word, and how it is spoken; or the four arguments of Japanese after the type."""
    require_text("str_param", str_param, "the word")
    if len(texts) not in (1, 4) or not all(text.strip() for text in texts):
        raise BadGoal(
            "texts", list(texts), "how it is spoken; of a Japanese type (str_param): word, priority, phonetic, accent"
        )


def check_deletion(_self: object, str_param: str, texts: Sequence[str]) -> None:
    """A word; of a Japanese type (`str_param`) the word is in `texts`."""
    require_text("str_param", str_param, "the word")
    if len(texts) > 1:
        raise BadGoal("texts", list(texts), "nothing; or, of a Japanese type (str_param), the word")


def check_preference(_self: object, str_param: str) -> None:
    """Name of a voice preference."""
    require_text("str_param", str_param, "the name of a voice preference")


def check_parameters(self: object, str_param: str, names: Sequence[str], values: Sequence[float]) -> None:
    """Parameters of the voice, a value each; or, named in `str_param`, the one of the sound card."""
    if not names and str_param.strip() in DEVICE_PARAMETERS:
        check_device_setting(self, str_param, values)
        return
    _require_parameters(names)
    if len(values) != len(names):
        raise BadGoal("values", list(values), f"{len(names)}: one for each of {', '.join(names)}")
    for name, value in zip(names, values):
        lowest, highest = PARAMETERS[name.strip()]
        if name.strip() in EFFECTS and value == 0.0:
            continue  # off
        off = "0 (off) or " if name.strip() in EFFECTS else ""
        if not (math.isfinite(value) and lowest <= value <= highest):
            raise BadGoal("values", value, f"{name.strip()} is {off}{lowest:g}..{highest:g}")


def check_parameter_names(_self: object, str_param: str, names: Sequence[str]) -> None:
    """Parameters of the voice; or, named in `str_param`, of the sound card."""
    if names or not str_param.strip():
        _require_parameters(names)
    else:
        require_known("str_param", str_param, (*PARAMETERS, *DEVICE_PARAMETERS), "parameter")


def _require_parameters(names: Sequence[str]) -> None:
    if not names:
        raise BadGoal("names", [], f"one or more of {', '.join(PARAMETERS)}", problem="nothing is named")
    for name in names:
        require_known("names", name, tuple(PARAMETERS), "parameter of the voice")


def check_body_language(_self: object, body_language: str) -> None:
    """A mode of body language."""
    require_known("body_language", body_language, BODY_LANGUAGE)


def check_tag(_self: object, str_param: str, texts: Sequence[str]) -> None:
    """A tag, and what belongs to it."""
    require_text("str_param", str_param, "the tag")
    if not texts or not all(text.strip() for text in texts):
        raise BadGoal("texts", list(texts), "the words or animations of the tag, one or more")


def check_package(_self: object, str_param: str) -> None:
    """Name of a package of animations."""
    require_text("str_param", str_param, "the name of a package of animations")
