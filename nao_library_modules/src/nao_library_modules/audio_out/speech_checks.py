"""Checks of the functions that speak, made before a chain begins. Parameters are fields of AudioOutFunction."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

from ..audio.checks import DEVICE_PARAMETERS, check_device_setting
from ..base.errors import BadGoal
from ..base.field_checks import require_known
from .fields import ALL_PARAMETERS, EFFECTS, PARAMETERS, VOICE_PARAMETERS, range_of
from .voices import Voices


class Speaks(Protocol):
    """The module, as far as the checks need it."""

    voices: Voices
    require_new_file: Callable[[str, bool], None]


def _require_no_changes(background: bool, **fields: object) -> None:
    """What is set for one text must be put back at its end: somebody has to wait for that."""
    for field, value in fields.items():
        if background and value:
            raise BadGoal(field, value, "nothing, for a text in the background; or set it before")


def check_spoken(self: Speaks, language: str, voice: str) -> None:
    """A language and a voice of the robot, or none."""
    if language.strip():
        self.voices.require_language("language", language)
    if voice.strip():
        self.voices.require_voice("voice", voice)


def check_say(self: Speaks, language: str, voice: str, volume: float, background: bool) -> None:
    """How a text is spoken."""
    _require_no_changes(background, voice=voice.strip(), volume=volume)
    check_spoken(self, language, voice)


def check_animated_say(self: Speaks, language: str, voice: str, volume: float, background: bool) -> None:
    """How a text is spoken."""
    _require_no_changes(background, language=language.strip(), voice=voice.strip(), volume=volume)
    check_spoken(self, language, voice)


def check_say_to_file(self: Speaks, file_name: str, language: str, voice: str, overwrite: bool) -> None:
    """How a text is spoken, and that it replaces no file unasked."""
    self.require_new_file(file_name.strip(), overwrite)
    check_spoken(self, language, voice)


def check_voice(self: Speaks, str_param: str) -> None:
    """A voice of the robot."""
    self.voices.require_voice("str_param", str_param.strip())


def check_language(self: Speaks, str_param: str) -> None:
    """A language that the robot speaks."""
    self.voices.require_language("str_param", str_param.strip())


def check_default_voice(self: Speaks, str_param: str, voice: str) -> None:
    """A language and a voice of the robot."""
    check_language(self, str_param)
    self.voices.require_voice("voice", voice.strip())


def check_parameters(self: object, str_param: str, names: Sequence[str], values: Sequence[float]) -> None:
    """A value for each parameter of the voice; or, named in `str_param`, for the one of the sound card."""
    if not names and str_param.strip() in DEVICE_PARAMETERS:
        check_device_setting(self, str_param, values)
        return
    _require_some(names)
    if len(values) != len(names):
        raise BadGoal("values", list(values), f"{len(names)}: one for each of {', '.join(names)}")
    for name, value in zip(map(str.strip, names), values):
        lowest, highest = PARAMETERS[name]
        off = name in EFFECTS and value == 0.0
        if not (off or math.isfinite(value) and lowest <= value <= highest):
            raise BadGoal("values", value, f"{name} is {range_of(name)}")


def check_parameter_names(_self: object, str_param: str, names: Sequence[str]) -> None:
    """Parameters of the voice; or, named in `str_param`, one of it or of the sound card."""
    if names or not str_param.strip():
        _require_some(names)
    else:
        require_known("str_param", str_param, ALL_PARAMETERS, "parameter")


def _require_some(names: Sequence[str]) -> None:
    if not names:
        raise BadGoal("names", [], VOICE_PARAMETERS, problem="nothing is named")
