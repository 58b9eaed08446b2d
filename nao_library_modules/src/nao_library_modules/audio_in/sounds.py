"""Hearing functions that notice sounds and tell where they come from."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError

from ..robot.robot_clock import same_clock
from ..server.extractor_use import Event
from .base import AudioInBase, timeout_of
from .checks import SENSES
from .events import LocatedSound, begun_sounds, located_sound
from .fields import BetterTime, Confidence, Sense, Sensitivity, Timeout
from .heard import sound_message

log = logging.getLogger(__name__)

DETECTED, LOCATED = "SoundDetected", "ALSoundLocalization/SoundLocated"


class SoundFunctions(AudioInBase):
    """Sounds and their directions. Parameters are fields of AudioInFunction."""

    frame_prefix: str

    def detect_sound(self, timeout: Timeout, confidence: Confidence) -> list[float]:
        """Wait for a sound to begin; answers its confidence and after how long it came (s), nothing if none did."""
        with self.events_of(DETECTED) as events, self.subscribed(SENSES["detection"], "detect"):
            began = self.clock.now()
            for event in events.until(began + timeout_of(timeout)):
                sounds = [sound for sound in _parsed(begun_sounds, event.value, []) if sound.confidence >= confidence]
                if sounds:
                    sure, when = sounds[0].confidence, self._told_time(sounds[0].time, event)
                    self._note(when, sure)
                    return [sure, max(0.0, when - began)]
        self._remark_silence(timeout)
        return []

    def localize_sound(self, timeout: Timeout, confidence: Confidence, duration: BetterTime) -> list[float]:
        """Wait for a sound and tell where it is, rad: azimuth, elevation of the head, confidence, both of the base."""
        module = SENSES["localization"]
        try:
            self.call(self.robot.proxy(module), "setParameter", "EnergyComputation", True)
        except NaoError as error:
            log.debug("sounds have no energies: %s", error)
        best: LocatedSound | None = None
        when = 0.0
        with self.events_of(LOCATED) as events, self.subscribed(module, "localize"):
            for event in events.until(self.clock.now() + timeout_of(timeout)):
                sound = _parsed(located_sound, event.value, None)
                if sound is not None and sound.confidence >= confidence:
                    best, when = sound, self._told_time(sound.time, event)
                    break
            if best is not None and duration > 0.0:
                for later in events.until(event.arrived + duration):
                    sound = _parsed(located_sound, later.value, None)
                    if sound is not None and sound.confidence > best.confidence:
                        best, when = sound, self._told_time(sound.time, later)
        if best is None:
            self._remark_silence(timeout)
            return []
        self._note(when, best.confidence, best)
        head, base = best.in_head, best.in_base
        return [head.azimuth, head.elevation, best.confidence, base.azimuth, base.elevation]

    def set_sensitivity(self, sensitivity: Sensitivity, str_param: Sense) -> None:
        """Make speech recognition, sound detection or localization more or less sensitive; all if none is named."""
        for sense in [str_param.strip()] if str_param.strip() else SENSES:
            self.call(self.robot.proxy(SENSES[sense]), "setParameter", "Sensitivity", float(sensitivity))

    def _told_time(self, robot_time: float, event: Event) -> float:
        """ROS time of a time in an event, s; that of the event itself where the time is of another clock."""
        raised, told = self.event_time(event), self.robot_clock.ros_time(self.call, robot_time)
        return told if same_clock(told, raised) else raised

    def _note(self, when: float, confidence: float, sound: LocatedSound | None = None) -> None:
        self.happened = (when, 0.0)
        self.heard.sounds.append(sound_message(when, self.frame_prefix, confidence, sound))

    def _remark_silence(self, timeout: float) -> None:
        self.remark(f"no sound within {timeout_of(timeout):g} s")

    functions = {
        "detectSound": detect_sound,
        "localizeSound": localize_sound,
        "setSensitivity": set_sensitivity,
    }


def _parsed(parse: Callable[[Any], Any], value: Any, nothing: Any) -> Any:
    try:
        return parse(value)
    except ValueError as error:
        log.warning("%s", error)
        return nothing
