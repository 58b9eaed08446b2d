"""Numbers of speech recognition, from `config/recognition.json`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

from nao_sim_bridge.base.config import config_file, read_settings

FILE = "recognition.json"


@dataclass(frozen=True)
class VoiceActivitySettings:
    """When speech begins and ends; the file has the meanings. Levels in dB below full scale, times in s."""

    frame_s: float
    margin_db: Tuple[float, float]
    least_level_db: float
    begin_frames: int
    window_frames: int
    pause_s: float
    before_s: float
    after_s: float
    background_s: float
    least_speech_s: float
    longest_s: float

    def margin(self, sensitivity: float) -> float:
        """How far above the background a loud frame is, dB."""
        low, high = self.margin_db
        return low + sensitivity * (high - low)


@dataclass(frozen=True)
class NoiseReductionSettings:
    """How steady noise is taken out of speech."""

    least_gain: float
    smoothing: float
    background_s: float


@dataclass(frozen=True)
class GainSettings:
    """The level that speech is brought to, dB below full scale, and the most gain for it, dB."""

    level_db: float
    most_db: float


@dataclass(frozen=True)
class ConfidenceSettings:
    """How confidence follows from evidence, and the least that is recognised."""

    bias: float
    difference: float
    everyday: float
    sounds: float
    same: float
    length: float
    least: float


@dataclass(frozen=True)
class OtherSpeechSettings:
    """How likely other speech is beside the words of a phrase, and how many phrases are tried in its place."""

    weight: float
    tries: int


@dataclass(frozen=True)
class SpeechLikenessSettings:
    """What is no speech: too little voice, too much of a single tone, or a spectrum that changes too little."""

    least_voice: float
    most_tone: float
    least_change: float


@dataclass(frozen=True)
class RecognitionSettings:
    """All of the file."""

    languages: Tuple[str, ...]
    voice_activity: VoiceActivitySettings
    noise_reduction: NoiseReductionSettings
    gain: GainSettings
    confidence: ConfidenceSettings
    spotting: ConfidenceSettings
    other_speech: OtherSpeechSettings
    speech_likeness: SpeechLikenessSettings


@lru_cache(maxsize=None)
def load_recognition() -> RecognitionSettings:
    """The settings of the package; a ConfigError when the file does not hold what it should."""
    return read_settings(RecognitionSettings, config_file(FILE), ["_note", "_note"])
