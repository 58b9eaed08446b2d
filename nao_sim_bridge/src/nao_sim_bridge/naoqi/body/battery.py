"""ALBattery of the simulated robot and its events."""

from __future__ import annotations

from typing import Any, Callable, Mapping

from nao_sim_bridge.body.sensors.battery import BatteryReading
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALBattery"
LOW, NEARLY_EMPTY, EMPTY = "ALBattery/BatteryLow", "BatteryNearlyEmpty", "BatteryEmpty"
# Cell voltages are told in steps of this, mV: the last digits change all the time.
VOLTAGE_STEP = 10
# Events that are raised with their new value whenever it changes.
VALUES: Mapping[str, Callable[[BatteryReading], Any]] = {
    "BatteryChargeChanged": lambda battery: percent(battery),
    "BatteryChargingFlagChanged": lambda battery: battery.charging,
    "BatteryDisChargingFlagChanged": lambda battery: battery.discharging,
    "BatteryFullChargedFlagChanged": lambda battery: battery.full,
    "BatteryChargeCellVoltageMinChanged": lambda battery: (
        VOLTAGE_STEP * round(1000.0 * battery.cell_voltages[0] / VOLTAGE_STEP)
    ),
    "BatteryLowDetected": lambda battery: battery.low,
    "BatteryNotDetected": lambda battery: False,  # nobody takes it out
}
# Of robots whose battery tells it.
PLUGGED = "BatteryPowerPluggedChanged"
# Events that are raised when a state begins, with what they say.
BEGINNINGS: Mapping[str, tuple[Callable[[BatteryReading], bool], Any]] = {
    LOW: (lambda battery: battery.low, True),
    NEARLY_EMPTY: (lambda battery: battery.nearly_empty, "The battery is nearly empty."),
    EMPTY: (lambda battery: battery.empty, "The battery is empty."),
}


class ALBattery:
    """ALBattery as the simulated robot offers it; called after every tick, in the simulation thread, for its events."""

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._runner = runner
        self._enabled = True
        self._memory = memory
        self._seen: BatteryReading | None = None
        self._told: dict[str, Any] = {}
        self._begun: frozenset[str] = frozenset()
        for event in (*VALUES, *BEGINNINGS, PLUGGED):
            memory.declare_event(event, NAME)

    def getBatteryCharge(self) -> int:
        return percent(self._runner.snapshot.battery)

    def enablePowerMonitoring(self, enable: bool) -> None:
        self._enabled = enable

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the battery when its board has told something new."""
        battery = snapshot.battery
        if battery is self._seen or not self._enabled:
            return
        self._seen = battery
        for event, read in VALUES.items():
            self._tell(event, read(battery))
        if battery.tells_plugged:
            self._tell(PLUGGED, battery.plugged)
        begun = frozenset(event for event, (holds, _) in BEGINNINGS.items() if holds(battery))
        for event in sorted(begun - self._begun):
            self._memory.raise_event(event, BEGINNINGS[event][1])
        self._begun = begun

    def _tell(self, event: str, value: Any) -> None:
        if self._told.get(event) != value:
            self._told[event] = value
            self._memory.raise_event(event, value)


def percent(battery: BatteryReading) -> int:
    """The charge in percent, whole; an empty battery is one that has less than half a percent."""
    return round(100.0 * battery.charge)
