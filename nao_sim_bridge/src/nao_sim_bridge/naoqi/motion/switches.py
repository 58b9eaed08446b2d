"""Part of ALMotion: switches of reflexes that have no part of their own."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.balance.reflexes import SWITCHES
from nao_sim_bridge.naoqi.motion.part import MotionPart


class Switches(MotionPart):
    """Smart stiffness, diagnosis effect, notifications, and the named switches of setMotionConfig."""

    def getSmartStiffnessEnabled(self) -> bool:
        return self._robot.reflexes.smart_stiffness.enabled

    def setSmartStiffnessEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.reflexes.smart_stiffness.enabled = enabled

        return self._runner.execute(switch, "setSmartStiffnessEnabled")

    def getDiagnosisEffectEnabled(self) -> bool:
        return self._robot.reflexes.diagnosis_enabled

    def setDiagnosisEffectEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.reflexes.diagnosis_enabled = enabled

        return self._runner.execute(switch, "setDiagnosisEffectEnabled")

    def areNotificationsEnabled(self) -> bool:
        return self._robot.motion.notices.enabled

    def setEnableNotifications(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.motion.notices.enabled = enabled

        return self._runner.execute(switch, "setEnableNotifications")

    def setMotionConfig(self, config: Any) -> Task:
        wanted = _switches(config)

        def change() -> None:
            self._robot.reflexes.switches.update(wanted)
            if "ENABLE_FALL_MANAGER_PROTECTION" in wanted:
                self._robot.stability.falls.enabled = wanted["ENABLE_FALL_MANAGER_PROTECTION"]

        return self._runner.execute(change, "setMotionConfig")


def _switches(config: Any) -> dict[str, bool]:
    if not isinstance(config, (list, tuple)) or any(not isinstance(p, (list, tuple)) or len(p) != 2 for p in config):
        raise BadValue("config", config, 'pairs such as [["ENABLE_STIFFNESS_PROTECTION", true]]')
    wanted = {}
    for name, value in config:
        if name not in SWITCHES:
            raise UnknownName("motion switch", name, SWITCHES)
        if value not in (True, False):
            raise BadValue(name, value, "true or false")
        wanted[name] = bool(value)
    return wanted
