"""LEDs of one robot: ALLeds, their values in ALMemory, what these mean for lights, and calls that bring them back."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Mapping, Tuple

from naoqi.errors import NaoError
from naoqi.limits import CLEAN_UP_LIMIT

from ..core.chain import Part
from ..core.lights_and_colours import COLOUR_PARTS, LightNames, colour_part
from ..core.memory_functions import MEMORY
from ..core.nao_facts import PREFIX
from ..nao_basic import NaoBasic

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


LEDS = "ALLeds"
DECIMALS = 6


class LedAccess(Part):
    """Names, values and calls of the LEDs. Used from the thread that executes goals; checks without a goal have a copy.

    The names are read from the robot when they are first needed and after each reconnection, for the robot
    behind a new connection may be another one, and does not know the groups that were made on the last one.
    """

    def __init__(self, module: NaoBasic) -> None:
        self._robot = module.robot
        self._call, self._call_all, self._call_now = module.call, module.call_all, module.call_now
        self._names: LightNames | None = None
        self._generation: int | None = None

    @property
    def names(self) -> LightNames:
        """Names of lights and groups, read from the robot when they are not known yet.

        Raises NaoError if the robot cannot be asked.
        """
        if self._names is None or self._generation != self._robot.connection.generation:
            return self.read_names()
        return self._names

    @property
    def groups(self) -> Mapping[str, tuple[str, ...]]:
        """Name of each group -> names of the lights in it."""
        return self.names.groups

    def read_names(self) -> LightNames:
        """Read the names of lights and groups from the robot. Raises NaoError if the robot cannot be asked."""
        generation = self._robot.connection.generation
        proxy = self.proxy
        short_names = self._call(proxy, "listLEDs")
        group_names = self._call(proxy, "listGroups")
        # All at once: one after the other, well over a hundred calls take a second on a wireless network.
        devices = self._call_all(proxy, "listLED", [(name,) for name in short_names])
        members = self._call_all(proxy, "listGroup", [(name,) for name in group_names])
        self._names = LightNames.from_listings(dict(zip(short_names, devices)), dict(zip(group_names, members)))
        self._generation = generation
        return self._names

    def create_group(self, name: str, lights: Sequence[str]) -> None:
        """Make a group on the robot; groups in it are resolved, for ALLeds promises to take lights only."""
        names = self.names.with_group(name, lights)
        self._call(self.proxy, "createGroup", name, list(names.groups[name]))
        self._names = names

    def read(self, lights: Iterable[str]) -> Values:
        """Values of the LEDs behind lights and groups, 0..1.

        Raises NaoError if the robot cannot be asked or does not tell the value of an LED.
        """
        return self._read(self.names.devices(lights), self._call)

    def intensities_now(self, lights: Iterable[str]) -> dict[str, float]:
        """Intensities of the single lights behind lights and groups; preemption does not interrupt this.

        Raises NaoError if the robot cannot be asked or does not tell the value of an LED.
        """
        names = self._names  # not read again: that could be interrupted
        if names is None:
            return {}
        values = self._read(names.devices(lights), self._call_now)
        return {light: light_intensity(names, light, values) for light in names.expand(lights)}

    def _read(self, devices: Sequence[str], call: Callable[..., Any]) -> Values:
        values = call(self._robot.proxy(MEMORY), "getListData", memory_keys(devices))
        for device, value in zip(devices, values):
            if not isinstance(value, (int, float)):
                raise NaoError(f"the robot's memory holds {value!r} as the value of LED {device!r}")
        # The robot keeps 32-bit numbers: 0.3 comes back as 0.30000001192092896.
        return {device: round(value, DECIMALS) for device, value in zip(devices, values)}

    def restorer(self, lights: Sequence[str]) -> Callable[[], None]:
        """A function that gives lights and groups the values back that they have now."""
        names = self.names
        values = self.read(lights)

        def restore() -> None:
            proxy = self.proxy
            pending = [proxy.call_async(method, *args) for method, args in restoring_calls(names, lights, values)]
            for call in pending:
                call.result(timeout=CLEAN_UP_LIMIT)

        return restore

    @property
    def proxy(self) -> Any:
        return self._robot.proxy(LEDS)
