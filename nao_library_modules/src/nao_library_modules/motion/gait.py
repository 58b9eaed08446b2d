"""Numbers of a walk: parameters of the gait, places, footsteps; what a message asks for, within what is allowed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, List, Union

from ..base.errors import BadGoal
from ..base.field_checks import degrees_hint, require_count, require_length
from ..base.limits import limit
from ..base.places import Place
from ..base.suggestion import did_you_mean
from ..nao.walk_speed import step_period
from .facts import LEGS

SETTABLE = (
    "MaxStepX",
    "MaxStepY",
    "MaxStepTheta",
    "MaxStepFrequency",
    "StepHeight",
    "TorsoWx",
    "TorsoWy",
)
"""What a walk may change; the other parameters that getMoveConfig tells are fixed."""
FEET = ("Left", "Right")
FREQUENCY = "Frequency"
DEFAULT, LEAST, MOST = CONFIGS = ("Default", "Min", "Max")
# The robot's numbers have 32 bits: a limit that it tells must be allowed as a value.
TOLERANCE = 1e-6
FOOT_SEPARATION = 0.1
"""m; from NAOqi's documentation of the walk."""
# From standing to the first step and from the last one to standing, about, s.
BEGIN_AND_END = 2.0

PLACE = "x, y (m), theta (rad)"
WAY, TURN = limit("way"), limit("turn")
"""Seen from the robot. Who asks for more has mistaken the unit; the battery would not do."""
PLACES = limit("places")
# Where a foot can be put beside the other one, m and rad. Source: NAOqi's documentation of the clipping of footsteps,
# which the robot applies in detail.
STEP_X, STEP_Y, STEP_THETA = (-0.04, 0.08), (0.088, 0.16), 0.524
ROUNDING = 1e-6

GaitPairs = List[List[Union[str, float]]]
"""What ALMotion takes: [["MaxStepX", 0.04], ...]."""


@dataclass(frozen=True)
class GaitRange:
    """One parameter of a walk: its default, and the least and largest that is allowed; m, rad, or a share 0..1."""

    default: float
    lower: float
    upper: float


def read_ranges(motion: Callable[..., Any]) -> Mapping[str, GaitRange]:
    """Parameter that can be set -> its range, with `motion` to call ALMotion.

    Raises NaoError if the robot cannot be asked.
    """
    configs = [{name: float(v) for name, v in motion("getMoveConfig", which)} for which in CONFIGS]
    names = [name for name in SETTABLE if all(name in values for values in configs)]
    return {name: GaitRange(*(values[name] for values in configs)) for name in names}


def read_gait(
    names: Sequence[str], values: Sequence[float], ranges: Mapping[str, GaitRange], each_foot: bool
) -> GaitPairs:
    """The parameters that a message gives, in the shape that ALMotion takes.

    Raises BadGoal if a name is not known, or a value is out of its range.

    Args:
        names, values, ranges: NAOqi's names, one value each, what the robot allows.
        each_foot: Whether the walk takes parameters for one foot, and a frequency.
    """
    if len(names) != len(values):
        problem = f"{len(values)} values for {len(names)} parameters"
        raise BadGoal("gait_values", list(values), f"one for each of {', '.join(names) or 'gait'}", problem=problem)
    allowed = _allowed(ranges, each_foot)
    pairs: GaitPairs = []
    for name, value in zip(names, values):
        if name not in allowed:
            raise BadGoal("gait", name, f"one of {', '.join(allowed)}", problem=_unknown(name, allowed, each_foot))
        limits = allowed[name]
        if not limits.lower - TOLERANCE <= value <= limits.upper + TOLERANCE:
            problem = f"{name} cannot be {value:g}"
            bounds = f"{limits.lower:.3g} to {limits.upper:.3g} {_unit(name)}"
            raise BadGoal("gait_values", value, bounds, problem=problem)
        pairs.append([name, float(value)])
    return pairs


def _unit(name: str) -> str:
    """Of a parameter of a walk; a frequency is a share of the highest."""
    if name.endswith(FREQUENCY):
        return "of the highest"
    return "rad" if name.endswith(("Theta", "Wx", "Wy")) else "m"


def walk_time(points: Sequence[Place], pairs: GaitPairs, ranges: Mapping[str, GaitRange]) -> float:
    """About how long a walk takes, s, through points seen from the robot; `pairs` are parameters that it changes."""
    gait = {name: limits.default for name, limits in ranges.items()}
    gait.update({str(name): float(value) for name, value in pairs})
    period = step_period(gait.get("MaxStepFrequency", 1.0))
    # Of two steps to the side only the first one gets ahead.
    most = (gait["MaxStepX"], 0.5 * (gait["MaxStepY"] - FOOT_SEPARATION), gait["MaxStepTheta"])
    steps, before = 0.0, Place(0.0, 0.0, 0.0)
    for point in points:
        way = point.seen_from(before)
        steps += math.sqrt(sum((part / size) ** 2 for part, size in zip(way, most)))
        before = point
    return steps * period + (BEGIN_AND_END if steps else 0.0)


def _allowed(ranges: Mapping[str, GaitRange], each_foot: bool) -> dict[str, GaitRange]:
    allowed = dict(ranges)
    if each_foot:
        allowed.update({foot + name: limits for foot in FEET for name, limits in ranges.items()})
        allowed[FREQUENCY] = GaitRange(1.0, 0.0, 1.0)
    return allowed


def _unknown(name: str, allowed: Mapping[str, GaitRange], each_foot: bool) -> str:
    if not each_foot and (name == FREQUENCY or name.startswith(FEET)):
        return f"{name} is for move and moveToward"
    return f"{name!r} is no parameter of a walk{did_you_mean(name, allowed)}"


# Places and footsteps


def require_way(way: Place, field: str = "values") -> None:
    """See that a way makes sense.

    Raises BadGoal if it is too long, or turns by more than half a turn, or a number is none.
    """
    numbers = ("x", way.x, WAY), ("y", way.y, WAY), ("theta", way.yaw, TURN)
    for name, value, (_, most, unit) in numbers:
        if not abs(value) <= most:
            hint = degrees_hint(value, -most, most) if unit == "rad" else ""
            allowed = f"-{most:.5g} to {most:.5g} {unit}{hint}"
            raise BadGoal(field, value, allowed, problem=f"{name} cannot be {value:g}")


def places(values: Sequence[float]) -> list[Place]:
    """Places from one flat list. Raises BadGoal if there is none, not three numbers for each, or too many."""
    require_length("values", len(values) // 3, PLACES)
    if len(values) < 3:
        require_count("values", values, 3, PLACE)
    require_count("values", values, 3, PLACE, "place")
    return [Place(*values[i : i + 3]) for i in range(0, len(values), 3)]


def steps(names: Sequence[str], values: Sequence[float]) -> list[list[float]]:
    """Footsteps of a message: x, y and theta of each, seen from the other foot.

    Raises BadGoal if there are not three numbers for each, or a leg cannot put its foot there.
    """
    if len(values) != 3 * len(names):
        problem = f"3 numbers for each step are needed, {3 * len(names)} in all"
        raise BadGoal("values", list(values), f"{PLACE}; here are {len(values)}", problem=problem)
    rows = [list(values[i : i + 3]) for i in range(0, len(values), 3)]
    for leg, (x, y, theta) in zip(names, rows):
        across = STEP_Y if leg == LEGS[0] else (-STEP_Y[1], -STEP_Y[0])
        ranges = (("x", x, STEP_X, "m"), ("y", y, across, "m"), ("theta", theta, (-STEP_THETA, STEP_THETA), "rad"))
        for name, value, (least, most), unit in ranges:
            if not least - ROUNDING <= value <= most + ROUNDING:
                problem = f"{name} of a step of {leg} cannot be {value:g}"
                allowed = f"{least:g} to {most:g} {unit}, seen from the other foot"
                raise BadGoal("values", value, allowed, problem=problem)
    return rows


def step_speeds(count: int, speed: float, speeds: Sequence[float]) -> list[float]:
    """How fast each step is, as a fraction of the fastest; all of it where a message leaves it to us.

    Raises BadGoal if there are not as many as steps.
    """
    given = list(speeds) or [speed or 1.0]
    if len(given) not in (1, count):
        raise BadGoal("speeds", given, "one, or one for each step", problem=f"{len(given)} speeds for {count} steps")
    return given if len(given) == count else given * count
