"""What the lights of the robot show, read in one go. No ROS."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...base.once_per_connection import OncePerConnection
from ...nao.body_devices import PREFIX
from ...nao.light_names import COLOUR_PARTS, colour_part
from .blinking import Colour

LEDS = "ALLeds"
MEMORY = "ALMemory"
BLUE_DEVICES = "Ears/"
"""What the names of LEDs begin with that are blue; those that have no colour in their names and are not are white."""


class LedReader:
    """Reads the lights of one robot. For one thread."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._names = OncePerConnection(robot, self._read_names)

    def read(self) -> dict[str, Colour]:
        """Colour of each light by its short name. Raises NaoError if the robot cannot be asked."""
        lights = self._names()
        devices = [device for light in lights.values() for device in light]
        values = self._robot.proxy(MEMORY).call_async("getListData", [PREFIX + device for device in devices])
        found = values.result(timeout=ANSWER_LIMIT)
        if len(found) != len(devices):
            raise NaoError(f"the robot's memory holds {len(found)} values of {len(devices)} LEDs")
        return shown(lights, dict(zip(devices, found)))

    def _read_names(self) -> dict[str, tuple[str, ...]]:
        """LEDs of each light; all at once, for one after the other takes a second on a wireless network."""
        leds = self._robot.proxy(LEDS)
        names = leds.call_async("listLEDs").result(timeout=ANSWER_LIMIT)
        calls = [leds.call_async("listLED", name) for name in names]
        return joined({name: tuple(call.result(timeout=ANSWER_LIMIT)) for name, call in zip(names, calls)})


def joined(lights: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
    """Lights as one sees them: ChestLedsRed, ChestLedsGreen and ChestLedsBlue are one, ChestLeds."""
    found: dict[str, tuple[str, ...]] = {}
    for name, devices in lights.items():
        part = next((part for part in COLOUR_PARTS if name.endswith(part)), "")
        whole = name[: len(name) - len(part)]
        found[whole] = (*found.get(whole, ()), *devices)
    return found


def shown(lights: Mapping[str, tuple[str, ...]], values: Mapping[str, Any]) -> dict[str, Colour]:
    """Colour of each light, red, green and blue in 0..1.

    `lights`: name -> its LEDs. `values`: LED -> intensity 0..1; what is no number counts as 0.
    """
    return {
        name: _colour({device: _number(values.get(device)) for device in devices}) for name, devices in lights.items()
    }


def _colour(values: Mapping[str, float]) -> Colour:
    parts = {colour_part(device): value for device, value in values.items()}
    if any(part in parts for part in COLOUR_PARTS):
        red, green, blue = (parts.get(part, 0.0) for part in COLOUR_PARTS)
        return red, green, blue
    strongest = max(values.values(), default=0.0)
    if all(device.startswith(BLUE_DEVICES) for device in values):
        return 0.0, 0.0, strongest
    return strongest, strongest, strongest


def _number(value: Any) -> float:
    return min(max(float(value), 0.0), 1.0) if isinstance(value, (int, float)) else 0.0
