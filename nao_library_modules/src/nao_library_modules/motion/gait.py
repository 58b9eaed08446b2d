"""Parameters of a walk: what a message asks for, within what the robot allows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, List, Tuple, Union

from ..base.errors import BadGoal
from ..base.places import Place
from ..base.suggestion import did_you_mean
from ..nao.walk_speed import step_period
from .facts import MOTION

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

GaitPairs = List[List[Union[str, float]]]
"""What ALMotion takes: [["MaxStepX", 0.04], ...]."""


@dataclass(frozen=True)
class GaitRange:
    """One parameter of a walk; m, rad, or a share 0..1.

    Attributes:
        default: Its value when nobody asks for another.
        lower: Least allowed.
        upper: Largest allowed.
    """

    default: float
    lower: float
    upper: float


class GaitAccess:
    """Parameters of one robot, asked of it once for each connection. Used from the thread that executes goals only."""

    def __init__(self, robot: Any, call: Callable[..., Any]) -> None:
        """Ask nothing yet.

        Args:
            robot: Proxies and connection.
            call: Calls a method; preemption interrupts it.
        """
        self._robot = robot
        self._call = call
        self._ranges: Tuple[int, Mapping[str, GaitRange]] | None = None

    @property
    def ranges(self) -> Mapping[str, GaitRange]:
        """Parameter that can be set -> its range.

        Raises:
            NaoError: If the robot cannot be asked.
        """
        generation = self._robot.connection.generation
        if self._ranges is None or self._ranges[0] != generation:
            proxy = self._robot.proxy(MOTION)
            told = [{name: float(v) for name, v in self._call(proxy, "getMoveConfig", which)} for which in CONFIGS]
            names = [name for name in SETTABLE if all(name in values for values in told)]
            ranges = {name: GaitRange(*(values[name] for values in told)) for name in names}
            self._ranges = (generation, ranges)
        return self._ranges[1]


def read_gait(
    names: Sequence[str], values: Sequence[float], ranges: Mapping[str, GaitRange], each_foot: bool
) -> GaitPairs:
    """The parameters that a message gives, in the shape that ALMotion takes.

    Args:
        names: NAOqi's names.
        values: One each.
        ranges: What the robot allows.
        each_foot: Whether the walk takes parameters for one foot, and a frequency.

    Raises:
        BadGoal: If a name is not known, or a value is out of its range.
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
            raise BadGoal("gait_values", value, f"{limits.lower:.3g} to {limits.upper:.3g}", problem=problem)
        pairs.append([name, float(value)])
    return pairs


def walk_time(points: Sequence[Place], pairs: GaitPairs, ranges: Mapping[str, GaitRange]) -> float:
    """About how long a walk takes, s: what a dry run tells.

    Args:
        points: The way, seen from the robot.
        pairs: Parameters that the walk changes.
        ranges: The robot's.
    """
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
