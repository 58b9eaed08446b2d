"""ALLeds of the simulated robot: names of lights and groups, lights at once and over time."""

from __future__ import annotations

import threading
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body import led_animations
from nao_sim_bridge.body.leds import LedKeyframe, uniform
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.leds_layout import LedLayout
from nao_sim_bridge.naoqi.binding.arguments import known, number, numbers
from nao_sim_bridge.naoqi.binding.errors import NaoqiError


class LedNames:
    """Part of ALLeds: the robot's own LEDs and groups, and the groups that clients make."""

    def __init__(self, layout: LedLayout) -> None:
        self._layout = layout
        self._lock = threading.Lock()
        self._made: dict[str, tuple[str, ...]] = {}
        self._devices: dict[str, tuple[int, ...]] = {}  # of each made group

    def devices(self, name: str) -> tuple[int, ...]:
        """Indices of the devices behind a name; an UnknownName when there is no LED or group of it."""
        found = self._devices.get(name)
        if found is not None:
            return found
        self._check(name)
        return self._layout.devices_of(name)

    def createGroup(self, name: str, members: list[str]) -> None:
        """Define a group, or define it anew; not one of the robot's own, empty, or in itself."""
        if name in self._layout.groups or name in self._layout.short_names or not name:
            raise NaoqiError(f"the name {name!r} is taken by the robot's own LEDs")
        if not members:
            raise NaoqiError(f"group {name!r} has no members")
        require_few("ledNames", len(members), "led_members")
        with self._lock:
            require_few("groupName", len({*self._made, name}), "led_groups")
            for member in members:
                if member != name:
                    self._check(member)
            made = {**self._made, name: tuple(members)}
            self._devices = _Expansion(self._layout, made).devices  # those that hold this one have changed with it
            self._made = made

    def listGroups(self) -> list[str]:
        return sorted([*self._layout.groups, *self._made])

    def listGroup(self, group: str) -> list[str]:
        if group in self._made:
            return list(self._made[group])
        if group not in self._layout.groups:
            raise UnknownName("group", group, self.listGroups())
        return list(self._layout.groups[group])

    def listLEDs(self) -> list[str]:
        return list(self._layout.short_names)

    def listLED(self, name: str) -> list[str]:
        short = self._layout.short_names
        return [self._layout.devices[i] for i in short[known(name, "LED", short)]]

    def _check(self, name: str) -> None:
        tables = (self._made, self._layout.groups, self._layout.short_names, self._layout.device_index)
        if not any(name in names for names in tables):
            raise UnknownName("LED or group", name, [n for names in tables for n in names])


class _Expansion:
    """The devices of each made group, each group looked at once; a NaoqiError when one holds itself."""

    def __init__(self, layout: LedLayout, made: Mapping[str, Sequence[str]]) -> None:
        self.devices: dict[str, tuple[int, ...]] = {}
        self._layout = layout
        self._made = made
        self._above: set[str] = set()
        for name in made:
            self._of(name)

    def _of(self, name: str) -> tuple[int, ...]:
        if name not in self._made:
            return self._layout.devices_of(name)
        if name in self._above:
            raise NaoqiError(f"group {name!r} would hold itself")
        if name not in self.devices:
            self._above.add(name)
            found: dict[int, None] = {}
            for member in self._made[name]:
                found.update(dict.fromkeys(self._of(member)))
            self._above.discard(name)
            self.devices[name] = tuple(found)
        return self.devices[name]


