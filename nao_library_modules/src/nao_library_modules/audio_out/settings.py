"""Functions for how the robot speaks: voices, languages, parameters, the dictionary."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..audio.fields import DEVICE_PARAMETERS, Revert, check_device_setting
from ..audio.sound_card import NaoAudio, decimal, put_back
from ..base.errors import BadGoal
from ..base.field_checks import require_known
from ..functions.chain import checked_by
from ..functions.parts import Part
from .fields import (
    ALL_PARAMETERS,
    EFFECTS,
    PARAMETERS,
    VOICE_PARAMETERS,
    DeletedTexts,
    Language,
    ParameterNames,
    ParameterValues,
    Preference,
    ReadParameter,
    SetParameter,
    Voice,
    VoiceOfLanguage,
    Word,
    WordTexts,
    range_of,
)
from .synthesiser import SPEECH, Synthesiser


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
