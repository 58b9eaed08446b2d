"""Gait parameters as NAOqi names them: their ranges, and what a feet's gait of a move is made of."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, Mapping

from nao_sim_bridge.base.config import check_keys, config_file, read_json
from nao_sim_bridge.base.errors import BadValue, ConfigError, UnknownName

FILE = "walk.json"
SIDES = ("Left", "Right")
FREQUENCY = "Frequency"
# NAOqi name to the field of `Gait`.
FIELDS = {
    "MaxStepX": "max_step_x",
    "MaxStepY": "max_step_y",
    "MaxStepTheta": "max_step_theta",
    "MaxStepFrequency": "max_step_frequency",
    "StepHeight": "step_height",
    "TorsoWx": "torso_wx",
    "TorsoWy": "torso_wy",
}


@dataclass(frozen=True)
class Parameter:
    """One gait parameter; SI units, frequencies 0..1. A move may change one that is `settable`."""

    default: float
    minimum: float
    maximum: float
    settable: bool


@lru_cache(maxsize=1)
def walk_file() -> Mapping[str, Any]:
    """Content of `walk.json`."""
    return check_keys(read_json(config_file(FILE)), FILE, ["gait_parameters", "clipping", "engine"], ["_meta"])


@lru_cache(maxsize=1)
def parameters() -> Mapping[str, Parameter]:
    """All gait parameters by their NAOqi names, in NAOqi's order.

    Raises:
        ConfigError: The file cannot be read, or an entry is wrong.
    """
    found = {}
    for name, entry in walk_file()["gait_parameters"].items():
        check_keys(entry, f"{FILE}: gait_parameters.{name}", ["default", "min", "max", "settable"])
        found[name] = Parameter(entry["default"], entry["min"], entry["max"], entry["settable"])
        if not found[name].minimum <= found[name].default <= found[name].maximum:
            raise ConfigError(f"{FILE}: gait_parameters.{name}", "the default is not between min and max")
    return found


def _default(name: str) -> Any:
    return field(default_factory=lambda: parameters()[name].default)


@dataclass(frozen=True)
class Gait:
    """How one foot steps.

    Attributes:
        max_step_x: Longest step forward, m.
        max_step_y: Furthest that the foot is put from the other one, sideways, m.
        max_step_theta: Largest turn of a step, rad.
        max_step_frequency: 0 for the longest period of a step, 1 for the shortest.
        step_height: Peak of the foot, m.
        torso_wx: Peak roll of the torso while the foot is in the air, rad.
        torso_wy: Peak pitch of the torso, rad.
    """

    max_step_x: float = _default("MaxStepX")
    max_step_y: float = _default("MaxStepY")
    max_step_theta: float = _default("MaxStepTheta")
    max_step_frequency: float = _default("MaxStepFrequency")
    step_height: float = _default("StepHeight")
    torso_wx: float = _default("TorsoWx")
    torso_wy: float = _default("TorsoWy")

    def period(self, frequency: float = 1.0) -> float:
        """Time of a step, s, at a share 0..1 of the top frequency."""
        shortest, longest = parameters()["MinStepPeriod"].default, parameters()["MaxStepPeriod"].default
        return longest + frequency * self.max_step_frequency * (shortest - longest)


@dataclass(frozen=True)
class FeetGait:
    """How both feet step, at a share 0..1 of the top frequency."""

    left: Gait = field(default_factory=Gait)
    right: Gait = field(default_factory=Gait)
    frequency: float = 1.0

    def of(self, side: int) -> Gait:
        """Of the left (1) or the right foot (-1)."""
        return self.left if side > 0 else self.right

    def period(self, side: int) -> float:
        """Time of a step of the left (1) or the right foot (-1), s."""
        return self.of(side).period(self.frequency)


def feet_gait(values: Mapping[str, float]) -> FeetGait:
    """The gait that values by NAOqi's names ask for, for one foot with `Left` or `Right` before them.

    Raises:
        UnknownName: There is no such parameter.
        BadValue: A value is out of its range, or the parameter cannot be set.
    """
    sides: dict[str, dict[str, float]] = {side: {} for side in SIDES}
    frequency = 1.0
    for name, value in values.items():
        if name == FREQUENCY:
            frequency = _within(name, value, 0.0, 1.0)
            continue
        side = next((s for s in SIDES if name.startswith(s)), None)
        base = name[len(side) :] if side else name
        if base not in FIELDS:
            if base in parameters():
                raise BadValue(name, value, f"nothing: it is fixed at {parameters()[base].default:g}")
            raise UnknownName("gait parameter", name, [*FIELDS, *(s + f for s in SIDES for f in FIELDS), FREQUENCY])
        known = parameters()[base]
        checked = _within(name, value, known.minimum, known.maximum)
        for target in [side] if side else SIDES:
            sides[target][FIELDS[base]] = checked
    gaits = [replace(Gait(), **sides[side]) for side in SIDES]
    return FeetGait(gaits[0], gaits[1], frequency)


def _within(name: str, value: float, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise BadValue(name, value, f"{low:g} to {high:g}")
    return float(value)
