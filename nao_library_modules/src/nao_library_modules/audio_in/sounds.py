"""Hearing functions that detect sounds and locate them."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from genpy import Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header

from nao_library_msgs.msg import HeardSound
from naoqi.errors import NaoError

from ..base.places import FOOTPRINT
from ..functions.parts import Part
from ..robot.event_times import Event
from ..robot.robot_clock import same_clock
from ..server.nao_basic import NaoBasic
from .events import LocatedSound, begun_sounds, located_sound
from .fields import SENSES, BetterTime, Confidence, Sense, Sensitivity, Timeout, timeout_of
from .hearing import Hearing

log = logging.getLogger(__name__)

DETECTED, LOCATED = "SoundDetected", "ALSoundLocalization/SoundLocated"
HEAD = "Head"
"""Frame of the robot, as its description names it."""


class SoundFunctions(Part):
    def __init__(self, module: NaoBasic, hearing: Hearing, frame_prefix: str) -> None:
        self._module = module
        self._hearing = hearing
        self._frame_prefix = frame_prefix  # with its slash; may be empty

    def detect_sound(self, timeout: Timeout, confidence: Confidence) -> list[float]:
        """Wait for a sound to begin; answers its confidence and after how long it came (s), nothing if none did."""
        with self._hearing.events_of(DETECTED) as events, self._hearing.subscribed(SENSES["detection"], "detect"):
            began = self._module.clock.now()
            for event in events.until(began + timeout_of(timeout)):
                sounds = [sound for sound in _parsed(begun_sounds, event.value, []) if sound.confidence >= confidence]
                if sounds:
                    sure, when = sounds[0].confidence, self._begin_of(sounds[0].time, event)
                    self._note(when, sure)
                    return [sure, max(0.0, when - began)]
        self._remark_silence(timeout)
        return []

    def localize_sound(self, timeout: Timeout, confidence: Confidence, duration: BetterTime) -> list[float]:
        """Wait for a sound and tell where it is, rad: azimuth, elevation of the head, confidence, both of the base."""
        module = SENSES["localization"]
        try:
            self._module.call(self._module.robot.proxy(module), "setParameter", "EnergyComputation", True)
        except NaoError as error:
            log.debug("sounds have no energies: %s", error)
        best: LocatedSound | None = None
        when = 0.0
        with self._hearing.events_of(LOCATED) as events, self._hearing.subscribed(module, "localize"):
            for event in events.until(self._module.clock.now() + timeout_of(timeout)):
                sound = _parsed(located_sound, event.value, None)
                if sound is not None and sound.confidence >= confidence:
                    best, when = sound, self._begin_of(sound.time, event)
                    break
            if best is not None and duration > 0.0:
                for later in events.until(event.arrived + duration):
                    sound = _parsed(located_sound, later.value, None)
                    if sound is not None and sound.confidence > best.confidence:
                        best, when = sound, self._begin_of(sound.time, later)
        if best is None:
            self._remark_silence(timeout)
            return []
        self._note(when, best.confidence, best)
        head, base = best.in_head, best.in_base
        return [head.azimuth, head.elevation, best.confidence, base.azimuth, base.elevation]

    def set_sensitivity(self, sensitivity: Sensitivity, str_param: Sense) -> None:
        """Make speech recognition, sound detection or localization more or less sensitive; all if none is named."""
        for sense in [str_param.strip()] if str_param.strip() else SENSES:
            proxy = self._module.robot.proxy(SENSES[sense])
            self._module.call(proxy, "setParameter", "Sensitivity", float(sensitivity))

    def _begin_of(self, robot_time: float, event: Event) -> float:
        """ROS time of a time in an event, s; that of the event itself where the time is of another clock."""
        raised = self._hearing.event_time(event)
        began = self._module.robot_clock.ros_time(self._module.call, robot_time)
        return began if same_clock(began, raised) else raised

    def _note(self, when: float, confidence: float, sound: LocatedSound | None = None) -> None:
        self._module.happened = (when, 0.0)
        header = Header(stamp=Time.from_sec(when), frame_id=self._frame_prefix + HEAD)
        message = HeardSound(header=header, confidence=confidence, base_frame=self._frame_prefix + FOOTPRINT)
        if sound is not None:
            message.located = True
            message.azimuth, message.elevation = sound.in_head.azimuth, sound.in_head.elevation
            message.base_azimuth, message.base_elevation = sound.in_base.azimuth, sound.in_base.elevation
            message.energy = sound.energy
            message.head = Point(*sound.head)
        self._hearing.heard.sounds.append(message)

    def _remark_silence(self, timeout: float) -> None:
        self._module.remark(f"no sound within {timeout_of(timeout):g} s")

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
