"""/diagnostics, apart from the body: last answer of the robot, speed of the simulation, recordings. Pure.

Times are arguments, s of this computer.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from ...ros.health import RECORDINGS, SILENT_FOR

SIMULATION, ASKED, REACHED = "nao_sim: Simulation", "speed asked", "speed reached"
"""Report of the simulator, and its values: simulated seconds per second of the computer."""


@dataclass(frozen=True)
class SimulatedSpeed:
    """Simulated seconds per second of the computer that runs the simulator."""

    asked: float  # infinite: as fast as possible
    reached: float
    heard: float  # time of the report


@dataclass(frozen=True)
class ServerRecordings:
    """The recordings of one server."""

    names: frozenset[str]
    heard: float  # time of the report


class Diagnosis:
    """The newest reports.

    Attributes:
        answered: Time of the robot's last answer; None before the first report.
        speed: None without a simulator, and while its time stands still.
        recordings: Name of a server -> its recordings.
    """

    def __init__(self) -> None:
        self._answered: dict[str, float] = {}  # name of a report -> last answer, as the newest of that name has it
        self.speed: SimulatedSpeed | None = None
        self.recordings: Mapping[str, ServerRecordings] = {}

    @property
    def answered(self) -> float | None:
        return max(self._answered.values(), default=None)

    def take(self, statuses: Iterable[Any], address: str, now: float) -> None:
        """Take the reports of a message. `address`: of the robot, `ip:port`; empty: not known."""
        for status in statuses:
            values = {pair.key: pair.value for pair in status.values}
            if status.name == SIMULATION:
                asked, reached = _number(values.get(ASKED)), _number(values.get(REACHED))
                known = not (math.isnan(asked) or math.isnan(reached))
                self.speed = SimulatedSpeed(asked, reached, now) if known else None
            if not address or status.hardware_id != address:
                continue
            silent = _number(values.get(SILENT_FOR))
            if not math.isnan(silent) and values.get("state") in ("connected", "silent"):
                # One that has waited in vain takes back what it has reported before.
                self._answered = {**self._answered, status.name: now - silent}
            if RECORDINGS in values:
                server = status.name.rpartition(": ")[2].rpartition(" ")[0]
                running = ServerRecordings(frozenset(json.loads(values[RECORDINGS])), now)
                self.recordings = {**self.recordings, server: running}


def _number(text: Any) -> float:
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan
