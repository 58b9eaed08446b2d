"""Functions that wait until the robot feels something. Nothing in time is an answer, too."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from .function_chain import checked_by
from .tactile_checks import (
    CLICKS,
    DEFAULT_DISTANCE,
    SIDES,
    check_clicks,
    check_obstacle,
    check_timeout,
    check_touch,
    timeout_of,
    wanted_of,
    words_of,
)
from .tactile_names import BY_EVENT, sensors_of
from .tactile_reading import SONAR, SONAR_START, ReadingFunctions
from .tactile_touch import TouchWatch

SONAR_PERIOD = 0.1
"""s between two measurements of a sonar."""
FALLEN = "robotHasFallen"
WAITING = "waiting"


class WaitingFunctions(ReadingFunctions):
    """Parameters are fields of TactileFunction."""

    tell: Callable[..., None]  # of NaoTactile: publishes what is felt meanwhile

    def waiting_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "waitForTouch": self.wait_for_touch,
            "waitForChestButton": self.wait_for_chest_button,
            "waitForObstacle": self.wait_for_obstacle,
            "waitForFall": self.wait_for_fall,
        }

    @checked_by(check_touch)
    def wait_for_touch(
        self, sensors: Sequence[str], touch: str, count: int, duration: float, timeout: float
    ) -> list[str]:
        """Wait until a sensor is pressed, let go, held, or pressed several times; answers which it was."""
        wanted = sensors_of(sensors)
        end = self.clock.now() + timeout_of(timeout)
        with self.events_of(*(sensor.event for sensor in wanted)) as events:
            watch = TouchWatch(wanted_of(touch, count, duration), self.pressed(wanted), self.clock.now())
            self.tell(WAITING, touched=watch.pressed)
            while True:
                due = watch.due
                for event, value in events.until(end if due is None else min(due, end)):
                    touched = watch.tell(BY_EVENT[event].name, bool(value), self.clock.now())
                    self.tell(WAITING, touched=watch.pressed)
                    if touched:
                        return self.felt.touch(touched)
                    if watch.due != due:
                        break  # something is held, or no longer
                else:
                    touched = watch.look(self.clock.now())
                    if touched or self.clock.now() >= end:
                        return self.felt.touch(touched)

    @checked_by(check_clicks)
    def wait_for_chest_button(self, count: int, timeout: float) -> list[str]:
        """Wait until the chest button is clicked once, twice or three times; answers chest."""
        event = CLICKS[count or 1]
        end = self.clock.now() + timeout_of(timeout)
        with self.events_of(event) as events:
            self.tell(WAITING)
            for _ in events.until(end):
                return self.felt.touch(["chest"])
        return []

    @checked_by(check_obstacle)
    def wait_for_obstacle(self, sensors: Sequence[str], distance: float, timeout: float) -> list[str]:
        """Wait until a sonar hears something nearer than a distance; answers which of them do."""
        sides = words_of(sensors, SIDES, "sonar")
        limit = distance or DEFAULT_DISTANCE
        end = self.clock.now() + timeout_of(timeout)
        with self.subscribed(SONAR, "wait"):
            self.tell(WAITING)
            # NAOqi's own events have a distance of their own; what the sonars measure is in the memory.
            self.wait(SONAR_START)
            while True:
                distances = dict(zip(sides, self.sonar(sides)))
                self.tell(WAITING, sonar=[distances.get(side, math.inf) for side in SIDES])
                near = {side: metres for side, metres in distances.items() if metres < limit}
                if near or self.clock.now() >= end:
                    self.felt.sonars += near.items()
                    return list(near)
                self.wait(SONAR_PERIOD)

    @checked_by(check_timeout)
    def wait_for_fall(self, timeout: float) -> bool:
        """Wait until the robot has fallen; answers whether it has."""
        end = self.clock.now() + timeout_of(timeout)
        with self.events_of(FALLEN) as events:
            self.tell(WAITING)
            for _, value in events.until(end):
                if value:
                    self.felt.fell = True
                    return True
        return False
