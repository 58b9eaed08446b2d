"""What fields of TactileFunction may hold. Every check raises BadGoal."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from ..base.errors import BadGoal
from ..base.field_checks import require_known, require_text, require_whole, require_within, require_zero_or
from ..base.limits import limit
from ..nao.body_devices import SIDES
from ..nao.touch_names import BUMPERS, names_of, sensors_of
from .touch import COUNT, HOLD, KINDS, PRESS, Wanted

TIMEOUT, HOLD_TIME, SONAR = limit("timeout"), limit("hold"), limit("sonar distance")
DEFAULT_TIMEOUT, DEFAULT_HOLD = 10.0, 1.0
DEFAULT_WINDOW, DEFAULT_COUNT = 2.0, 2
DEFAULT_DISTANCE = 0.5
FEET = tuple(f"{side} foot" for side in SIDES)
CLICKS = {
    1: "ALChestButton/SimpleClickOccurred",
    2: "ALChestButton/DoubleClickOccurred",
    3: "ALChestButton/TripleClickOccurred",
}
PARAMETER = re.compile(r"\s*[A-Za-z_]\w*\s*=.*", re.DOTALL)


def timeout_of(timeout: float) -> float:
    """How long to wait, s: the usual time for 0."""
    return timeout or DEFAULT_TIMEOUT


def wanted_of(touch: str, count: int, duration: float) -> Wanted:
    """The kind of touch that fields ask for; they have been checked."""
    kind = touch.strip() or PRESS
    usual = DEFAULT_WINDOW if kind == COUNT else DEFAULT_HOLD
    return Wanted(kind, count or DEFAULT_COUNT, duration or usual)


def words_of(words: Sequence[str], known: Sequence[str], kind: str) -> list[str]:
    """Some of several names, each once, in their order; none stands for all."""
    wanted = [require_known("sensors", word.replace("_", " ").lower(), known, kind) for word in words]
    return [name for name in known if name in wanted or not wanted]


def check_sensors(_self: Any, sensors: Sequence[str]) -> None:
    """Known sensors."""
    sensors_of(sensors)


def check_bumpers(_self: Any, sensors: Sequence[str]) -> None:
    """Bumpers."""
    others = [name for name in names_of(sensors_of(sensors or ["bumpers"])) if name not in names_of(BUMPERS)]
    if others:
        raise BadGoal("sensors", list(sensors), ", ".join(names_of(BUMPERS)), problem=f"{others[0]} is no bumper")


def check_sonars(_self: Any, sensors: Sequence[str]) -> None:
    """Sonars."""
    words_of(sensors, SIDES, "sonar")


def check_feet(_self: Any, sensors: Sequence[str]) -> None:
    """Feet."""
    words_of(sensors, FEET, "foot")


def check_touch(_self: Any, sensors: Sequence[str], touch: str, count: int, duration: float, timeout: float) -> None:
    """Known sensors, a kind of touch, times."""
    _check_wanted(sensors, touch, count, duration)
    require_within("timeout", timeout, TIMEOUT)


def check_clicks(_self: Any, count: int, timeout: float) -> None:
    """One to three clicks."""
    require_whole("count", count, 0, 3)
    require_within("timeout", timeout, TIMEOUT)


def check_obstacle(_self: Any, sensors: Sequence[str], distance: float, timeout: float) -> None:
    """A distance that the sonars can measure."""
    words_of(sensors, SIDES, "sonar")
    require_zero_or("distance", distance, SONAR, f" for {DEFAULT_DISTANCE:g} m")
    require_within("timeout", timeout, TIMEOUT)


def check_timeout(_self: Any, timeout: float) -> None:
    """A time to wait."""
    require_within("timeout", timeout, TIMEOUT)


def check_binding(
    self: Any,
    str_param: str,
    sensors: Sequence[str],
    touch: str,
    count: int,
    duration: float,
    behavior: str,
    parameters: Sequence[str],
    cooldown: float,
    context: dict[str, Any],
) -> None:
    """Known sensors, a kind of touch, a behaviour with parameters."""
    _check_wanted(sensors, touch, count, duration)
    name = require_text("behavior", behavior, "the name of a stored behaviour")
    for parameter in parameters:
        if not PARAMETER.fullmatch(parameter):
            raise BadGoal("parameters", parameter, "name=value")
    require_within("cooldown", cooldown, TIMEOUT)
    context.setdefault("bindings", set(self.bindings.names)).add(str_param.strip() or name)


def check_removal(self: Any, str_param: str, context: dict[str, Any]) -> None:
    """A link that is there when it is to be removed."""
    names = context.setdefault("bindings", set(self.bindings.names))
    if not str_param.strip():
        names.clear()
        return
    names.remove(require_known("str_param", str_param, sorted(names), "link between a touch and a behaviour"))


def _check_wanted(sensors: Sequence[str], touch: str, count: int, duration: float) -> None:
    sensors_of(sensors)
    kind = require_known("touch", touch or PRESS, KINDS, "kind of touch")
    if kind == COUNT:
        require_whole("count", count, 0, 20)
    if kind in (COUNT, HOLD):
        require_within("duration", duration, HOLD_TIME)
