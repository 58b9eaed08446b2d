"""Health reports: connection, goals and launch file of a module, and the parts of the robot's body. No ROS."""

from __future__ import annotations

import json
import math
import threading
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from naoqi.errors import NaoError

from .nao_facts import (
    BATTERY_STATUS,
    CHARGE,
    CHARGING_BIT,
    FULL_BIT,
    HOT_MOTOR,
    PREFIX,
    TOO_HOT_MOTOR,
    JointNames,
    temperature_key,
)
from .nao_facts import CURRENT as AMPERES
from .processes import Supervisor, SupervisorState

SLOW_ANSWER = 0.5
"""A robot that takes longer than this (s) to answer is reported as slow."""

SILENT = "silent"
"""State, among those of the connection, of a robot that does not answer but is not lost yet."""


SILENT_FOR = "silent for (s)"
"""Value of a report about the connection: how long the robot has not answered, 0 while it does."""
RECORDINGS, STARTED = "recordings", "started"
"""Values of a report about recordings: their names, a list as JSON; when the process was started, s since 1970."""
_STARTED = f"{time.time():.3f}"


class Level(IntEnum):
    """Severity, with the numbers of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(frozen=True)
class Report:
    """One line of diagnostics."""

    level: Level  # severity
    message: str  # what is the matter, in words
    values: dict[str, str] = field(default_factory=dict)  # facts by name
    state: str = ""  # the message in a word or two, without numbers, for a summary of several reports


class GoalCounter:
    """Counts goals by how they ended. Written by the thread that executes goals, read by the diagnostics."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._counts = {"succeeded": 0, "preempted": 0, "aborted": 0}
        self._last_error = ""

    def ended(self, end: str, text: str) -> None:
        """Count a goal. `end`: succeeded, preempted or aborted. `text`: why, for an aborted one."""
        with self._lock:
            self._counts[end] += 1
            if end == "aborted":
                self._last_error = text

    def report(self) -> Report:
        """Counts, and why the last goal was aborted; always OK, for a bad goal is its sender's matter."""
        with self._lock:
            values = {name: str(count) for name, count in self._counts.items()}
            values["last error"] = self._last_error
        return Report(Level.OK, "ready for goals", values)


def connection_report(address: str, connection: Any) -> Report:
    """State of the connection to the robot. `address`: `ip:port`. `connection`: connection of the proxy layer."""
    latency, silent = connection.latency, connection.silent
    values = {
        "address": address,
        "state": SILENT if silent else str(connection.state),
        SILENT_FOR: f"{silent:.1f}",
        "latency (ms)": "" if latency is None else f"{1000.0 * latency:.1f}",
        "connections made": str(connection.generation),
        "last error": connection.last_error or "",
    }
    if silent:
        # Without how long it is: what all nodes report alike is told once.
        patience = connection.timing.patience
        message = f"silent: goals and calls wait, until the robot is lost after {patience:g} s without an answer"
        return Report(Level.WARN, message, values)
    if values["state"] != "connected":
        return Report(Level.ERROR, f"{values['state']}: {values['last error'] or 'no answer yet'}", values)
    if latency is not None and latency > SLOW_ANSWER:
        return Report(Level.WARN, f"connected, but answers take {latency:.1f} s", values)
    return Report(Level.OK, "connected", values)


def recordings_report(names: Iterable[str]) -> Report:
    """What a server records at this moment. `names`: of the recordings that get something to record."""
    running = sorted(names)
    values = {RECORDINGS: json.dumps(running), STARTED: _STARTED}
    return Report(Level.OK, f"records {', '.join(running) or 'nothing'}", values)


def launch_report(supervisor: Supervisor | None) -> Report:
    """State of the launch file that belongs to a module; None when the module has not started it."""
    if supervisor is None:
        return Report(Level.OK, "left to others")
    status = supervisor.status
    values = {
        "state": status.state.value,
        "process": "" if status.pid is None else str(status.pid),
        "restarts": str(status.restarts),
        "last end": status.last_end,
    }
    if status.state is SupervisorState.RUNNING:
        return Report(Level.WARN if status.restarts else Level.OK, "running", values)
    if status.state is SupervisorState.WAITING:
        return Report(Level.ERROR, f"{status.last_end}; it is started again", values)
    return Report(Level.WARN, status.last_end or "not started", values)


JOINT = "nao_joint: {}"
BATTERY, CURRENT, HEAD = "nao_power: Battery", "nao_power: Current", "nao_cpu: Head Temperature"
WLAN, ETHERNET = "nao_wlan: Status", "nao_ethernet: Status"

