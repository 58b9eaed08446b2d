"""Events of a robot, which pages and trials follow; and those that answer a step of a trial: touches, words, faces."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..core.nao_facts import SENSORS
from ..core.waiting import Listeners
from .protocol import COUNTED

log = logging.getLogger(__name__)

STATE, ALARM = "state", "alarm"
"""Kinds of events: how the robot is when a trial begins; the begin or the end of an alarm."""
KEPT = 1000
"""Events that are kept for pages that open later."""


@dataclass(frozen=True)
class ConsoleEvent:
    """Something that happened."""

    stamp: float  # s of ROS time
    kind: str  # pressed, sent, ended, stopped, walked, said, heard, touched, seen, felt, state, alarm, note, ...
    robot: str  # its namespace, with a slash at both ends
    text: str  # for people
    by: str = ""  # who did it at the console; empty: the robot, or another program
    data: Mapping[str, Any] = field(default_factory=dict)  # values that JSON has


class EventStream:
    """The events of one robot. Any thread.

    `clock`: gives the ROS time, s.
    """

    def __init__(self, robot: str, clock: Callable[[], float]) -> None:
        self._robot = robot
        self._clock = clock
        self._lock = threading.Lock()
        self._events: deque[ConsoleEvent] = deque(maxlen=KEPT)
        self._listeners = Listeners()

    def add(self, kind: str, text: str, /, by: str = "", stamp: float | None = None, **data: Any) -> ConsoleEvent:
        """Something has happened, now or at `stamp`."""
        event = ConsoleEvent(self._clock() if stamp is None else stamp, kind, self._robot, text, by, data)
        with self._lock:
            self._events.append(event)
        for listener in self._listeners:
            try:
                listener(event)
            except Exception:  # the others, a trial's log among them, are told all the same
                log.exception("an event is lost to one who listens: %s", event)
        return event

    def subscribe(self, listener: Callable[[ConsoleEvent], None]) -> Callable[[], None]:
        """Have each event told in the thread that adds it; what comes back ends that."""
        return self._listeners.add(listener)

    def last(self, count: int = 200) -> list[ConsoleEvent]:
        """The newest events, the oldest of them first."""
        with self._lock:
            return list(self._events)[-count:]


def namespace_of(name: str) -> str:
    """Of the robot of a name, with a slash at both ends."""
    return f"/{name.strip('/')}/" if name.strip("/") else "/"


LOOK_PERIOD = 0.01
"""s of this computer between two looks."""


def within(limit: float, condition: Callable[[], bool]) -> bool:
    """Look now and then whether something has come to hold; whether it has, `limit` s of this computer at most."""
    deadline = time.monotonic() + limit
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(LOOK_PERIOD)
    return True


TOUCHED = "touched"
"""Kind of the events that tell of touches."""
LATEST = 0.5
"""s of ROS time by which topics and goals may tell of one touch after each other."""
BOUNCE = 0.1
"""s for which a touch may be lost and still be the same one: skin and switches bounce."""
EARLY = 0.05
"""s by which a topic may tell of a touch before its onset, as clocks differ."""
_PLACES = {
    sensor.name: sensor.groups[0] if sensor.groups[0] not in ("bumpers", "any") else sensor.name for sensor in SENSORS
}


def place_of(sensor: str) -> str:
    """What of the body a sensor is on: head, left hand, left bumper, ..."""
    return _PLACES.get(sensor, sensor)


class Touches:
    """Which sensors are pressed, and since when; told in the order of time. Times are ROS times, s."""

    def __init__(self) -> None:
        self._pressed: dict[str, dict[str, float]] = {}  # place -> sensor -> when that began
        self._let_go: dict[str, float] = {}  # place -> when nothing of it was pressed any more
        self._began: dict[str, float] = {}  # place -> when a touch of it began, as topics tell
        self._answered: dict[str, float] = {}  # place -> begin of a touch of which topics are still to tell

    def begins(self, told: Mapping[str, Any], stamp: float) -> bool:
        """Whether a touch begins with what a topic tells: of a place where nothing was pressed.

        `told`: `sensor` and whether it is `touched`.
        """
        sensor = str(told.get("sensor", ""))
        place = place_of(sensor)
        pressed = self._pressed.setdefault(place, {})
        if not told.get("touched"):
            if pressed.pop(sensor, None) is not None and not pressed:
                self._let_go[place] = stamp
            return False
        first = not pressed and stamp - self._let_go.get(place, -math.inf) > BOUNCE
        pressed[sensor] = stamp
        if not first:
            return False
        self._began[place] = stamp
        answered = self._answered.pop(place, None)
        return answered is None or stamp > answered + LATEST

    def answered(self, sensors: Iterable[str], onset: float) -> None:
        """A goal has told of a touch: topics that tell of it later tell of the same one."""
        for place in {place_of(sensor) for sensor in sensors}:
            if self._began.get(place, -math.inf) < onset - EARLY:
                self._answered[place] = onset

    def goes_on(self, sensors: Iterable[str], onset: float) -> bool:
        """Whether sensors that are pressed at `onset` belong to a touch that had begun earlier."""
        for place in {place_of(sensor) for sensor in sensors}:
            if any(began < onset - LATEST for began in self._pressed.get(place, {}).values()):
                return True
        return False


class Happenings:
    """Begins of touches, words and faces. Each of them answers one wait at most. Any thread.

    `now`: ROS time, s.
    """

    def __init__(self, now: float) -> None:
        self.touches = Touches()
        self._lock = threading.Lock()
        self._events: list[ConsoleEvent] = []
        self._since = dict.fromkeys(COUNTED, now)  # kind -> since when it counts

    def take(self, event: ConsoleEvent) -> bool:
        """Keep an event; whether it is the begin of a touch, a word or a face."""
        if event.kind not in COUNTED:
            return False
        with self._lock:
            if event.kind == TOUCHED:  # clicks are told beside the presses that they are made of
                counts = "touched" in event.data and self.touches.begins(event.data, event.stamp)
            else:
                counts = event.data.get("what", "face") == "face"
            if counts:
                self._events.append(event)
            return counts

    def since(self, kind: str, begin: float) -> list[ConsoleEvent]:
        """Events of a kind from a ROS time on that no wait has taken."""
        with self._lock:
            return [each for each in self._events if each.kind == kind and each.stamp >= max(begin, self._since[kind])]

    def forget(self, kinds: Iterable[str], now: float) -> None:
        """What has happened until now is no answer any more."""
        with self._lock:
            self._since.update(dict.fromkeys(kinds, now))
            self._events = [each for each in self._events if each.kind not in kinds]

    def answered(self, sensors: Iterable[str], onset: float) -> None:
        """A touch has answered a wait: it, and what was before it, is no answer any more."""
        places = {place_of(sensor) for sensor in sensors}
        with self._lock:
            own = [each for each in self._events if self._is_of(each, places, onset)][:1]
            if not own:
                self.touches.answered(sensors, onset)
            self._since[TOUCHED] = onset
            self._events = [e for e in self._events if e.kind != TOUCHED or (e.stamp >= onset and e not in own)]

    def goes_on(self, sensors: Iterable[str], onset: float) -> bool:
        """Whether a touch that a goal tells of is part of one that had begun earlier."""
        with self._lock:
            return self.touches.goes_on(sensors, onset)

    @staticmethod
    def _is_of(event: ConsoleEvent, places: set[str], onset: float) -> bool:
        told = event.kind == TOUCHED and place_of(str(event.data.get("sensor"))) in places
        return told and onset - EARLY <= event.stamp <= onset + LATEST
