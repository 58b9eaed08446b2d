"""The module for the LEDs: setting, fading, animations, reading back, and going back to what was before."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import repeat
from typing import Any

from nao_library_actions.msg import NaoLedAction

from ..core.chain import checked_by
from ..core.lights_and_colours import to_integer
from ..core.processes import LaunchPath
from ..nao_basic import NaoBasic
from .led_access import LedAccess, mean_colour, mean_intensity
from .light_fields import (
    Angle,
    AnimationTime,
    ColouredLights,
    Colours,
    ColourSteps,
    ColourText,
    ColourTexts,
    FadeTime,
    Group,
    Intensities,
    LeaveOn,
    Lights,
    Members,
    Moments,
    NewGroup,
    OneColour,
    Revert,
    TurnTime,
    check_colours,
    check_fade_list,
    check_group,
    check_intensities,
    check_lights,
    check_new_group,
    check_readable_colours,
    check_rotation,
    colour_steps,
    colours,
    intensities,
    one_colour,
)

EYES = "FaceLeds"
EARS = "EarLeds"
ALL = "AllLeds"


class NaoLights(NaoBasic):
    """LED goals: every function of ALLeds, setColor, getColor, and `revert`.

    Lights and groups are used alike. Durations are s, intensities 0..1, colours red, green, blue.

    Attributes:
        leds: The LEDs of the robot; `leds.groups` relates each group to the lights in it.

    ROS API:
        Action `NaoLights` (nao_library_actions/NaoLedAction) and what NaoBasic offers.
    """

    typed_answers = frozenset({"getIntensity", "getColor"})

    def __init__(
        self, ip: str, port: int, autostart: bool = False, launchpath: LaunchPath | None = None, **options: Any
    ) -> None:
        super().__init__(ip, port, autostart, launchpath, **options)
        self.leds = LedAccess(self)
        self.add_parts(self.leds)
        self._touched: dict[str, None] = {}  # an ordered set of lights and groups
        self.serve("NaoLights", NaoLedAction)

    # Functions: parameters are fields of LedFunction

    @checked_by(check_lights)
    def on(self, lights: Lights, revert: Revert) -> None:
        """Light up fully."""
        self._act(lights, revert, "on", self._each(lights, repeat(())))

    @checked_by(check_lights)
    def off(self, lights: Lights, revert: Revert) -> None:
        """Switch off."""
        self._act(lights, revert, "off", self._each(lights, repeat(())))

    @checked_by(check_lights)
    def reset(self, lights: Lights, revert: Revert) -> None:
        """Bring lights to the robot's default."""
        self._act(lights, revert, "reset", self._each(lights, repeat(())))

    @checked_by(check_intensities)
    def set_intensity(self, lights: Lights, i_values: Intensities, revert: Revert) -> None:
        """Set intensities at once; one value for all lights, or one a light."""
        self._act(lights, revert, "setIntensity", self._each(lights, zip(intensities(lights, i_values))))

    @checked_by(check_lights)
    def get_intensity(self, lights: Lights) -> list[float]:
        """Intensity of each light: of a coloured one its strongest LED, of a group the mean of its lights."""
        self._touch(lights)
        values = self.leds.read(lights)
        return [mean_intensity(self.leds.names, light, values) for light in lights]

    @checked_by(check_colours)
    def set_color(self, lights: ColouredLights, i_values: Colours, str_param: ColourText, revert: Revert) -> None:
        """Set colours at once; one for all lights, or one a light."""
        fades = [(*colour, 0.0) for colour in colours(lights, i_values, str_param)]
        self._act(lights, revert, "fadeRGB", self._each(lights, fades))

    @checked_by(check_readable_colours)
    def get_color(self, lights: ColouredLights) -> list[list[float]]:
        """Red, green and blue of each light, of a group the mean of its lights."""
        self._touch(lights)
        values = self.leds.read(lights)
        return [mean_colour(self.leds.names, light, values) for light in lights]

    @checked_by(check_intensities)
    def fade(self, lights: Lights, i_values: Intensities, duration: FadeTime, revert: Revert) -> None:
        """Fade to intensities, all lights together."""
        fades = [(value, duration) for value in intensities(lights, i_values)]
        self._act(lights, revert, "fade", self._each(lights, fades), together=duration > 0.0)

    @checked_by(check_colours)
    def fade_rgb(
        self, lights: ColouredLights, i_values: Colours, str_param: ColourText, duration: FadeTime, revert: Revert
    ) -> None:
        """Fade to colours, all lights together."""
        fades = [(*colour, duration) for colour in colours(lights, i_values, str_param)]
        self._act(lights, revert, "fadeRGB", self._each(lights, fades), together=duration > 0.0)

    @checked_by(check_fade_list)
    def fade_list_rgb(
        self, lights: ColouredLights, i_values: ColourSteps, str_param: ColourTexts, times: Moments, revert: Revert
    ) -> None:
        """Fade through colours, each reached at its time, all lights together."""
        steps = [to_integer(colour) for colour in colour_steps(times, i_values, str_param)]
        self._act(lights, revert, "fadeListRGB", self._each(lights, repeat((steps, list(times)))), together=True)

    def random_eyes(self, duration: AnimationTime, revert: Revert) -> None:
        """Random colours in the eyes."""
        self._act([EYES], revert, "randomEyes", [(duration,)])

    def rasta(self, duration: AnimationTime, revert: Revert) -> None:
        """Green, yellow and red all over the body."""
        self._act([ALL], revert, "rasta", [(duration,)])

    @checked_by(check_rotation)
    def rotate_eyes(
        self,
        i_values: OneColour,
        str_param: ColourText,
        rotation_time: TurnTime,
        duration: AnimationTime,
        revert: Revert,
    ) -> None:
        """A colour that goes round in the eyes."""
        rgb = to_integer(one_colour(i_values, str_param))
        self._act([EYES], revert, "rotateEyes", [(rgb, rotation_time, duration)])

    def ear_leds_set_angle(self, angle: Angle, duration: AnimationTime, leave_on: LeaveOn, revert: Revert) -> None:
        """Show a direction on the ears."""
        self._act([EARS], revert, "earLedsSetAngle", [(angle, duration, leave_on)])

    @checked_by(check_new_group)
    def create_group(self, str_param: NewGroup, lights: Members) -> None:
        """Make a group of lights and groups, used like any other."""
        self.leds.create_group(str_param.strip(), lights)

    def list_leds(self) -> list[str]:
        """Names of the single lights."""
        return list(self.call(self.leds.proxy, "listLEDs"))

    @checked_by(check_group)
    def list_led(self, str_param: Group) -> list[str]:
        """LEDs of a single light: the keys of the robot's memory that hold their intensities."""
        return self.leds.names.devices([str_param.strip()])

    @checked_by(check_group)
    def list_group(self, str_param: Group) -> list[str]:
        """Names of the lights in a group."""
        return self.leds.names.expand([str_param.strip()])

    def list_groups(self) -> list[str]:
        """Names of the groups."""
        return list(self.call(self.leds.proxy, "listGroups"))

    function_table = {
        "on": on,
        "off": off,
        "setIntensity": set_intensity,
        "getIntensity": get_intensity,
        "setColor": set_color,
        "getColor": get_color,
        "fade": fade,
        "fadeRGB": fade_rgb,
        "fadeListRGB": fade_list_rgb,
        "randomEyes": random_eyes,
        "rasta": rasta,
        "rotateEyes": rotate_eyes,
        "earLedsSetAngle": ear_leds_set_angle,
        "reset": reset,
        "createGroup": create_group,
        "listLEDs": list_leds,
        "listLED": list_led,
        "listGroup": list_group,
        "listGroups": list_groups,
    }

    def _touch(self, lights: Sequence[str]) -> None:
        """Note lights for the result; their names are read now if need be, for at its end nothing waits."""
        self.leds.names.expand(lights)
        self._touched.update(dict.fromkeys(lights))

    def _each(self, lights: Sequence[str], more: Iterable[tuple[Any, ...]]) -> list[tuple[Any, ...]]:
        """Arguments of methods that begin with a light: each by ALLeds' own name for it, and what follows."""
        return [(self.leds.names.of_robot(light), *rest) for light, rest in zip(lights, more)]

    def _act(
        self,
        lights: Sequence[str],
        revert: bool,
        method: str,
        arguments: Sequence[tuple[Any, ...]],
        together: bool = False,
    ) -> None:
        """Keep what `revert` needs, then call ALLeds once for each tuple of arguments.

        Args:
            lights: Lights and groups that change.
            revert: Whether they go back afterwards.
            method: Method of ALLeds.
            together: Whether the calls run at the same time. Calls that take no time are made in order, so
                that of two that set the same LED the later one counts.
        """
        self._touch(lights)
        if revert:
            self.after_wait(self.leds.restorer(lights))
        if together:
            self.call_all(self.leds.proxy, method, arguments)
            return
        for values in arguments:
            self.call(self.leds.proxy, method, *values)

    # Results

    def begin_chain(self) -> None:
        """Forget what the last chain touched."""
        self._touched.clear()

    def fill_result(self, result: Any, outcomes: Sequence[Any]) -> None:
        """Add the lights that the chain touched or asked for, with what the robot reports now."""
        super().fill_result(result, outcomes)
        if self._touched:
            intensities_at_end = self.leds.intensities_now(list(self._touched))
            result.lights = list(intensities_at_end)
            result.intensities = list(intensities_at_end.values())
