"""Checks of the light functions, made before a chain begins. Parameters are fields of LedFunction."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from ..base.errors import BadGoal
from ..nao.light_names import LightNames
from .goals import colour_steps, colours, intensities, one_colour, require_coloured, require_lights
from .led_access import LedAccess


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
