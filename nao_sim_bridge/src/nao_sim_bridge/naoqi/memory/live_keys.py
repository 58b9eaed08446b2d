"""ALMemory's device keys of the simulated robot: each reads its value from the last snapshot when it is asked for.

The names come from `config/naoqi_memory_keys.json`; a key of the file that nothing here can read is an error at start.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Callable, Mapping

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.readings import FootForces
from nao_sim_bridge.body.sensors.battery import BatteryReading
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.temperatures import heat_status
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.leds_layout import LedLayout
from nao_sim_bridge.model.robot_model import RobotModel

FILE = "naoqi_memory_keys.json"
GRAVITY = 9.81
Read = Callable[[Snapshot], Any]

JOINT_SUFFIXES: Mapping[str, Callable[[int], Read]] = {
    "Position/Actuator/Value": lambda i: lambda s: s.commands[i],
    "Position/Sensor/Value": lambda i: lambda s: s.positions[i],
    "ElectricCurrent/Sensor/Value": lambda i: lambda s: s.currents[i],
    "Temperature/Sensor/Value": lambda i: lambda s: s.temperatures[i],
    "Temperature/Sensor/Status": lambda i: lambda s: heat_status(s.temperatures[i]),
    "Hardness/Actuator/Value": lambda i: lambda s: s.stiffnesses[i],
}
# Current into the battery is positive: clients take a negative one for discharging. Voltages are in mV, capacities in
# mAh.
BATTERY: Mapping[str, Callable[[BatteryReading], Any]] = {
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
CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
AXES = {"X": 0, "Y": 1, "Z": 2}
# A foot touches the ground from this load on, in N.
CONTACT_LOAD = 3.0


@lru_cache(maxsize=None)
def key_tables() -> Mapping[str, Any]:
    """What `FILE` says, by section."""
    return read_json(config_file(FILE))


def key_prefix() -> str:
    """What every key of a device begins with."""
    return key_tables()["_meta"]["prefix"]


def live_keys(runner: RobotRunner, model: RobotModel, leds: LedLayout, led_values: Callable[[], tuple]) -> dict:
    """Key -> function without arguments that reads its present value.

    A ConfigError when the file names a key that nothing can read.
    """
    readers: dict[str, Callable[[], Any]] = {}
    for key, read in _snapshot_keys(model).items():
        readers[key] = lambda read=read: read(runner.snapshot)
    for index, device in enumerate(leds.devices):
        readers[key_prefix() + device] = lambda index=index: led_values()[index]
    return readers


def constants(version: str) -> dict[str, Any]:
    """Keys whose value never changes: what the robot is made of."""
    tables = key_tables()
    values = {**tables["robot_config_V6"], **tables[f"robot_config_{version}"]}
    values.pop("note", None)
    values["Device/DeviceList/ChestBoard/BodyId"] = "SIMULATED-NAO-BODY"
    values["RobotConfig/Head/FullHeadId"] = "SIMULATED-NAO-HEAD"
    return values


def _snapshot_keys(model: RobotModel) -> dict[str, Read]:
    tables = key_tables()
    prefix = key_prefix()
    keys: dict[str, Read] = {}
    motors = {**{joint: joint for joint in tables["joints"]["names"]}, **tables["joints"]["same_motor"]}
    for joint, motor in motors.items():
        for suffix in tables["joints"]["suffixes"]:
            keys[f"{prefix}{joint}/{suffix}"] = JOINT_SUFFIXES[suffix](model.joint_index[motor])
    for group, entry in tables["devices"].items():
        if not group.startswith("led_") and group != "sonar":  # `sonar.py` knows when these are measured
            for key in entry["keys"]:
                keys[prefix + key] = _device_reader(key)
    for key in tables["older_or_extra"]["keys"]:
        keys[prefix + key] = _device_reader(key)
    keys[f"{prefix}ChestBoard/Led/State/Actuator/Value"] = lambda s: 0.0
    keys.update(_MODULE_KEYS)
    return keys


def _device_reader(key: str) -> Read:
    for pattern, make in _PATTERNS:
        match = re.fullmatch(pattern, key)
        if match:
            return make(*match.groups())
    raise ConfigError(FILE, f"nothing in the simulation can read {key!r}")


def _foot(snapshot: Snapshot, side: str) -> FootForces:
    return snapshot.left_foot if side == "L" else snapshot.right_foot


def _vector(field: str) -> Callable[[str], Read]:
    return lambda axis: lambda s: getattr(s.imu, field)[AXES[axis]]


def _milli(value: float) -> int:
    return round(1000.0 * value)


_PATTERNS: tuple[tuple[str, Callable[..., Read]], ...] = (
    (
        r"([LR])Foot/FSR/(FrontLeft|FrontRight|RearLeft|RearRight)/Sensor/Value",
        lambda side, corner: lambda s: _foot(s, side).forces[CORNERS.index(corner)] / GRAVITY,
    ),
    (r"([LR])Foot/FSR/TotalWeight/Sensor/Value", lambda side: lambda s: _foot(s, side).total / GRAVITY),
    (
        r"([LR])Foot/FSR/CenterOfPressure/([XY])/Sensor/Value",
        lambda side, axis: lambda s: _foot(s, side).center_of_pressure[AXES[axis]],
    ),
    (r"InertialSensor/Gyroscope([XYZ])/Sensor/Value", _vector("gyroscope")),
    (r"InertialSensor/Gyr([XY])/Sensor/Value", _vector("gyroscope")),
    (r"InertialSensor/Accelerometer([XYZ])/Sensor/Value", _vector("accelerometer")),
    (r"InertialSensor/Acc([XYZ])/Sensor/Value", _vector("accelerometer")),
    (r"InertialSensor/Angle([XYZ])/Sensor/Value", _vector("angles")),
    (
        r"((?:[LR]Foot/Bumper|[LR]Hand/Touch|Head/Touch|ChestBoard/Button).*?)/Sensor/Value",
        lambda device: lambda s: float(device in s.touched),
    ),
    (rf"Battery/({'|'.join(BATTERY)})", lambda key: lambda s: BATTERY[key](s.battery)),
    (r"Head/Temperature/Sensor/Value", lambda: lambda s: s.head_temperature),
)

_MODULE_KEYS: dict[str, Read] = {
    "DCM/Time": lambda s: _milli(s.time),
    "footContact": lambda s: float(max(s.left_foot.total, s.right_foot.total) > CONTACT_LOAD),
    "leftFootContact": lambda s: float(s.left_foot.total > CONTACT_LOAD),
    "rightFootContact": lambda s: float(s.right_foot.total > CONTACT_LOAD),
    "leftFootTotalWeight": lambda s: s.left_foot.total / GRAVITY,
    "rightFootTotalWeight": lambda s: s.right_foot.total / GRAVITY,
}
