"""ALBodyTemperature of the simulated robot and its events."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.temperatures import CRITICAL, HEAD, NOTHING_HOT, Hot, hot_devices
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.body.diagnosis import severity_value
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALBodyTemperature"
HOT_DEVICE, COOLED_DOWN, HOT_JOINT = "HotDeviceDetected", "DeviceNoLongerHotDetected", "HotJointDetected"
STATUS, DIAGNOSIS = "TemperatureStatusChanged", "TemperatureDiagnosisErrorChanged"
HOT_HEAD, CRITICAL_HEAD = "HeadProcessorIsHot", "HeadProcessorIsCriticallyHot"
EVENTS = (HOT_DEVICE, COOLED_DOWN, HOT_JOINT, STATUS, DIAGNOSIS, HOT_HEAD, CRITICAL_HEAD)
# The processor's temperature is told again when it has changed by this, K.
HEAD_STEP = 1.0


class ALBodyTemperature:
    """ALBodyTemperature as the simulated robot offers it; called after every tick, in the simulation thread."""

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._runner = runner
        self._enabled = True
        self._model = runner.simulation.model
        self._limits = runner.simulation.settings.head
        self._memory = memory
        self._temperatures: Any = None
        self._hot = NOTHING_HOT
        self._head = 0.0
        for event in EVENTS:
            memory.declare_event(event, NAME)

    def getTemperatureDiagnosis(self) -> list:
        return diagnosis(hot_devices(self._model, self._limits, self._runner.snapshot))

    def areNotificationsEnabled(self) -> bool:
        return self._enabled

    def setEnableNotifications(self, enable: bool) -> None:
        self._enabled = enable

    def __call__(self, snapshot: Snapshot) -> None:
        if snapshot.temperatures is self._temperatures or not self._enabled:
            return
        first = self._temperatures is None
        self._temperatures = snapshot.temperatures
        before, now = self._hot, hot_devices(self._model, self._limits, snapshot)
        self._hot = now
        if now is not before:
            self._tell(before, now)
        if first:
            self._memory.put_quietly(STATUS, severity_value(*now.status))
            self._memory.put_quietly(DIAGNOSIS, diagnosis(now))
        if HEAD not in now.devices:
            self._head = 0.0
        elif abs(snapshot.head_temperature - self._head) >= HEAD_STEP:
            self._head = snapshot.head_temperature
            event = CRITICAL_HEAD if now.devices[HEAD] == CRITICAL else HOT_HEAD
            self._memory.raise_event(event, self._head)

    def _tell(self, before: Hot, now: Hot) -> None:
        raise_event = self._memory.raise_event
        if now.devices.keys() - before.devices.keys():
            raise_event(HOT_DEVICE, list(now.devices))
        cooled = [name for name in before.devices if name not in now.devices]
        if cooled:
            raise_event(COOLED_DOWN, cooled)
        if set(now.joints) - set(before.joints):
            raise_event(HOT_JOINT, list(now.joints))
        if now.status != before.status:
            raise_event(STATUS, severity_value(*now.status))
        if diagnosis(now) != diagnosis(before):
            raise_event(DIAGNOSIS, diagnosis(now))


def diagnosis(hot: Hot) -> list:
    """[severity, [chains]] as the wire has it."""
    return severity_value(hot.severity, hot.chains)
