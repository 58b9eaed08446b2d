"""Values of LEDs: what they mean for lights and groups, and the calls that bring them back. Pure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, Mapping, Tuple

from ..nao.body_devices import PREFIX
from ..nao.light_names import COLOUR_PARTS, LightNames, colour_part

Values = Mapping[str, float]
"""Device name -> intensity 0..1."""

Call = Tuple[str, Tuple[Any, ...]]
"""Method of ALLeds and its arguments."""


def memory_keys(devices: Iterable[str]) -> list[str]:
    """Keys of the robot's memory that hold the values of LEDs."""
    return [PREFIX + device for device in devices]


def light_intensity(names: LightNames, light: str, values: Values) -> float:
    """Intensity of a single light, 0..1: that of its strongest LED."""
    return max(values[device] for device in names.devices([light]))


def mean_intensity(names: LightNames, name: str, values: Values) -> float:
    """Intensity of a light, or the mean over the lights of a group, 0..1."""
    return _mean([light_intensity(names, light, values) for light in names.expand([name])])


def mean_colour(names: LightNames, name: str, values: Values) -> list[float]:
    """Red, green and blue of a light, or the means over a group, each 0..1.

    LEDs of one colour that belong to the group have no say in it.
    """
    parts: dict[str, list[float]] = {part: [] for part in COLOUR_PARTS}
    for device in names.devices([name]):
        part = colour_part(device)
        if part:
            parts[part].append(values[device])
    return [_mean(parts[part]) for part in COLOUR_PARTS]


def _mean(numbers: Sequence[float]) -> float:
    # Equal numbers have themselves as mean, without rounding.
    return numbers[0] if len(set(numbers)) == 1 else math.fsum(numbers) / len(numbers)


def restoring_calls(names: LightNames, lights: Iterable[str], values: Values) -> list[Call]:
    """Calls of ALLeds that give single lights the values they had.

    `lights`: lights and groups to restore. `values`: values of all their LEDs. Returns method and arguments of each
    call. They may be made in any order: no two touch the same light.
    """
    calls: list[Call] = []
    for light in names.expand(lights):
        devices = names.devices([light])
        parts = {colour_part(device): values[device] for device in devices}
        if set(parts) == set(COLOUR_PARTS) and len(devices) == len(COLOUR_PARTS):
            calls.append(("fadeRGB", (light, *(parts[part] for part in COLOUR_PARTS), 0.0)))
        elif len(devices) == 1:
            calls.append(("setIntensity", (light, values[devices[0]])))
        else:
            calls.extend(("setIntensity", (device, values[device])) for device in devices)
    return calls