PARTS = {BATTERY: "battery", CURRENT: "power", HEAD: "cpu", WLAN: "wlan", ETHERNET: "ethernet"}
"""Report -> part of the robot that it is about; a joint is one by its name."""

TEMPERATURE = temperature_key("{}")
STIFFNESS = f"{PREFIX}{{}}/Hardness/Actuator/Value"
HEAD_TEMPERATURE = temperature_key("Head")
# The motor of both hips has its sensor under the name of the left one.
WITHOUT_SENSOR = frozenset({"RHipYawPitch"})
UNKNOWN = "unknown"
MEMORY = "ALMemory"
LOOK_PERIOD = 5.0
"""s between two looks at the body: heat and charge change slowly."""
LOOK_LIMIT = 1.0
"""s that the robot may take to answer."""

BATTERY_FLAGS = (
    "End off Discharge flag",
    "Near End Off Discharge flag",
    "Charge FET on",
    "Discharge FET on",
    "Accu learn flag",
    "Discharging flag",
    "Full Charge Flag",
    "Charge Flag",
    "Charge Temperature Alarm",
    "Over Charge Alarm",
    "Discharge Alarm",
    "Charge Over Current Alarm",
    "Discharge Over Current Alarm (14A)",
    "Discharge Over Current Alarm (6A)",
    "Discharge Temperature Alarm",
    "Power-Supply present",
)
"""Bits of the battery's status, lowest first, under the names that nao_robot gave them."""
ALARMS = tuple(name for name in BATTERY_FLAGS if name.endswith("Alarm") or "Alarm (" in name)


@dataclass(frozen=True)
class Thresholds:
    """Limits of warnings and errors."""

    warm: float = HOT_MOTOR  # joint temperature, degC
    hot: float = TOO_HOT_MOTOR  # joint temperature, degC
    head_warm: float = 100.0  # temperature of the processor, degC
    head_hot: float = 105.0  # temperature of the processor, degC
    low: float = 30.0  # charge of the battery, percent
    empty: float = 10.0  # charge of the battery, percent


def part_of(report: str) -> str:
    return PARTS.get(report) or report.split(": ")[-1]


def keys_of(joints: Sequence[str]) -> list[str]:
    """Keys of the robot's memory that the reports need."""
    keys = [
        pattern.format(joint) for joint in joints if joint not in WITHOUT_SENSOR for pattern in (TEMPERATURE, STIFFNESS)
    ]
    return [*keys, CHARGE, BATTERY_STATUS, AMPERES, HEAD_TEMPERATURE]


def body_reports(joints: Sequence[str], values: Mapping[str, Any], limits: Thresholds) -> dict[str, Report]:
    """Reports by name, from the values of the keys of `keys_of`; None for a missing one."""
    reports = {JOINT.format(joint): joint_report(joint, values, limits) for joint in joints}
    charge, flags = _number(values.get(CHARGE)), values.get(BATTERY_STATUS)
    reports[BATTERY] = battery_report(charge, flags if isinstance(flags, int) else None, limits)
    reports[CURRENT] = current_report(_number(values.get(AMPERES)))
    reports[HEAD] = head_report(_number(values.get(HEAD_TEMPERATURE)), limits)
    return reports


