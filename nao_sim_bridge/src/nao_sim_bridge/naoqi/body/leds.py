"""ALLeds of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body import led_animations
from nao_sim_bridge.body.leds import LedKeyframe, uniform
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import number, numbers
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.body.led_names import LedNames


class ALLeds:
    """ALLeds as the simulated robot offers it."""

    def __init__(self, simulation: Simulation, runner: SimulationRunner) -> None:
        self._simulation = simulation
        self._runner = runner
        self._names = LedNames(simulation.led_layout)

    # --- at once --------------------------------------------------------------------------------------------------

    def on(self, name: str) -> Task:
        return self._set(uniform(self._names.devices(name), 1.0))

    def off(self, name: str) -> Task:
        return self._set(uniform(self._names.devices(name), 0.0))

    def setIntensity(self, name: str, intensity: float) -> Task:
        return self._set(uniform(self._names.devices(name), number(intensity, "intensity", 0.0, 1.0)))

    def reset(self, name: str) -> Task:
        default = led_animations.power_on(self._simulation.led_layout)
        return self._set({index: default[index] for index in self._names.devices(name)})

    def getIntensity(self, name: str) -> Any:
        values = self._simulation.robot.leds.values
        found = [values[index] for index in self._names.devices(name)]
        return found[0] if len(found) == 1 else found

    # --- over time ------------------------------------------------------------------------------------------------

    def fade(self, name: str, intensity: float, duration: float) -> Task:
        target = uniform(self._names.devices(name), number(intensity, "intensity", 0.0, 1.0))
        return self._fade("fade", target, number(duration, "duration", 0.0))

    def fadeRGB(self, name: str, *args: Any) -> Task:
        *color, duration = args
        target = led_animations.colored(self._simulation.led_layout, self._names.devices(name), _color(color))
        return self._fade("fadeRGB", target, number(duration, "duration", 0.0))

    def fadeListRGB(self, name: str, colors: Any, times: Any) -> Task:
        devices = self._names.devices(name)
        times = numbers(times, "timeList", 0.0)
        require_few("timeList", len(times), "colours")
        if not isinstance(colors, (list, tuple)) or len(colors) != len(times) or not times:
            raise BadValue("rgbList", colors, f"as many colours as times, {len(times)}, at least 1")
        if any(b <= a for a, b in zip(times, times[1:])):
            raise BadValue("timeList", times, "rising times")
        layout = self._simulation.led_layout
        frames = [
            LedKeyframe(time, led_animations.colored(layout, devices, _color([color])))
            for time, color in zip(times, colors)
        ]
        return self._animate("fadeListRGB", lambda: frames)

    def randomEyes(self, duration: float) -> Task:
        duration = number(duration, "duration", 0.0)
        return self._animate(
            "randomEyes",
            lambda: led_animations.random_eyes(self._simulation.led_layout, duration, self._simulation.robot.random),
            step=True,
        )

    def rasta(self, duration: float) -> Task:
        duration = number(duration, "duration", 0.0)
        return self._animate("rasta", lambda: led_animations.rasta(self._simulation.led_layout, duration), step=True)

    def rotateEyes(self, rgb: int, rotation: float, duration: float) -> Task:
        color = _color([rgb])
        if not number(rotation, "timeForRotation", 0.0) > 0.0:
            raise BadValue("timeForRotation", rotation, "above 0")
        duration = number(duration, "totalDuration", 0.0)
        layout = self._simulation.led_layout
        return self._animate(
            "rotateEyes", lambda: led_animations.rotate_eyes(layout, color, rotation, duration), step=True
        )

    def earLedsSetAngle(self, degrees: int, duration: float, leave_on: bool) -> Task:
        duration = number(duration, "duration", 0.0)
        layout = self._simulation.led_layout
        return self._animate(
            "earLedsSetAngle", lambda: led_animations.ear_angle(layout, degrees, duration, leave_on), step=True
        )

    # --- names ----------------------------------------------------------------------------------------------------

    def createGroup(self, name: str, members: list[str]) -> None:
        self._names.make_group(name, members)

    def listGroup(self, name: str) -> list[str]:
        return self._names.members(name)

    def listGroups(self) -> list[str]:
        return self._names.groups()

    def listLED(self, name: str) -> list[str]:
        return self._names.device_names(name)

    def listLEDs(self) -> list[str]:
        return self._names.short_names()

    # --- inside ---------------------------------------------------------------------------------------------------

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
        if value not in led_animations.COLOR_NAMES:
            raise UnknownName("colour", value, led_animations.COLOR_NAMES)
        return led_animations.COLOR_NAMES[value]
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= 0xFFFFFF:
        raise NaoqiError(f"colour is {value!r}, allowed is 0x000000 to 0xFFFFFF")
    return led_animations.color_of_int(value)
