"""Part of ALTextToSpeech: the voice that clients have chosen, and how it speaks."""

from __future__ import annotations

import json
import logging
import threading
from typing import Any

from nao_sim_bridge.base.config import LARGEST_FILE, read_bounded
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.arguments import limited, number, one_of
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.speech import parameters
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.engines import Engines
from nao_sim_bridge.speech.parameters import Pronunciations
from nao_sim_bridge.speech.tags import TAG
from nao_sim_bridge.speech.voices import load_voices

log = logging.getLogger("nao_sim.speech")

DEFAULT_VOLUME = 1.0
PREFERENCE = "ALTextToSpeech_Voice_{}.json"
PREFERENCE_KEYS = ("language", "voice", "volume", "parameters")


class VoiceSettings:
    """Language, voice, parameters, volume and pronunciations; any thread. The engine says which voices can speak."""

    def __init__(self, engine: Engines, files: ClientFiles) -> None:
        self._voices = load_voices()
        self._engine = engine
        self._files = files
        self._lock = threading.RLock()
        self._language = self._voices.languages[self._voices.default_language]
        self._chosen: dict[str, str] = {}
        self._voice = self._language.voices[0]
        self._volume = DEFAULT_VOLUME
        self._values = parameters.defaults()
        self._pronunciations: dict[str, Pronunciations] = {}

    def style(self, language: str | None = None) -> Style:
        """How a text is spoken from now on, in the chosen language or in another one.

        A BadValue when there is no such language, a SpeechError when its engine is missing.
        """
        with self._lock:
            other = language is not None and language != self._language.name
            name = self._default_voice(language) if other else self._voice
            voice = self._voices.voice(name, self._engine)
            return Style(
                voice,
                parameters.prosody_of(self._values),
                parameters.double_voice_of(self._values),
                self._known(voice.language),
                self._volume,
            )

    # --- languages and voices -------------------------------------------------------------------------------------

    def getAvailableLanguages(self) -> list[str]:
        return self._voices.available_languages(self._engine)

    def getSupportedLanguages(self) -> list[str]:
        return list(self._voices.languages)

    def getLanguageEncoding(self, language: str) -> str:
        languages = self._voices.languages
        return languages[one_of(language, "pLanguage", languages)].encoding

    def locale(self) -> str:
        return self._language.locale

    def getLanguage(self) -> str:
        return self._language.name

    def setLanguage(self, name: str) -> None:
        """Speak another language, in its default voice, at its default speed."""
        with self._lock:
            voice = self._default_voice(name)
            if name != self._language.name:
                self._values[parameters.DEFAULT_SPEED] = parameters.defaults()[parameters.DEFAULT_SPEED]
                self.resetSpeed()
            self._language, self._voice = self._voices.languages[name], voice

    def getAvailableVoices(self) -> list[str]:
        return self._voices.available_voices(self._engine)

    def getVoice(self) -> str:
        return self._voice

    def setVoice(self, name: str) -> None:
        """Speak in another voice, and in its language."""
        with self._lock:
            voice = self._voices.voice(name, self._engine)
            if voice.language != self._language.name:
                self.setLanguage(voice.language)
            self._voice = name

    def setLanguageDefaultVoice(self, language: str, voice: str) -> None:
        """Which voice a language is spoken in when it is chosen; at once when it is spoken now."""
        with self._lock:
            voices = self._voices.language(language, self._engine).voices
            if voice not in voices:
                raise BadValue("Voice", voice, f"a voice of {language}: {', '.join(voices)}")
            self._voices.voice(voice, self._engine)
            self._chosen[language] = voice
            if language == self._language.name:
                self._voice = voice

    # --- volume and parameters ------------------------------------------------------------------------------------

    def getVolume(self) -> float:
        return self._volume

    def setVolume(self, volume: Any) -> None:
        self._volume = limited(volume, "volume", 0.0, 1.0)

    def getParameter(self, name: str) -> float:
        return self._values[parameters.known(name)]

    def setParameter(self, name: str, value: Any) -> None:
        """Change a voice parameter; a new default speed is the speed from now on, too."""
        checked = parameters.checked(name, number(value, parameters.known(name)))
        with self._lock:
            self._values[name] = checked
            if name == parameters.DEFAULT_SPEED:
                self.resetSpeed()

    def resetSpeed(self) -> None:
        with self._lock:
            self._values[parameters.SPEED] = self._values[parameters.DEFAULT_SPEED]

    def reset(self) -> None:
        """Parameters, volume and the voice of the language as at the start."""
        with self._lock:
            self._values = parameters.defaults()
            self._volume = DEFAULT_VOLUME
            self._voice = self._default_voice(self._language.name)

    # --- pronunciations -------------------------------------------------------------------------------------------

    def addToDictionary(self, *entry: str) -> bool:
        """(word, pronunciation), or (type, word, priority, phonetic, accent) of Japanese.

        False for phonetic alphabets, which no engine here reads.
        """
        word, spoken = entry if len(entry) == 2 else (entry[1], entry[3])
        if not word.strip():
            raise BadValue("word", word, "a word")
        if not spoken.strip() or TAG.search(spoken):
            return False
        with self._lock:
            known, most = self._known(self._language.name), load_sizes().speech.dictionary_words
            if len(known.entries) >= most and not known.knows(word.strip()):
                raise NaoqiError(
                    f"the dictionary has {most} words, which is the most allowed; deleteFromDictionary makes room"
                )
            self._pronunciations[self._language.name] = known.with_entry(word.strip(), spoken.strip())
        return True

    def deleteFromDictionary(self, *entry: str) -> bool:
        """(word), or (type, word) of Japanese; False when it was not in the dictionary."""
        word = entry[-1].strip()
        with self._lock:
            known = self._known(self._language.name)
            self._pronunciations[self._language.name] = known.without(word)
            return known.knows(word)

    def showDictionary(self) -> None:
        entries = self._known(self._language.name).entries
        log.info("dictionary of %s, %d words", self._language.name, len(entries))
        for word, spoken in entries:
            log.info("  %s is spoken %s", word, spoken)

    def _known(self, language: str) -> Pronunciations:
        return self._pronunciations.get(language, Pronunciations())

    # --- preferences ----------------------------------------------------------------------------------------------

    def loadVoicePreference(self, name: str) -> None:
        """Take language, voice, volume and parameters from a JSON file, each if it is there; all or nothing.

        A NaoqiError when the file is not what it should be.
        """
        path = self._files.to_read(PREFERENCE.format(name))
        try:
            wanted = json.loads(read_bounded(path, LARGEST_FILE))
        except (OSError, ValueError, RecursionError) as error:
            raise NaoqiError(f"voice preference {path.name} cannot be read: {error}") from error
        if not isinstance(wanted, dict) or not set(wanted) <= set(PREFERENCE_KEYS):
            raise NaoqiError(f"voice preference {path.name} may have {', '.join(PREFERENCE_KEYS)} and nothing else")
        with self._lock:
            before = dict(self._values), self._language, self._voice, self._volume
            try:
                self._take(wanted)
            except Exception:
                self._values, self._language, self._voice, self._volume = before
                raise

    def _take(self, wanted: dict[str, Any]) -> None:
        for key, take in (("language", self.setLanguage), ("voice", self.setVoice), ("volume", self.setVolume)):
            if key in wanted:
                take(wanted[key])
        if not isinstance(wanted.get("parameters", {}), dict):
            raise BadValue("parameters", wanted["parameters"], "an object of names and numbers")
        for name, value in wanted.get("parameters", {}).items():
            self.setParameter(name, value)

    def _default_voice(self, language: str | None) -> str:
        """The voice of a language: the chosen one, or the first that can speak."""
        spoken = self._voices.language(language, self._engine)
        available = self._voices.available_voices(self._engine)
        chosen = self._chosen.get(spoken.name)
        return chosen or next(name for name in spoken.voices if name in available)
