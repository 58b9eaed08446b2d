"""Settings of sound, read strictly from `config/sound.json`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType
from typing import Mapping, Tuple

from nao_sim_bridge.base.config import check_keys, config_file, read_settings
from nao_sim_bridge.base.errors import ConfigError

FILE = "sound.json"
CHANNELS = ("left", "right", "front", "rear")
"""NAOqi's microphones in the order of their channels."""


@dataclass(frozen=True)
class SoundSettings:
    """All of `sound.json`.

    Attributes:
        speed_of_sound: m/s.
        microphone_full_scale_db: Level of a sine that just reaches full scale, dB SPL.
        loudspeaker_full_scale_db: Level at 1 m of a full scale sine from both loudspeakers at volume 100, dB SPL.
        near_field_m: Nearer than this nothing gets louder.
        talk_db: A talking person at 1 m, dB SPL.
        background_db: Level of the background noise, dB SPL.
        keep_s: How long the past is kept, s.
        channels: NAOqi's name of a channel to the microphone that it is.
        energies: NAOqi's name of an energy to the microphones whose mean it is.
    """

    speed_of_sound: float
    microphone_full_scale_db: float
    loudspeaker_full_scale_db: float
    near_field_m: float
    talk_db: float
    background_db: float
    keep_s: float
    channels: Mapping[str, str]
    energies: Mapping[str, Tuple[str, ...]]

    @property
    def order(self) -> Tuple[str, ...]:
        """Names of the microphones in the order of the channels."""
        return tuple(self.channels[name] for name in CHANNELS)

    def energy_channels(self, name: str) -> Tuple[int, ...]:
        """Indices of the channels whose mean is the energy `left`, `right`, `front` or `rear`."""
        return tuple(self.order.index(microphone) for microphone in self.energies[name])

    def peak_of(self, level_db: float) -> float:
        """Peak of a sine of that level as a microphone's samples have it, 1 is full scale."""
        return 10.0 ** ((level_db - self.microphone_full_scale_db) / 20.0)

    @property
    def loudspeaker_peak(self) -> float:
        """Peak of one loudspeaker's full scale sine at 1 m: each of the two gives half of what both give together."""
        return self.peak_of(self.loudspeaker_full_scale_db) / 2.0


@lru_cache(maxsize=None)
def load_sound_settings() -> SoundSettings:
    """Settings as the file gives them; a ConfigError when a key is unknown or missing, or a number makes no sense."""
    settings = read_settings(SoundSettings, config_file(FILE))
    check_keys(settings.channels, f"{FILE}: channels", CHANNELS)
    check_keys(settings.energies, f"{FILE}: energies", CHANNELS)
    for name in ("speed_of_sound", "near_field_m", "keep_s"):
        if getattr(settings, name) <= 0.0:
            raise ConfigError(f"{FILE}: {name}", f"is {getattr(settings, name)!r}, has to be above 0")
    known = set(settings.channels.values())
    for name, pair in settings.energies.items():
        if not pair or not set(pair) <= known:
            raise ConfigError(f"{FILE}: energies: {name}", f"is {pair!r}, not among {sorted(known)}")
    energies = {name: tuple(pair) for name, pair in settings.energies.items()}
    return replace(settings, channels=MappingProxyType(settings.channels), energies=MappingProxyType(energies))