class ALLeds:
    """Part of ALLeds: lights at once, and over time."""

    def __init__(self, runner: RobotRunner) -> None:
        self._simulation = runner.simulation
        self._runner = runner
        self._layout = runner.simulation.led_layout
        self.names = LedNames(self._layout)

    def on(self, name: str) -> Task:
        return self._set(uniform(self.names.devices(name), 1.0))

    def off(self, name: str) -> Task:
        return self._set(uniform(self.names.devices(name), 0.0))

    def setIntensity(self, name: str, intensity: float) -> Task:
        return self._set(uniform(self.names.devices(name), number(intensity, "intensity", 0.0, 1.0)))

    def reset(self, name: str) -> Task:
        default = led_animations.power_on(self._layout)
        return self._set({index: default[index] for index in self.names.devices(name)})

    def getIntensity(self, name: str) -> Any:
        values = self._simulation.robot.leds.values
        found = [values[index] for index in self.names.devices(name)]
        return found[0] if len(found) == 1 else found

    def fade(self, name: str, intensity: float, duration: float) -> Task:
        target = uniform(self.names.devices(name), number(intensity, "intensity", 0.0, 1.0))
        return self._fade("fade", target, number(duration, "duration", 0.0))

    def fadeRGB(self, name: str, *args: Any) -> Task:
        *color, duration = args
        target = led_animations.colored(self._layout, self.names.devices(name), _color(color))
        return self._fade("fadeRGB", target, number(duration, "duration", 0.0))

    def fadeListRGB(self, name: str, colors: Any, times: Any) -> Task:
        devices = self.names.devices(name)
        times = numbers(times, "timeList", 0.0)
        require_few("timeList", len(times), "colours")
        if not isinstance(colors, (list, tuple)) or len(colors) != len(times) or not times:
            raise BadValue("rgbList", colors, f"as many colours as times, {len(times)}, at least 1")
        if any(b <= a for a, b in zip(times, times[1:])):
            raise BadValue("timeList", times, "rising times")
        lit = (led_animations.colored(self._layout, devices, _color([color])) for color in colors)
        frames = [LedKeyframe(time, target) for time, target in zip(times, lit)]
        return self._animate("fadeListRGB", lambda: frames)

    def randomEyes(self, duration: float) -> Task:
        duration = number(duration, "duration", 0.0)
        eyes = lambda: led_animations.random_eyes(self._layout, duration, self._simulation.robot.random)  # noqa: E731
        return self._animate("randomEyes", eyes, step=True)

    def rasta(self, duration: float) -> Task:
        duration = number(duration, "duration", 0.0)
        return self._animate("rasta", lambda: led_animations.rasta(self._layout, duration), step=True)

    def rotateEyes(self, rgb: int, rotation: float, duration: float) -> Task:
        color = _color([rgb])
        if not number(rotation, "timeForRotation", 0.0) > 0.0:
            raise BadValue("timeForRotation", rotation, "above 0")
        duration = number(duration, "totalDuration", 0.0)
        eyes = lambda: led_animations.rotate_eyes(self._layout, color, rotation, duration)  # noqa: E731
        return self._animate("rotateEyes", eyes, step=True)

    def earLedsSetAngle(self, degrees: int, duration: float, leave_on: bool) -> Task:
        duration = number(duration, "duration", 0.0)
        ears = lambda: led_animations.ear_angle(self._layout, degrees, duration, leave_on)  # noqa: E731
        return self._animate("earLedsSetAngle", ears, step=True)

    def _set(self, values: Mapping[int, float]) -> Task:
        return self._runner.execute(lambda: self._simulation.robot.leds.set(values), "setIntensity")

    def _fade(self, name: str, target: Mapping[int, float], duration: float) -> Task:
        if duration == 0.0:
            return self._set(target)
        return self._animate(name, lambda: [LedKeyframe(duration, target)])

    def _animate(self, name: str, frames: Callable[[], Sequence[LedKeyframe]], step: bool = False) -> Task:
        return self._runner.execute(
            lambda: self._simulation.robot.leds.animate(name, frames(), self._simulation.robot.time, step), name
        )


def _color(color: Sequence[Any]) -> led_animations.Color:
    """A colour as fadeRGB takes it: [name], [0x00RRGGBB] or [red, green, blue] in 0..1."""
    if len(color) == 3:
        return numbers(color, "colour", 0.0, 1.0)
    value = color[0]
    if isinstance(value, str):
        return led_animations.COLOR_NAMES[known(value, "colour", led_animations.COLOR_NAMES)]
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= 0xFFFFFF:
        raise NaoqiError(f"colour is {value!r}, allowed is 0x000000 to 0xFFFFFF")
    return led_animations.color_of_int(value)


def parts(runner: RobotRunner) -> list[Any]:
    """The objects that together have the methods of ALLeds."""
    lights = ALLeds(runner)
    return [lights, lights.names]
