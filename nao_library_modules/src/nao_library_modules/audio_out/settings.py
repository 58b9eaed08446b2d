"""Functions that set and tell how the robot speaks: voices, languages, parameters, the dictionary."""

from __future__ import annotations

from typing import Any

from ..audio.checks import DEVICE_PARAMETERS
from ..audio.fields import Revert
from ..audio.sound_card import NaoAudio, decimal
from ..functions.chain import checked_by
from .fields import (
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
)
from .speech_checks import check_default_voice, check_language, check_parameter_names, check_parameters, check_voice
from .voices import SPEECH, Voices


class VoiceFunctions(NaoAudio):
    """Settings of ALTextToSpeech. Parameters are fields of AudioOutFunction.

    Attributes:
        voices: Voices and languages of the robot.
    """

    voices: Voices

    # Voices and languages

    @checked_by(check_voice)
    def set_voice(self, str_param: Voice, revert: Revert) -> None:
        """Change the voice."""
        if revert:
            self._put_back_voice()
        self.speech("setVoice", str_param.strip())

    def get_voice(self) -> str:
        """Voice that speaks."""
        return str(self.speech("getVoice"))

    def get_available_voices(self) -> list[str]:
        """Voices that the robot has."""
        return list(self.speech("getAvailableVoices"))

    @checked_by(check_language)
    def set_language(self, str_param: Language, revert: Revert) -> None:
        """Change the language."""
        if revert:
            self._put_back_voice()
        self.speech("setLanguage", str_param.strip())

    def get_language(self) -> str:
        """Language that is spoken."""
        return str(self.speech("getLanguage"))

    def get_available_languages(self) -> list[str]:
        """Languages that the robot speaks."""
        return list(self.speech("getAvailableLanguages"))

    def get_supported_languages(self) -> list[str]:
        """Languages that there are, installed or not."""
        return list(self.speech("getSupportedLanguages"))

    @checked_by(check_default_voice)
    def set_language_default_voice(self, str_param: Language, voice: VoiceOfLanguage) -> None:
        """Choose the voice that a language is spoken with."""
        self.speech("setLanguageDefaultVoice", str_param.strip(), voice.strip())

    def locale(self) -> str:
        """Locale of the language, as en_US."""
        return str(self.speech("locale"))

    # Parameters

    @checked_by(check_parameters)
    def set_parameter(
        self, str_param: SetParameter, names: ParameterNames, values: ParameterValues, revert: Revert
    ) -> None:
        """Set parameters of the voice; or outputSampleRate of the sound card, named in `str_param`."""
        if not names:
            self.set_device_parameter(str_param, values, revert)
            return
        for name, value in zip(names, values):
            if revert:
                self.put_back(SPEECH, "setParameter", name.strip(), decimal(self.speech("getParameter", name.strip())))
            self.speech("setParameter", name.strip(), float(value))

    @checked_by(check_parameter_names)
    def get_parameter(self, str_param: ReadParameter, names: ParameterNames) -> list[float]:
        """Parameters of the voice; or one, also of the sound card, named in `str_param`."""
        if not names and str_param.strip() in DEVICE_PARAMETERS:
            return [self.get_device_parameter(str_param)]
        return [decimal(self.speech("getParameter", name.strip())) for name in names or [str_param]]

    def reset_speed(self) -> None:
        """Speak at the usual speed again."""
        self.speech("resetSpeed")

    def reset(self) -> None:
        """Speak as the robot usually does again."""
        self.speech("reset")

    def load_voice_preference(self, str_param: Preference) -> None:
        """Set the parameters of the voice as a preference of the robot says."""
        self.speech("loadVoicePreference", str_param.strip())

    # The dictionary

    def add_to_dictionary(self, str_param: Word, texts: WordTexts) -> bool:
        """Teach how a word is spoken."""
        return bool(self.speech("addToDictionary", str_param.strip(), *texts))

    def delete_from_dictionary(self, str_param: Word, texts: DeletedTexts) -> bool:
        """Forget how a word is spoken."""
        return bool(self.speech("deleteFromDictionary", str_param.strip(), *texts))

    def show_dictionary(self) -> None:
        """Have the robot write the words that it was taught to its log."""
        self.speech("showDictionary")

    # For library functions

    def speech(self, method: str, *args: Any) -> Any:
        """Call ALTextToSpeech; preemption ends the call."""
        return self.call(self.robot.proxy(SPEECH), method, *args)

    # Inside

    def _put_back_voice(self) -> None:
        language, voice = self.speech("getLanguage"), self.speech("getVoice")
        self.put_back(SPEECH, "setVoice", voice)
        self.put_back(SPEECH, "setLanguage", language)  # the last one left is done first

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
