"""Part of ALMotion: what chains do while nobody moves them."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.idle import AMPLITUDE, BPM, GROUPS, Mode
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.motion.part import MotionPart

LIMITS = {"Bpm": BPM, "Amplitude": AMPLITUDE}


class Idling(MotionPart):
    """Breathing and idle posture: the last call for a chain says which of them, or none, it is."""

    def getBreathEnabled(self, chain: str) -> bool:
        return self._robot.reflexes.idle.has_mode(_group(chain), Mode.BREATH)

    def setBreathEnabled(self, chain: str, enabled: bool) -> Task:
        return self._set_mode("setBreathEnabled", chain, Mode.BREATH if enabled else Mode.NOTHING)

    def getIdlePostureEnabled(self, chain: str) -> bool:
        return self._robot.reflexes.idle.has_mode(_group(chain), Mode.POSTURE)

    def setIdlePostureEnabled(self, chain: str, enabled: bool) -> Task:
        return self._set_mode("setIdlePostureEnabled", chain, Mode.POSTURE if enabled else Mode.NOTHING)

    def getBreathConfig(self) -> list:
        idle = self._robot.reflexes.idle
        return [["Bpm", idle.bpm], ["Amplitude", idle.amplitude]]

    def setBreathConfig(self, config: Any) -> Task:
        given = _pairs(config)

        def change() -> None:
            idle = self._robot.reflexes.idle
            idle.set_breath(given.get("Bpm", idle.bpm), given.get("Amplitude", idle.amplitude))

        return self._runner.execute(change, "setBreathConfig")

    def _set_mode(self, call: str, chain: str, mode: Mode) -> Task:
        group = _group(chain)
        return self._runner.execute(lambda: self._robot.reflexes.idle.set_mode(group, mode), call)


def _group(name: Any) -> str:
    if name not in GROUPS:
        raise UnknownName("chain", name, GROUPS)
    return name


def _pairs(config: Any) -> dict[str, float]:
    if not isinstance(config, (list, tuple)) or any(not isinstance(p, (list, tuple)) or len(p) != 2 for p in config):
        raise BadValue("pConfig", config, 'pairs such as [["Bpm", 12.0], ["Amplitude", 0.5]]')
    given = {}
    for name, value in config:
        if not isinstance(name, str) or name not in LIMITS:
            raise UnknownName("breath parameter", name, LIMITS)
        given[name] = number(value, name, *LIMITS[name])
    return given
