"""Languages and voices of the robot, from `config/voices.json`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Mapping, Tuple

from nao_sim_bridge.base.config import check_keys, config_file, read_json
from nao_sim_bridge.base.errors import BadValue, ConfigError
from nao_sim_bridge.model.robot_model import frozen_mapping
from nao_sim_bridge.speech.engines import Engines, SpeechError, listed

FILE = "voices.json"


@dataclass(frozen=True)
class Voice:
    """A voice of the robot by NAOqi's name, for example "naoenu", and who speaks it by which name."""

    name: str
    language: str
    engine: str
    engine_voice: str


@dataclass(frozen=True)
class Language:
    """A language of the robot ("English", "en_US"), the encoding of texts in it, and its voices, the default first."""

    name: str
    locale: str
    encoding: str
    voices: Tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Voices:
    """All languages and voices that the robot knows, installed or not, and what it speaks at the start."""

    languages: Mapping[str, Language]
    voices: Mapping[str, Voice]
    default_language: str

    def voice(self, name: str, engine: Engines) -> Voice:
        """A voice that can speak.

        Raises:
            BadValue: There is no such voice.
            SpeechError: Its engine is missing.
        """
        if name not in self.voices:
            raise BadValue("voice", name, f"one of {listed(self.available_voices(engine))}", self.voices)
        problem = self._problem(name, engine)
        if problem is not None:
            raise SpeechError(f"voice {name!r} cannot speak: {problem}")
        return self.voices[name]

    def language(self, name: str, engine: Engines) -> Language:
        """A language that can be spoken.

        Raises:
            BadValue: There is no such language.
            SpeechError: The engines of all its voices are missing.
        """
        if name not in self.languages:
            raise BadValue("language", name, f"one of {listed(self.available_languages(engine))}", self.languages)
        language = self.languages[name]
        problems = [self._problem(voice, engine) for voice in language.voices]
        if all(problems):
            raise SpeechError(f"{name} cannot be spoken: {problems[0]}")
        return language

    def available_languages(self, engine: Engines) -> list[str]:
        """Languages with a voice whose engine is there."""
        spoken = {self.voices[name].language for name in self.available_voices(engine)}
        return [name for name in self.languages if name in spoken]

    def available_voices(self, engine: Engines) -> list[str]:
        """Voices whose engine is there."""
        return [name for name in self.voices if self._problem(name, engine) is None]

    def _problem(self, voice: str, engine: Engines) -> str | None:
        return engine.missing(self.voices[voice].engine, self.voices[voice].engine_voice)


@lru_cache(maxsize=None)
def load_voices() -> Voices:
    """The languages and voices, read once; a ConfigError for a wrong, unknown or missing entry of the file."""
    tables = check_keys(read_json(config_file(FILE)), FILE, ("default_language", "languages", "voices"), ("_meta",))
    languages: dict[str, Language] = {}
    voices: dict[str, Voice] = {}
    for name, entry in tables["languages"].items():
        where = f"{FILE}: languages.{name}"
        check_keys(entry, where, ("locale", "encoding", "voices"))
        if not entry["voices"]:
            raise ConfigError(where, "has no voices")
        languages[name] = Language(name, entry["locale"], entry["encoding"], tuple(entry["voices"]))
        for voice in entry["voices"]:
            spoken = check_keys(tables["voices"].get(voice), f"{FILE}: voices.{voice}", ("engine", "voice"))
            voices[voice] = Voice(voice, name, spoken["engine"], spoken["voice"])
    unused = [name for name in tables["voices"] if name not in voices]
    if unused:
        raise ConfigError(f"{FILE}: voices", f"{listed(unused)} of no language")
    if tables["default_language"] not in languages:
        raise ConfigError(f"{FILE}: default_language", f"{tables['default_language']!r} is none of the languages")
    return Voices(frozen_mapping(languages), frozen_mapping(voices), tables["default_language"])
