"""What the fields of a TactileFunction mean to the functions of touch: declarations, and what values stand for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import List

from ..base.errors import BadGoal
from ..base.field_checks import require_known
from ..functions.fields import Annotated, flag, free, number, text, whole, word
from ..nao.body_devices import SIDES
from ..nao.touch_names import BUMPERS, GROUPS, SENSORS, names_of, sensors_of
from .touch import COUNT, HOLD, KINDS, PRESS, WantedTouch

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


def wanted_of(touch: str, count: int, duration: float) -> WantedTouch:
    """The kind of touch that fields ask for; they have been checked."""
    kind = touch.strip() or PRESS
    usual = DEFAULT_WINDOW if kind == COUNT else DEFAULT_HOLD
    return WantedTouch(kind, count or DEFAULT_COUNT, duration or usual)


def words_of(words: Sequence[str], known: Sequence[str], kind: str) -> list[str]:
    """Some of several names, each once, in their order; none stands for all."""
    wanted = [require_known("sensors", word.replace("_", " ").lower(), known, kind) for word in words]
    return [name for name in known if name in wanted or not wanted]


def _require_bumpers(name: str, words: Sequence[str]) -> None:
    bumpers = names_of(BUMPERS)
    others = [sensor for sensor in names_of(sensors_of(words or ["bumpers"], name)) if sensor not in bumpers]
    if others:
        raise BadGoal(name, list(words), ", ".join(bumpers), problem=f"{others[0]} is no bumper")


def _require_assignments(name: str, texts: Sequence[str]) -> None:
    for each in texts:
        if not PARAMETER.fullmatch(each):
            raise BadGoal(name, each, ASSIGNMENT)


ASSIGNMENT = "name=value"
TOUCHABLE = (*GROUPS, *names_of(SENSORS))

_SENSORS = free(
    "sensors or groups by short names, or by NAOqi's events ('FrontTactilTouched') or devices ('Head/Touch/Front');"
    " empty: any",
    allowed=f"some of {', '.join(TOUCHABLE)}, events and devices",
    choices=TOUCHABLE,
    check=lambda name, words: sensors_of(words, name),
)
_SONARS = free(
    "sonars to listen to; empty: both",
    allowed=f"some of {', '.join(SIDES)}",
    choices=SIDES,
    check=lambda _, words: words_of(words, SIDES, "sonar"),
)
_FEET = _SONARS.but(
    help="feet to read; empty: both",
    allowed=f"some of {', '.join(FEET)}",
    choices=FEET,
    check=lambda _, words: words_of(words, FEET, "foot"),
)
PRESSES = whole(0, 20, f"number of presses where the touch is a count; 0: {DEFAULT_COUNT}")
TOUCH_TIME = number(
    "hold", f"length of a hold (0: {DEFAULT_HOLD:g}), or of the time that a count may take (0: {DEFAULT_WINDOW:g})"
)

Sensors = Annotated[List[str], _SENSORS]
Bumpers = Annotated[
    List[str],
    _SENSORS.but(
        help="bumpers by their short names, events or devices; empty: both",
        allowed=f"some of {', '.join(names_of(BUMPERS))}",
        choices=names_of(BUMPERS),
        check=_require_bumpers,
    ),
]
Sonars = Annotated[List[str], _SONARS]
Feet = Annotated[List[str], _FEET]
Warm = Annotated[
    List[str], free("what to measure; empty: all", allowed="joints and chains of the robot, head, battery")
]
Touch = Annotated[str, word(KINDS, "kind of touch", "kind of touch", empty=PRESS)]
Presses = Annotated[int, PRESSES.but(check=None)]
TouchTime = Annotated[float, TOUCH_TIME.but(check=None)]
Clicks = Annotated[int, whole(0, len(CLICKS), "number of clicks; 0: 1")]
Timeout = Annotated[float, number("timeout", f"longest wait; 0: {DEFAULT_TIMEOUT:g}")]
Distance = Annotated[
    float,
    number(
        "sonar distance", "distance under which something counts as an obstacle", zero=f" for {DEFAULT_DISTANCE:g} m"
    ),
]
Enable = Annotated[bool, flag("whether the sonars measure; false: no longer for this server")]
Revert = Annotated[bool, flag("whether what the function has set goes back after `time`")]
NewLink = Annotated[str, free("name of the link between touch and behaviour; empty: that of the behaviour")]
Link = Annotated[str, free("name of a link between a touch and a behaviour; empty: all of them")]
BehaviorName = Annotated[str, text("the name of a stored behaviour", "name of the behaviour to run")]
Parameters = Annotated[List[str], free("parameters of the behaviour", allowed=ASSIGNMENT, check=_require_assignments)]
Cooldown = Annotated[float, number("timeout", "time after the end of the behaviour in which touches do not count")]


def require_touch(touch: str, count: int, duration: float) -> None:
    """See that the numbers that a kind of touch has will do; raises BadGoal."""
    kind = touch.strip() or PRESS
    if kind == COUNT:
        PRESSES.require("count", count)
    if kind in (COUNT, HOLD):
        TOUCH_TIME.require("duration", duration)
