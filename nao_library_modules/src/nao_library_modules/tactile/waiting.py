"""Functions that wait until the robot feels something. Nothing in time is an answer, too."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from ..functions.chain import checked_by
from ..nao.body_devices import SIDES
from ..nao.touch_names import BY_EVENT, Sensor, sensors_of
from .checks import check_touch
from .fields import (
    CLICKS,
    DEFAULT_DISTANCE,
    Clicks,
    Distance,
    Presses,
    Sensors,
    Sonars,
    Timeout,
    Touch,
    TouchTime,
    timeout_of,
    wanted_of,
    words_of,
)
from .reading import SONAR, SONAR_START, ReadingFunctions
from .touch import Contact, TouchWatch

SONAR_PERIOD = 0.1
"""s between two measurements of a sonar."""
FALLEN = "robotHasFallen"
WAITING = "waiting"
CHEST = sensors_of(["chest"])


class WaitingFunctions(ReadingFunctions):
    """Parameters are fields of TactileFunction. What a function waited for has the robot's own times."""

    tell: Callable[..., None]  # of NaoTactile: publishes what is felt meanwhile
    remark: Callable[[str], None]  # of NaoBasic
    happened: tuple[float, float]  # of NaoBasic

    @checked_by(check_touch)
    def wait_for_touch(
        self, sensors: Sensors, touch: Touch, count: Presses, duration: TouchTime, timeout: Timeout
    ) -> list[str]:
        """Wait until a sensor is pressed, let go, held, or pressed several times; answers which it was."""
        wanted = sensors_of(sensors)
        end = self.clock.now() + timeout_of(timeout)
        with self.events_of(*(sensor.event for sensor in wanted)) as events:
            pressed = {contact.name: contact.begin for contact in self.contacts(wanted)}
            watch = TouchWatch(wanted_of(touch, count, duration), pressed, self.clock.now())
            self.tell(WAITING, touched=watch.pressed)
            while True:
                due = watch.due
                for event in events.until(end if due is None else min(due, end)):
                    when = self.event_time(event)
                    touched = watch.tell(BY_EVENT[event.name].name, bool(event.value), when)
                    self.tell(WAITING, touched=watch.pressed, stamp=when)
                    if touched:
                        return self._touched(touched)
                    if watch.due != due:
                        break  # something is held, or no longer
                else:
                    touched = self._held(watch, wanted)
                    if touched:
                        return self._touched(touched)
                    if self.clock.now() >= end:
                        already = "".join(f"; {name} is pressed already" for name in watch.pressed)
                        self.remark(f"no touch within {timeout_of(timeout):g} s{already}")
                        return []

    def _held(self, watch: TouchWatch, sensors: Sequence[Sensor]) -> list[Contact]:
        """What has been held long enough, also by the robot's times: that it was let go may be on the way."""
        if watch.due is None:
            return []
        held = [sensor for sensor in sensors if sensor.name in watch.pressed]
        told = [watch.tell(contact.name, False, contact.end) for contact in self.released(held)]
        return [*(contact for contacts in told for contact in contacts), *watch.look(self.clock.now())]

    def _touched(self, contacts: Sequence[Contact]) -> list[str]:
        ends = [contact.end for contact in contacts]
        self.happened = (
            min((contact.begin for contact in contacts), default=0.0),
            max(ends) if ends and all(ends) else 0.0,
        )
        return self.measurements.touch(contacts)

    def wait_for_chest_button(self, count: Clicks, timeout: Timeout) -> list[str]:
        """Wait until the chest button is clicked once, twice or three times; answers chest."""
        clicked, (button,) = CLICKS[count or 1], CHEST
        end = self.clock.now() + timeout_of(timeout)
        with self.events_of(clicked, button.event) as events:
            presses = [contact.begin for contact in self.contacts(CHEST)]
            self.tell(WAITING, touched=["chest"] * len(presses))
            for event in events.until(end):
                if event.name == clicked:
                    # Of clicks that began before the wait the first contact is not known.
                    first = presses[-(count or 1)] if len(presses) >= (count or 1) else 0.0
                    (last,) = self.released(CHEST) or [Contact("chest", 0.0)]  # pressed again: its end is not known
                    return self._touched([Contact("chest", first, last.end)])
                when = self.event_time(event)
                if event.value and when not in presses:
                    presses.append(when)
                self.tell(WAITING, touched=["chest"] if event.value else [], stamp=when)
        self.remark(f"no click within {timeout_of(timeout):g} s")
        return []

    def wait_for_obstacle(self, sensors: Sonars, distance: Distance, timeout: Timeout) -> list[str]:
        """Wait until a sonar hears something nearer than a distance; answers which of them do."""
        sides = words_of(sensors, SIDES, "sonar")
        limit = distance or DEFAULT_DISTANCE
        end = self.clock.now() + timeout_of(timeout)
        with self.subscribed(SONAR, "wait"):
            self.tell(WAITING)
            # NAOqi's own events have a distance of their own; what the sonars measure is in the memory.
            self.wait(SONAR_START)
            while True:
                now = self.clock.now()
                distances = dict(zip(sides, self.sonar(sides)))
                self.tell(WAITING, sonar=[distances.get(side, math.inf) for side in SIDES])
                near = {side: metres for side, metres in distances.items() if metres < limit}
                if near or self.clock.now() >= end:
                    self.measurements.sonars += near.items()
                    self.happened = (now if near else 0.0, 0.0)
                    if not near:
                        self.remark(f"nothing nearer than {limit:g} m within {timeout_of(timeout):g} s")
                    return list(near)
                self.wait(SONAR_PERIOD)

    def wait_for_fall(self, timeout: Timeout) -> bool:
        """Wait until the robot has fallen; answers whether it has."""
        end = self.clock.now() + timeout_of(timeout)
        with self.events_of(FALLEN) as events:
            self.tell(WAITING)
            for event in events.until(end):
                if event.value:
                    self.happened = (self.event_time(event), 0.0)
                    self.measurements.fell = True
                    return True
        self.remark(f"no fall within {timeout_of(timeout):g} s")
        return False

    functions = {
        "waitForTouch": wait_for_touch,
        "waitForChestButton": wait_for_chest_button,
        "waitForObstacle": wait_for_obstacle,
        "waitForFall": wait_for_fall,
    }
