"""What the fields of a LedFunction mean, and what they may hold. Pure; every function raises BadGoal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from ..base.colours import Colour, is_colour, parse_colour
from ..base.errors import BadGoal
from ..nao.light_names import LightNames, UnknownLight

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
