"""What ALMemory's keys of the battery's board read."""

from __future__ import annotations

from typing import Any, Callable, Mapping

from nao_sim_bridge.body.sensors.battery import BatteryReading
from nao_sim_bridge.body.sensors.snapshot import Snapshot

# Current into the battery is positive: clients take a negative one for discharging. Voltages are in mV, capacities in
# mAh.
READERS: Mapping[str, Callable[[BatteryReading], Any]] = {
    "Charge/Sensor/Value": lambda battery: battery.charge,
    "Charge/Sensor/Status": lambda battery: int(battery.status),
    "Charge/Sensor/CellVoltageMin": lambda battery: _milli(battery.cell_voltages[0]),
    "Charge/Sensor/CellVoltageMax": lambda battery: _milli(battery.cell_voltages[1]),
    "Charge/Sensor/TotalVoltage": lambda battery: _milli(battery.voltage),
    "Charge/Sensor/RemainingCapacity": lambda battery: _milli(battery.capacity_ah * battery.charge),
    "Charge/Sensor/FullChargeCapacity": lambda battery: _milli(battery.capacity_ah),
    "Current/Sensor/Value": lambda battery: -battery.current,
    "Temperature/Sensor/Value": lambda battery: battery.temperature,
}


def battery_reader(key: str) -> Callable[[Snapshot], Any]:
    """Reads what is behind `Battery/` in a key.

    Raises:
        KeyError: Nothing does.
    """
    read = READERS[key]
    return lambda snapshot: read(snapshot.battery)


def _milli(value: float) -> int:
    return round(1000.0 * value)
