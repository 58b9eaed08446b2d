"""What the fields of a LedFunction mean, what they may hold, and checks of light functions before a chain begins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, List, Protocol, TypeVar

from ..core.describe import LIGHTS
from ..core.errors import BadGoal
from ..core.fields import Annotated, flag, free, limit, moments, number, numbers, text
from ..core.lights_and_colours import ALLOWED, Colour, LightNames, UnknownLight, is_colour, named_colours, parse_colour
from .led_access import LedAccess

COLOURS = limit("colours")


def _require_colours(name: str, words: Sequence[str]) -> None:
    for word in words:
        if word.strip() or len(words) > 1:
            parse_colour(word, name)


_LIGHTS = free(
    "lights and groups by the robot's names or in plain words: Eyes, LeftEar, Chest",
    allowed="lights and groups of the robot, at least one",
    asked=LIGHTS,
)
_COLOUR = free(
    "a colour by name, '#RRGGBB' or '0xRRGGBB'; empty: i_values has it",
    allowed=ALLOWED,
    choices=tuple(named_colours()),
    check=lambda name, text: _require_colours(name, [text]),
)
_SHARES = numbers((0.0, 1.0), "", allowed="each within 0..1")

Lights = Annotated[List[str], _LIGHTS]
ColouredLights = Annotated[List[str], _LIGHTS.but(allowed="lights and groups with red, green and blue LEDs")]
Members = Annotated[List[str], _LIGHTS.but(help="lights and groups that make the group")]
Intensities = Annotated[List[float], _SHARES.but(help="intensities: one for all lights, or one a light")]
Colours = Annotated[List[float], _SHARES.but(help="red, green, blue: for all lights, or three a light")]
ColourSteps = Annotated[List[float], _SHARES.but(help="red, green, blue of each moment")]
OneColour = Annotated[List[float], _SHARES.but(help="red, green, blue")]
ColourText = Annotated[str, _COLOUR]
ColourTexts = Annotated[
    str,
    _COLOUR.but(
        help="colours separated by commas, one a moment; empty: i_values has them",
        check=lambda name, text: _require_colours(name, text.split(",")),
    ),
]
FadeTime = Annotated[float, number("duration", "length of the fade", zero="")]
AnimationTime = Annotated[float, number("duration", "length of the animation")]
TurnTime = Annotated[float, number("duration", "time of one turn")]
Moments = Annotated[List[float], moments("duration", "when each colour is reached, from the start", COLOURS)]
Angle = Annotated[int, number((0, 360), "direction: 0 up, 90 front, 180 down, 270 back", "deg")]
LeaveOn = Annotated[bool, flag("whether the LEDs stay lit at the end")]
Revert = Annotated[bool, flag("whether all that changed gets its former values back after `time`")]
NewGroup = Annotated[str, text("the name of the new group", "name of the new group")]
Group = Annotated[str, free("name of a light or group", allowed="a light or group of the robot", asked=LIGHTS)]


Value = TypeVar("Value")


def require_lights(names: LightNames, lights: Sequence[str]) -> None:
    """Check that there is at least one light and that all are known."""
    if not lights:
        raise BadGoal("lights", list(lights), "at least one light or group", problem="it is empty")
    try:
        names.expand(lights)
    except UnknownLight as error:
        if is_colour(error.name):
            problem = f"{error.name!r} is a colour"
            raise BadGoal("lights", error.name, "lights here, and the colour behind them", problem) from None
        raise BadGoal("lights", error.name, error.hint, problem=f"unknown light {error.name!r}") from None


def require_coloured(names: LightNames, lights: Sequence[str]) -> None:
    """Check that every light can show a colour."""
    require_lights(names, lights)
    for light in lights:
        if not names.is_coloured(light):
            raise BadGoal(
                "lights",
                light,
                "a light with red, green and blue LEDs; setIntensity and fade take this one",
                problem=f"{light!r} has one colour only",
            )


def intensities(lights: Sequence[str], i_values: Sequence[float]) -> list[float]:
    """One intensity a light, from one for all or one each."""
    if len(i_values) not in (1, len(lights)):
        raise _wrong_count(i_values, f"{_count(lights)}", _for_all_or_each(1, len(lights)))
    return _spread([float(value) for value in i_values], len(lights))


def colours(lights: Sequence[str], i_values: Sequence[float], str_param: str) -> list[Colour]:
    """One colour a light, from a colour in `str_param`, or one triple for all or one each."""
    if str_param.strip():
        _require_one_source(i_values)
        return _spread([parse_colour(str_param)], len(lights))
    if not i_values:
        problem = "there is no colour"
        raise BadGoal("str_param", "", "a name or '#RRGGBB' here, or red, green and blue in i_values", problem)
    if len(i_values) not in (3, 3 * len(lights)):
        raise _wrong_count(i_values, f"the colours of {_count(lights)}", _for_all_or_each(3, len(lights)))
    return _spread(_triples(i_values), len(lights))


def one_colour(i_values: Sequence[float], str_param: str) -> Colour:
    """A colour, from `str_param` or one triple."""
    return colours(["the eyes"], i_values, str_param)[0]


def colour_steps(times: Sequence[float], i_values: Sequence[float], str_param: str) -> list[Colour]:
    """One colour a moment, from colours separated by commas in `str_param`, or one triple each."""
    if str_param.strip():
        _require_one_source(i_values)
        steps = [parse_colour(word) for word in str_param.split(",")]
        if len(steps) != len(times):
            raise BadGoal(
                "str_param",
                str_param,
                f"allowed are {len(times)}",
                problem=f"{len(steps)} colour{'' if len(steps) == 1 else 's'} for {len(times)} times",
            )
        return steps
    if len(i_values) != 3 * len(times):
        raise _wrong_count(i_values, f"{len(times)} times", f"{3 * len(times)} (red green blue a time)")
    return _triples(i_values)


def _require_one_source(i_values: Sequence[float]) -> None:
    if i_values:
        raise BadGoal(
            "i_values",
            list(i_values),
            "either a colour in str_param or numbers in i_values",
            problem="there is a colour in str_param already",
        )


def _wrong_count(i_values: Sequence[float], purpose: str, allowed: str) -> BadGoal:
    number = len(i_values)
    return BadGoal(
        "i_values",
        list(i_values),
        f"allowed are {allowed}",
        problem=f"{number} value{'' if number == 1 else 's'} for {purpose}",
    )


def _count(lights: Sequence[str]) -> str:
    return "1 light" if len(lights) == 1 else f"{len(lights)} lights"


def _for_all_or_each(size: int, count: int) -> str:
    return f"{size}" if count == 1 else f"{size} (for all) or {size * count} ({size} each)"


def _triples(i_values: Sequence[float]) -> list[Colour]:
    parts = [float(value) for value in i_values]
    return [(parts[i], parts[i + 1], parts[i + 2]) for i in range(0, len(parts), 3)]


def _spread(values: list[Value], count: int) -> list[Value]:
    return values * count if len(values) == 1 else values


class HasLeds(Protocol):
    """The module, as far as the checks need it."""

    leds: LedAccess


def _names(module: HasLeds, lights: Sequence[str], context: dict[str, Any]) -> LightNames:
    """The names as a check sees them: the robot's, and groups that earlier functions of the chain make."""

    def with_new_groups(names: LightNames) -> LightNames:
        for group, members in context.get("groups", {}).items():
            names = names.with_group(group, members)
        return names

    names = with_new_groups(module.leds.names)
    if all(names.knows(light) for light in lights) or context.get("names read again"):
        return names
    # Another program may have made a group since the names were read; one look a chain is enough.
    context["names read again"] = True
    return with_new_groups(module.leds.read_names())


