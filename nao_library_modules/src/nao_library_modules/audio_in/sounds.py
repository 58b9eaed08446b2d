"""Hearing functions that notice sounds and tell where they come from."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError

from .audio_in_base import AudioInBase, timeout_of
from .audio_in_checks import SENSES, check_detection, check_localization, check_sensitivity
from .audio_in_events import LocatedSound, begun_sounds, located_sound
from .audio_in_heard import sound_message
from .function_chain import checked_by

log = logging.getLogger(__name__)

DETECTED, LOCATED = "SoundDetected", "ALSoundLocalization/SoundLocated"


class SoundFunctions(AudioInBase):
    """Sounds and their directions. Parameters are fields of AudioInFunction."""

    frame_prefix: str

    def sound_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "detectSound": self.detect_sound,
            "localizeSound": self.localize_sound,
            "setSensitivity": self.set_sensitivity,
        }

    @checked_by(check_detection)
    def detect_sound(self, timeout: float, confidence: float) -> list[float]:
        """Wait for a sound to begin; answers its confidence and after how long it came (s), nothing if none did."""
        with self.events_of(DETECTED) as events, self.subscribed(SENSES["detection"], "detect"):
            began = self.clock.now()
            for _, value in events.until(began + timeout_of(timeout)):
                sounds = [found for found in _parsed(begun_sounds, value, []) if found >= confidence]
                if sounds:
                    now = self.clock.now()
                    self.heard.sounds.append(sound_message(now, self.frame_prefix, sounds[0]))
                    return [sounds[0], max(0.0, now - began)]
        return []

    @checked_by(check_localization)
    def localize_sound(self, timeout: float, confidence: float, duration: float) -> list[float]:
        """Wait for a sound and tell where it is, rad: azimuth, elevation of the head, confidence, both of the base."""
        module = SENSES["localization"]
        try:
            self.call(self.robot.proxy(module), "setParameter", "EnergyComputation", True)
        except NaoError as error:
            log.debug("sounds have no energies: %s", error)
        best: LocatedSound | None = None
        when = 0.0
        with self.events_of(LOCATED) as events, self.subscribed(module, "localize"):
            for _, value in events.until(self.clock.now() + timeout_of(timeout)):
                sound = _parsed(located_sound, value, None)
                if sound is not None and sound.confidence >= confidence:
                    best, when = sound, self.clock.now()
                    break
            if best is not None and duration > 0.0:
                for _, value in events.until(when + duration):
                    sound = _parsed(located_sound, value, None)
                    if sound is not None and sound.confidence > best.confidence:
                        best, when = sound, self.clock.now()
        if best is None:
            return []
        self.heard.sounds.append(sound_message(when, self.frame_prefix, best.confidence, best))
        head, base = best.in_head, best.in_base
        return [head.azimuth, head.elevation, best.confidence, base.azimuth, base.elevation]

    @checked_by(check_sensitivity)
    def set_sensitivity(self, sensitivity: float, str_param: str) -> None:
        """Make speech recognition, sound detection or localization more or less sensitive; all if none is named."""
        for sense in [str_param.strip()] if str_param.strip() else SENSES:
            self.call(self.robot.proxy(SENSES[sense]), "setParameter", "Sensitivity", float(sensitivity))


def _parsed(parse: Callable[[Any], Any], value: Any, nothing: Any) -> Any:
    try:
        return parse(value)
    except ValueError as error:
        log.warning("%s", error)
        return nothing
