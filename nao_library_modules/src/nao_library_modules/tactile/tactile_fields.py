"""What the fields of a TactileFunction mean, and when a touch is the one that is waited for. Pure."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import List, NamedTuple

from ..core.errors import BadGoal
from ..core.fields import Annotated, flag, free, number, require_known, text, whole, word
from ..core.nao_facts import BUMPERS, GROUPS, SENSORS, SIDES, names_of, sensors_of

PRESS, RELEASE, HOLD, COUNT = "press", "release", "hold", "count"
KINDS = (PRESS, RELEASE, HOLD, COUNT)
SWAPPED = 0.05
"""s by which a press may seem later than its release where only their arrivals are known: libqi tells each in a thread,
and so in any order."""


@dataclass(frozen=True)
class WantedTouch:
    kind: str = PRESS  # one of `KINDS`
    count: int = 2  # how many presses (count)
    duration: float = 1.0  # s, how long a hold lasts, or within what time a count has to come


class Contact(NamedTuple):
    name: str  # short name of the sensor
    begin: float  # ROS time of the first contact, s
    end: float = 0.0  # that of the last one; 0 while it lasts


class TouchWatch:
    """Tells of each touch that is wanted. Times are passed in, s: when sensors changed, not when that was heard of.

    What is pressed when the watch begins counts for a release and, from then on, for a hold, but it is no press.

    Args:
        wanted: What counts.
        pressed: What is pressed already: name -> time of the first contact.
        now: When the watch begins.
    """

    def __init__(self, wanted: WantedTouch, pressed: Mapping[str, float], now: float) -> None:
        self._wanted = wanted
        self._begin = now
        self._since = dict(pressed)
        # Who asked for events before asking what is pressed may be told of the same press twice.
        self._untold = set(self._since)
        self._released: dict[str, float] = {}  # when sensors were let go that nobody knew to be pressed
        self._held: set[str] = set()
        self._presses: deque[tuple[float, str]] = deque()

    @property
    def pressed(self) -> list[str]:
        """What is pressed now, in the order in which it was."""
        return list(self._since)

    @property
    def due(self) -> float | None:
        """When `look` may have something to tell; None if only a touch can change that."""
        if self._wanted.kind != HOLD:
            return None
        begun = [max(since, self._begin) for name, since in self._since.items() if name not in self._held]
        return min(begun) + self._wanted.duration if begun else None

    def tell(self, name: str, pressed: bool, now: float) -> list[Contact]:
        """Take a change of a sensor; returns what has been touched as wanted by it."""
        held_enough = self.look(now)
        untold = name in self._untold
        self._untold.discard(name)
        if pressed == (name in self._since) and not (pressed and untold):
            if not pressed:
                self._released[name] = now
            return held_enough
        if pressed:
            self._since[name] = min(self._since.get(name, now), now)
            found = self._pressed(name, now)
            released = self._released.pop(name, None)
            if released is None or now - released > SWAPPED:
                return [*held_enough, *found]
            return self.tell(name, False, max(now, released)) or found
        begin = self._since.pop(name)
        self._held.discard(name)
        if self._wanted.kind == RELEASE:
            return [Contact(name, begin, now)]
        return [held._replace(end=now) if held.name == name else held for held in held_enough]

    def look(self, now: float) -> list[Contact]:
        """What has been held long enough by now, and was not told of before."""
        if self._wanted.kind != HOLD:
            return []
        # Sums of times are not exact: who waits until `due` comes a hair before.
        limit = now - self._wanted.duration + 1e-6
        held = [
            Contact(name, since)
            for name, since in self._since.items()
            if max(since, self._begin) <= limit and name not in self._held
        ]
        self._held.update(contact.name for contact in held)
        return held

    def _pressed(self, name: str, now: float) -> list[Contact]:
        if self._wanted.kind == PRESS:
            return [Contact(name, now)]
        if self._wanted.kind != COUNT:
            return []
        self._presses.append((now, name))
        while self._presses[0][0] < now - self._wanted.duration - 1e-6:
            self._presses.popleft()
        if len(self._presses) < self._wanted.count:
            return []
        first: dict[str, float] = {}
        for time, pressed in self._presses:
            first.setdefault(pressed, time)
        self._presses.clear()
        return [Contact(*each) for each in first.items()]


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