class BodyReporter:
    """Asks a robot how its body is, for one report of each module. `robot`: its proxies and connection."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._joints = JointNames(robot)
        self._last: Report | None = None
        self._looked = -math.inf

    def report(self) -> Report:
        """The NAO as a whole, as it was at the last look; what of it is amiss has its place in the message."""
        connection = self._robot.connection
        if connection.state != "connected" or connection.silent:
            return self._last or Report(Level.OK, UNKNOWN)  # that it does not answer is for another report
        if self._last is None or time.monotonic() - self._looked > LOOK_PERIOD:
            self._looked = time.monotonic()
            try:
                joints = self._joints.body
                keys = keys_of(joints)
                values = self._robot.proxy(MEMORY).call_async("getListData", keys).result(timeout=LOOK_LIMIT)
            except NaoError as error:
                return Report(Level.OK, f"{UNKNOWN}: {error}")
            self._last = summary(body_reports(joints, dict(zip(keys, values)), Thresholds()))
        return self._last


def summary(reports: Mapping[str, Report]) -> Report:
    """One report of all, as bad as the worst. Its message has no numbers: modules that look at other times agree."""
    amiss = sorted((name for name in reports if reports[name].level > Level.OK), key=lambda name: -reports[name].level)
    heat = {name: report.values.get("Temperature", "None") for name, report in reports.items()}
    measured = {name: float(value) for name, value in heat.items() if value != "None"}
    told = [BATTERY, CURRENT, HEAD, *sorted(measured, key=measured.__getitem__)[-1:], *amiss]
    values = {part_of(name): reports[name].message for name in told if name in reports}
    if not amiss:
        return Report(Level.OK, "well", values)
    words = [f"{part_of(name)} ({reports[name].state or reports[name].message})" for name in amiss]
    return Report(reports[amiss[0]].level, ", ".join(words), values)


def joint_report(joint: str, values: Mapping[str, Any], limits: Thresholds) -> Report:
    temperature = _number(values.get(TEMPERATURE.format(joint)))
    stiffness = _number(values.get(STIFFNESS.format(joint)))
    facts = {"Temperature": _text(temperature), "Stiffness": _text(stiffness)}
    if temperature is None:
        return Report(Level.OK, "No temperature sensor", facts)
    if temperature < limits.warm:
        return Report(Level.OK, f"Normal: {temperature:.1f} C", facts)
    if temperature < limits.hot:
        return Report(Level.WARN, f"Hot: {temperature:.1f} C", facts, "Hot")
    return Report(Level.ERROR, f"Too hot: {temperature:.1f} C", facts, "Too hot")


def battery_report(charge: float | None, flags: int | None, limits: Thresholds) -> Report:
    """Charge (0 to 1) and status of the battery."""
    facts = {"Percentage": UNKNOWN if charge is None else f"{100.0 * charge:g}"}
    for bit, name in enumerate(BATTERY_FLAGS):
        facts[name] = UNKNOWN if flags is None else str(bool(flags >> bit & 1))
    facts["Status"] = UNKNOWN if flags is None else bin(flags)
    if charge is None:
        return Report(Level.WARN, "the robot does not tell its charge", facts)
    percent = f"{100.0 * charge:.1f} %"
    alarms = [name for name in ALARMS if facts[name] == "True"]
    if alarms:
        return Report(Level.ERROR, f"{', '.join(alarms)} ({percent} left)", facts, ", ".join(alarms))
    if flags is not None and flags >> FULL_BIT & 1:
        return Report(Level.OK, f"Fully charged ({percent})", facts)
    if flags is not None and flags >> CHARGING_BIT & 1:
        return Report(Level.OK, f"Charging ({percent})", facts)
    if 100.0 * charge > limits.low:
        return Report(Level.OK, f"OK ({percent} left)", facts)
    if 100.0 * charge > limits.empty:
        return Report(Level.WARN, f"Low ({percent} left)", facts, "Low")
    return Report(Level.ERROR, f"Almost empty ({percent} left)", facts, "Almost empty")


def current_report(amperes: float | None) -> Report:
    """Current of the battery, above 0 while it is charged."""
    facts = {"Current": _text(amperes)}
    if amperes is None:
        return Report(Level.OK, UNKNOWN, facts)
    return Report(Level.OK, f"{amperes:.2f} A ({'charging' if amperes > 0.0 else 'discharging'})", facts)


def head_report(temperature: float | None, limits: Thresholds) -> Report:
    """Temperature of the processor in the head, degC."""
    facts = {"CPU Temperature": _text(temperature)}
    if temperature is None:
        return Report(Level.OK, UNKNOWN, facts)
    message = f"{temperature:.1f} C"
    if temperature < limits.head_warm:
        return Report(Level.OK, message, facts)
    if temperature < limits.head_hot:
        return Report(Level.WARN, message, facts, "Hot")
    return Report(Level.ERROR, message, facts, "Too hot")


def network_reports(services: Sequence[Any] | None) -> dict[str, Report]:
    """The robot's networks, from ALConnectionManager.services: of each a list of [property, value].

    None if the robot does not report them, as only newer ones do.
    """
    kinds = {WLAN: "wifi", ETHERNET: "ethernet"}
    if services is None:
        return {name: Report(Level.OK, "unknown: the robot does not tell") for name in kinds}
    networks = [_properties(service) for service in services]
    return {name: _network_report([n for n in networks if n.get("Type") == kind]) for name, kind in kinds.items()}


def _network_report(networks: Sequence[Mapping[str, Any]]) -> Report:
    connected = [n for n in networks if n.get("State") in ("online", "ready")]
    if not connected:
        return Report(Level.OK, "not connected")
    facts = {key: str(connected[0][key]) for key in ("Name", "State", "Strength") if key in connected[0]}
    return Report(Level.OK, f"connected: {facts.get('Name', 'without a name')}", facts)


def _properties(service: Any) -> dict[str, Any]:
    pairs = service if isinstance(service, (list, tuple)) else ()
    return {str(p[0]): p[1] for p in pairs if isinstance(p, (list, tuple)) and len(p) == 2}


def _number(value: Any) -> float | None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return None
    return float(value)


def _text(value: float | None) -> str:
    return "None" if value is None else f"{value:.3g}"