def check_lights(module: HasLeds, lights: Sequence[str], context: dict[str, Any]) -> None:
    require_lights(_names(module, lights, context), lights)


def check_intensities(
    module: HasLeds, lights: Sequence[str], i_values: Sequence[float], context: dict[str, Any]
) -> None:
    check_lights(module, lights, context)
    intensities(lights, i_values)


def check_colours(
    module: HasLeds, lights: Sequence[str], i_values: Sequence[float], str_param: str, context: dict[str, Any]
) -> None:
    require_coloured(_names(module, lights, context), lights)
    colours(lights, i_values, str_param)


def check_readable_colours(module: HasLeds, lights: Sequence[str], context: dict[str, Any]) -> None:
    require_coloured(_names(module, lights, context), lights)


def check_fade_list(
    module: HasLeds,
    lights: Sequence[str],
    i_values: Sequence[float],
    str_param: str,
    times: Sequence[float],
    context: dict[str, Any],
) -> None:
    require_coloured(_names(module, lights, context), lights)
    colour_steps(times, i_values, str_param)


def check_rotation(_self: object, i_values: Sequence[float], str_param: str) -> None:
    one_colour(i_values, str_param)


def check_new_group(module: HasLeds, str_param: str, lights: Sequence[str], context: dict[str, Any]) -> None:
    """A free name and known lights; later functions of the chain may use the group."""
    name = str_param.strip()
    names = _names(module, lights, context)
    if name in names.lights:
        raise BadGoal("str_param", name, "a name that is no single light", problem=f"{name!r} is a light")
    require_lights(names, lights)
    context.setdefault("groups", {})[name] = tuple(names.expand(lights))


def check_group(module: HasLeds, str_param: str, context: dict[str, Any]) -> None:
    check_lights(module, [str_param.strip()], context)
