"""The voice that clients have chosen, and how it speaks."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

from nao_sim_bridge.base.bounded_files import read_bounded
from nao_sim_bridge.base.config import LARGEST_FILE
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.speech import parameters
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.parameters import Pronunciations
from nao_sim_bridge.speech.speech import Engine
from nao_sim_bridge.speech.tags import TAG
from nao_sim_bridge.speech.voices import Language, load_voices

DEFAULT_VOLUME = 1.0
PREFERENCE_KEYS = ("language", "voice", "volume", "parameters")


class VoiceSettings:
    """Language, voice, parameters, volume and pronunciations. Any thread may call anything.

    Attributes:
        voices: All that the robot knows.

    Args:
        engine: Who says which of them can speak.
    """

    def __init__(self, engine: Engine) -> None:
        self.voices = load_voices()
        self._engine = engine
        self._lock = threading.RLock()
        self._language = self.voices.languages[self.voices.default_language]
        self._chosen: dict[str, str] = {}
        self._voice = self._language.voices[0]
        self._volume = DEFAULT_VOLUME
        self._values = parameters.defaults()
        self._pronunciations: dict[str, Pronunciations] = {}

    @property
    def language(self) -> Language:
        """What is spoken."""
        return self._language

    @property
    def voice(self) -> str:
        """Who speaks."""
        return self._voice

    @property
    def volume(self) -> float:
        """0 to 1."""
        return self._volume

    def style(self, language: str | None = None) -> Style:
        """How a text is spoken from now on, in the chosen language or in another one.

        Raises:
            BadValue: There is no such language.
            SpeechError: Its engine is missing.
        """
        with self._lock:
            other = language is not None and language != self._language.name
            name = self._default_voice(language) if other else self._voice
            voice = self.voices.voice(name, self._engine)
            return Style(
                voice,
                parameters.prosody_of(self._values),
                parameters.double_voice_of(self._values),
                self._pronunciations.get(voice.language, Pronunciations()),
                self._volume,
            )

    def set_language(self, name: str) -> None:
        """Speak another language, in its default voice, at its default speed."""
        with self._lock:
            voice = self._default_voice(name)
            if name != self._language.name:
                self._values[parameters.DEFAULT_SPEED] = parameters.defaults()[parameters.DEFAULT_SPEED]
                self.reset_speed()
            self._language, self._voice = self.voices.languages[name], voice

    def set_voice(self, name: str) -> None:
        """Speak in another voice, and in its language."""
        with self._lock:
            voice = self.voices.voice(name, self._engine)
            if voice.language != self._language.name:
                self.set_language(voice.language)
            self._voice = name

    def set_default_voice(self, language: str, voice: str) -> None:
        """Which voice a language is spoken in when it is chosen; at once when it is spoken now."""
        with self._lock:
            voices = self.voices.language(language, self._engine).voices
            if voice not in voices:
                raise BadValue("Voice", voice, f"a voice of {language}: {', '.join(voices)}")
            self.voices.voice(voice, self._engine)
            self._chosen[language] = voice
            if language == self._language.name:
                self._voice = voice

    def set_volume(self, volume: Any) -> None:
        """0 to 1."""
        self._volume = number(volume, "volume", 0.0, 1.0)

    def parameter(self, name: str) -> float:
        """Value of a voice parameter."""
        return self._values[parameters.known(name)]

    def set_parameter(self, name: str, value: Any) -> None:
        """Change a voice parameter; a new default speed is the speed from now on, too."""
        checked = parameters.checked(name, number(value, parameters.known(name)))
        with self._lock:
            self._values[name] = checked
            if name == parameters.DEFAULT_SPEED:
                self.reset_speed()

    def reset_speed(self) -> None:
        """Speed back to its default."""
        with self._lock:
            self._values[parameters.SPEED] = self._values[parameters.DEFAULT_SPEED]

    def reset(self) -> None:
        """Parameters, volume and the voice of the language as at the start."""
        with self._lock:
            self._values = parameters.defaults()
            self._volume = DEFAULT_VOLUME
            self._voice = self._default_voice(self._language.name)

    # --- pronunciations -------------------------------------------------------------------------------------------

    def add_pronunciation(self, word: str, spoken: str) -> bool:
        """Speak a word of the language in another way; False for phonetic alphabets, which no engine here reads."""
        if not word.strip():
            raise BadValue("word", word, "a word")
        if not spoken.strip() or TAG.search(spoken):
            return False
        with self._lock:
            known, most = (
                self._pronunciations.get(self._language.name, Pronunciations()),
                load_sizes().speech.dictionary_words,
            )
            if len(known.entries) >= most and not known.knows(word.strip()):
                raise NaoqiError(
                    f"the dictionary has {most} words, which is the most allowed; deleteFromDictionary makes room"
                )
            self._pronunciations[self._language.name] = known.with_entry(word.strip(), spoken.strip())
        return True

    def delete_pronunciation(self, word: str) -> bool:
        """Speak a word as it is written again; False when it was not in the dictionary."""
        with self._lock:
            known = self._pronunciations.get(self._language.name, Pronunciations())
            self._pronunciations[self._language.name] = known.without(word.strip())
            return known.knows(word.strip())

    def pronunciations(self) -> list[tuple[str, str]]:
        """(word as written, word as spoken) of the language."""
        return list(self._pronunciations.get(self._language.name, Pronunciations()).entries)

    # --- preferences ----------------------------------------------------------------------------------------------

    def load(self, path: Path) -> None:
        """Take language, voice, volume and parameters from a JSON file, each if it is there; all or nothing.

        Raises:
            NaoqiError: The file is not what it should be.
        """
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
        if "language" in wanted:
            self.set_language(wanted["language"])
        if "voice" in wanted:
            self.set_voice(wanted["voice"])
        if "volume" in wanted:
            self.set_volume(wanted["volume"])
        if not isinstance(wanted.get("parameters", {}), dict):
            raise BadValue("parameters", wanted["parameters"], "an object of names and numbers")
        for name, value in wanted.get("parameters", {}).items():
            self.set_parameter(name, value)

    def _default_voice(self, language: str | None) -> str:
        """The voice of a language: the chosen one, or the first that can speak."""
        spoken = self.voices.language(language, self._engine)
        available = self.voices.available_voices(self._engine)
        chosen = self._chosen.get(spoken.name)
        return chosen or next(name for name in spoken.voices if name in available)
