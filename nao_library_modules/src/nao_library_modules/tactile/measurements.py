"""What a goal has felt so far, for its result."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from genpy import Time
from sensor_msgs.msg import BatteryState

from nao_library_msgs.msg import TouchBinding

from .touch import Contact


class Measurements:
    """What the functions of one chain felt."""

    def __init__(self) -> None:
        self.touched: list[Contact] = []
        self.sonars: list[tuple[str, float]] = []
        self.weights: list[tuple[str, float]] = []
        self.batteries: list[BatteryState] = []
        self.heat: list[tuple[str, float, int]] = []
        self.fell = False
        self.bindings: list[TouchBinding] = []

    def touch(self, contacts: Sequence[Contact]) -> list[str]:
        """Note what was touched, and answer the names."""
        self.touched += contacts
        return [contact.name for contact in contacts]

    def fill(self, result: Any) -> None:
        result.touched = [contact.name for contact in self.touched]
        result.touch_times = [Time.from_sec(contact.begin) for contact in self.touched]
        result.sonar_names, result.sonar = _columns(self.sonars, 2)
        result.fsr_names, result.fsr = _columns(self.weights, 2)
        result.battery = self.batteries
        result.devices, result.temperatures, result.heat = _columns(self.heat, 3)
        result.fell = self.fell
        result.bindings = self.bindings


def _columns(rows: Sequence[tuple[Any, ...]], count: int) -> tuple[list[Any], ...]:
    return tuple([row[place] for row in rows] for place in range(count))
