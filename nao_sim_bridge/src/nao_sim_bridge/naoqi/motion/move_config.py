"""Gait configurations of ALMotion's moves: lists of pairs such as [["MaxStepX", 0.03], ["LeftStepHeight", 0.02]].

NAOqi documents names for one foot ("Left...", "Right...") and "Frequency" for `move` and `moveToward` only; here every
move takes them.
"""

from __future__ import annotations

from operator import attrgetter
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.binding.arguments import known, limited, number
from nao_sim_bridge.naoqi.motion.arguments import pairs
from nao_sim_bridge.walk.gait import FIELDS, FREQUENCY, SIDES, FeetGait, feet_gait, parameters

FIELD = "moveConfig"
# Clients in C++ send numbers of single precision: 0.035 comes as 0.035000001. No parameter means anything by less.
DECIMALS = 6
LISTS = {"Default": attrgetter("default"), "Min": attrgetter("minimum"), "Max": attrgetter("maximum")}


def gait_of(config: Any = (), frequency: float | None = None) -> FeetGait:
    """The gait of a move; `frequency` is a share 0..1 of the top one, when it is an argument of its own.

    A number out of its range is brought to the nearer limit. An UnknownName when there is no such parameter; a BadValue
    when the list has another shape, or a value is no number.
    """
    values = _pairs(config, FIELD)
    if frequency is not None:
        values[FREQUENCY] = frequency
    return feet_gait(values)


def gait_of_feet(left: Any, right: Any, frequency: float) -> FeetGait:
    """The gait of a move whose feet have a configuration each, with names that say no foot.

    A number out of its range is brought to the nearer limit. An UnknownName when there is no such parameter of a foot;
    a BadValue when a list has another shape, or a value is no number.
    """
    values: dict[str, float] = {FREQUENCY: frequency}
    for side, config in (("Left", left), ("Right", right)):
        for name, value in _pairs(config, f"{side.lower()}FootMoveConfig").items():
            values[side + known(name, "gait parameter of a foot", FIELDS)] = value
    return feet_gait(values)


def frequency_share(value: Any, field: str) -> float:
    """A share 0..1 of the top frequency; one above 1 is taken for 1, with a line in the log, as on a robot."""
    if number(value, field) < 0.0:
        raise BadValue(field, value, "0 to 1")
    return limited(value, field, 0.0, 1.0)


def gait_list(which: str) -> list[list[Any]]:
    """Pairs of all parameters that moves may set, in NAOqi's order: their "Default", "Min" or "Max"."""
    if which not in LISTS:
        raise BadValue("config", which, ", ".join(LISTS))
    return [[name, LISTS[which](parameter)] for name, parameter in parameters().items() if parameter.settable]


def _pairs(config: Any, field: str) -> dict[str, float]:
    given = pairs(config, field, '[["MaxStepX", 0.03], ["StepHeight", 0.02]]')
    values = {name: round(value, DECIMALS) if isinstance(value, float) else value for name, value in given}
    return {name: _limited(name, value) for name, value in values.items()}


def _limited(name: str, value: Any) -> Any:
    """The value of a gait parameter, brought to its limits as on a robot; what is no number stays as it is."""
    if name == FREQUENCY:
        return frequency_share(value, FREQUENCY)
    base = next((name[len(side) :] for side in SIDES if name.startswith(side)), name)
    if base not in FIELDS or isinstance(value, bool) or not isinstance(value, (int, float)):
        return value
    parameter = parameters()[base]
    return limited(value, name, parameter.minimum, parameter.maximum)
