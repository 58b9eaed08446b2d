"""ALBodyTemperature of the simulated robot and its events. Only NAOqi methods live in the class of that name."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.settings import HeadSettings
from nao_sim_bridge.body.sensors.heat import CRITICAL
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.temperatures import HEAD, NOTHING_HOT, Hot, hot_devices
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.model.robot_model import RobotModel
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
    """ALBodyTemperature as the simulated robot offers it."""

    def __init__(self, runner: SimulationRunner, events: TemperatureEvents) -> None:
        self._runner = runner
        self._events = events

    def getTemperatureDiagnosis(self) -> list:
        return diagnosis(self._events.hot(self._runner.snapshot))

    def areNotificationsEnabled(self) -> bool:
        return self._events.enabled

    def setEnableNotifications(self, enable: bool) -> None:
        self._events.enabled = enable


class TemperatureEvents:
    """Raises the events of temperatures; called after every tick, in the simulation thread.

    Attributes:
        enabled: Whether events are raised; any thread may switch it.
    """

    def __init__(self, model: RobotModel, head: HeadSettings, memory: MemoryStore) -> None:
        self.enabled = True
        self._model = model
        self._limits = head
        self._memory = memory
        self._temperatures: Any = None
        self._hot = NOTHING_HOT
        self._head = 0.0
        for event in EVENTS:
            memory.declare_event(event, NAME)

    def hot(self, snapshot: Snapshot) -> Hot:
        """What is hot."""
        return hot_devices(self._model, self._limits, snapshot)

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the temperatures when they are new."""
        if snapshot.temperatures is self._temperatures or not self.enabled:
            return
        first = self._temperatures is None
        self._temperatures = snapshot.temperatures
        before, self._hot = self._hot, self.hot(snapshot)
        now = self._hot
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
