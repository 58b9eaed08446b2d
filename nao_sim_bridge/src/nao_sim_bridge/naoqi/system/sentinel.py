"""ALSentinel, which looked after battery, heat and chest button before NAOqi 2.0."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, Callable, Mapping

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.body.battery import ALBattery
from nao_sim_bridge.naoqi.body.body_temperature import ALBodyTemperature
from nao_sim_bridge.naoqi.body.touch import CLICKED
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.system import ALSystem

FULL = 5
SIMPLE, DOUBLE = 1, 2
OUCH = "Ouch"
KB = 1024


class ALSentinel:
    """ALSentinel as the simulated robot offers it; it says what clicks of the chest button make it say."""

    def __init__(
        self,
        memory: MemoryStore,
        battery: ALBattery,
        temperature: ALBodyTemperature,
        system: ALSystem,
        say: Callable[[str], Task],
    ) -> None:
        self._battery = battery
        self._temperature = temperature
        self._system = system
        self._say = say
        self._enabled = {SIMPLE: False, DOUBLE: False}
        actions: Mapping[int, Callable[[], Any]] = {SIMPLE: lambda: self.presentation(False), DOUBLE: lambda: say(OUCH)}
        for clicks, action in actions.items():
            memory.listen(CLICKED[clicks], partial(self._clicked, clicks, action))

    def enableBatteryMeasure(self, enable: bool) -> None:
        self._battery.enablePowerMonitoring(enable)

    enablePowerMonitoring = enableBatteryMeasure

    def enableHeatMonitoring(self, enable: bool) -> None:
        self._temperature.setEnableNotifications(enable)

    def enableDefaultActionSimpleClick(self, enable: bool) -> None:
        self._enabled[SIMPLE] = enable

    def enableDefaultActionDoubleClick(self, enable: bool) -> None:
        self._enabled[DOUBLE] = enable

    def enableDefaultActionTripleClick(self, enable: bool) -> None:
        if enable:
            raise NaoqiError("three clicks do not start the simulated NAOqi again; call ALSystem.reboot")

    def getBatteryLevel(self) -> int:
        return math.ceil(FULL * self._battery.getBatteryCharge() / 100.0)

    def getBatteryLevelDesc(self) -> str:
        return f"My battery is at {self._battery.getBatteryCharge()} percent"

    def getRemainingRam(self) -> int:
        return self._system.freeMemory() * KB

    def presentation(self, check_joints: bool) -> Task:
        return self._say(f"Hello, I am {self._system.robotName()}. {self.getBatteryLevelDesc()}.")

    def _clicked(self, clicks: int, action: Callable[[], Any], _: Any) -> None:
        if self._enabled[clicks]:
            action()
