"""When events of the robot's memory were raised, however late they come. No ROS."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass, field
from typing import Any, Callable, NamedTuple

from naoqi.errors import RobotError, UnknownMethod

from .robot_clock import RobotClock

log = logging.getLogger(__name__)

COUNTED = (type(None), bool, int, float, str)
"""Types of values that come again and again; a list is hardly ever raised twice."""
REMEMBERED = 32
"""Events of one value whose times are remembered."""


class Event(NamedTuple):
    """An event of the robot's memory.

    Attributes:
        name: Its name.
        value: What it says.
        arrived: ROS time of its arrival, s; `EventTimes.time_of` knows when it was raised.
        number: How many of its name and value came before; None where that is not known.
        source: Knows its time.
    """

    name: str
    value: Any
    arrived: float
    number: int | None
    source: EventTimes


@dataclass
class _Turn:
    """Events of one name and value.

    Attributes:
        after: Time of the robot, s: those that are not looked up yet were raised later.
        came: How many have come.
        passed: How many have been looked up.
        times: Of the last of these: number -> time of the robot, s.
    """

    after: float
    came: int = 0
    passed: int = 0
    times: dict[int, float] = field(default_factory=dict)


class EventTimes:
    """ROS times of the events that one subscriber hears.

    libqi brings events without their times. ALMemory keeps the last values of each event with their times, so the third
    event of a value has the third time of this value since the subscription: whatever was raised until it is asked for.
    Where the robot does not tell its history, an event that was raised again since has the time of its arrival.

    Any thread may note what arrives. `call` calls a proxy: proxy, method, arguments. The lock is not held during calls.
    """

    def __init__(self, robot: Any, robot_clock: RobotClock, call: Callable[..., Any]) -> None:
        self._robot = robot
        self._robot_clock = robot_clock
        self._call = call
        self._lock = threading.Lock()
        self._begun: dict[str, float] = {}  # time of the robot, s, from which on all events of a name come
        self._turns: dict[tuple[str, Any], _Turn] = {}

    def begin(self, *names: str) -> None:
        """Count events of these names anew: they have just been subscribed."""
        try:
            now = self._robot_clock.robot_time(self._call)
        except RobotError as error:
            log.debug("the robot does not tell its time: %s", error)
            return
        with self._lock:
            self._begun.update(dict.fromkeys(names, now))
            self._turns = {key: turn for key, turn in self._turns.items() if key[0] not in names}

    def arrived(self, name: str, value: Any, now: float) -> Event:
        """An event that has just arrived; `now`: ROS time, s."""
        with self._lock:
            if name not in self._begun or not isinstance(value, COUNTED):
                return Event(name, value, now, None, self)
            turn = self._turns.setdefault((name, value), _Turn(self._begun[name]))
            turn.came += 1
            return Event(name, value, now, turn.came - 1, self)

    def time_of(self, event: Event) -> float:
        """ROS time at which an event was raised, s; NaoError if the robot cannot be asked."""
        try:
            answer = self._call(self._robot.proxy("ALMemory"), "getEventHistory", event.name)
            history = [(value, seconds + 1e-6 * microseconds) for value, seconds, microseconds in answer]
        except (RobotError, UnknownMethod, TypeError, ValueError) as error:
            log.debug("the robot does not tell the history of %s: %s", event.name, error)
            history = []
        times = sorted(time for value, time in history if value == event.value)
        if not times:
            return self._robot_clock.event_time(self._call, event.name, event.value, event.arrived)
        with self._lock:
            raised = self._looked_up(event, times)
        return self._robot_clock.raised(self._call, times[-1] if raised is None else raised, event.arrived)

    def _looked_up(self, event: Event, times: list[float]) -> float | None:
        """The time of the robot, s, of an event among those of its value, in order; None where it is not known."""
        turn = self._turns.get((event.name, event.value)) if event.number is not None else None
        if turn is None:
            return None
        for time in times:
            if time > turn.after and turn.passed <= event.number:
                turn.times[turn.passed] = turn.after = time
                turn.passed += 1
        turn.passed = max(turn.passed, event.number + 1)  # also where it was raised just before `begin`
        for number in [each for each in turn.times if each < turn.passed - REMEMBERED]:
            del turn.times[number]
        return turn.times.get(event.number)
