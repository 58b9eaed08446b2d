"""Functions that wait until the robot feels something. Nothing in time is an answer, too."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..functions.chain import checked_by
from ..functions.parts import Part
from ..nao.body_devices import SIDES
from ..nao.touch_names import BY_EVENT, Sensor, sensors_of
from ..server.nao_basic import NaoBasic
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
    require_touch,
    timeout_of,
    wanted_of,
    words_of,
)
from .reading import SONAR, SONAR_START, Senses
from .touch import Contact, TouchWatch

SONAR_PERIOD = 0.1
"""s between two measurements of a sonar."""
FALLEN = "robotHasFallen"
WAITING = "waiting"
CHEST = sensors_of(["chest"])


class WaitingFunctions(Part):
    """Parameters are fields of TactileFunction. What a function waited for has the robot's own times."""

    def __init__(self, module: NaoBasic, senses: Senses) -> None:
        self._module = module
        self._senses = senses

    def _check_touch(self, touch: str, count: int, duration: float) -> None:
        require_touch(touch, count, duration)

    @checked_by(_check_touch)
    def wait_for_touch(
        self, sensors: Sensors, touch: Touch, count: Presses, duration: TouchTime, timeout: Timeout
    ) -> list[str]:
        """Wait until a sensor is pressed, let go, held, or pressed several times; answers which it was."""
        wanted = sensors_of(sensors)
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.events_of(*(sensor.event for sensor in wanted)) as events:
            pressed = {contact.name: contact.begin for contact in self._senses.contacts(wanted)}
            watch = TouchWatch(wanted_of(touch, count, duration), pressed, self._module.clock.now())
            self._senses.publish(WAITING, touched=watch.pressed)
            while True:
                due = watch.due
                for event in events.until(end if due is None else min(due, end)):
                    when = self._senses.event_time(event)
                    touched = watch.tell(BY_EVENT[event.name].name, bool(event.value), when)
                    self._senses.publish(WAITING, touched=watch.pressed, stamp=when)
                    if touched:
                        return self._touched(touched)
                    if watch.due != due:
                        break  # something is held, or no longer
                else:
                    touched = self._held(watch, wanted)
                    if touched:
                        return self._touched(touched)
                    if self._module.clock.now() >= end:
                        already = "".join(f"; {name} is pressed already" for name in watch.pressed)
                        self._module.remark(f"no touch within {timeout_of(timeout):g} s{already}")
                        return []

    def _held(self, watch: TouchWatch, sensors: Sequence[Sensor]) -> list[Contact]:
        """What has been held long enough, also by the robot's times: that it was let go may be on the way."""
        if watch.due is None:
            return []
        held = [sensor for sensor in sensors if sensor.name in watch.pressed]
        told = [watch.tell(contact.name, False, contact.end) for contact in self._senses.released(held)]
        return [*(contact for contacts in told for contact in contacts), *watch.look(self._module.clock.now())]

    def _touched(self, contacts: Sequence[Contact]) -> list[str]:
        ends = [contact.end for contact in contacts]
        self._module.happened = (min(contact.begin for contact in contacts), max(ends) if all(ends) else 0.0)
        return self._senses.measurements.touch(contacts)

    def wait_for_chest_button(self, count: Clicks, timeout: Timeout) -> list[str]:
        """Wait until the chest button is clicked once, twice or three times; answers chest."""
        clicked, (button,) = CLICKS[count or 1], CHEST
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.events_of(clicked, button.event) as events:
            presses = [contact.begin for contact in self._senses.contacts(CHEST)]
            self._senses.publish(WAITING, touched=["chest"] * len(presses))
            for event in events.until(end):
                if event.name == clicked:
                    # Of clicks that began before the wait the first contact is not known.
                    first = presses[-(count or 1)] if len(presses) >= (count or 1) else 0.0
                    # Where it is pressed again, its end is not known.
                    (last,) = self._senses.released(CHEST) or [Contact("chest", 0.0)]
                    return self._touched([Contact("chest", first, last.end)])
                when = self._senses.event_time(event)
                if event.value and when not in presses:
                    presses.append(when)
                self._senses.publish(WAITING, touched=["chest"] if event.value else [], stamp=when)
        self._module.remark(f"no click within {timeout_of(timeout):g} s")
        return []

    def wait_for_obstacle(self, sensors: Sonars, distance: Distance, timeout: Timeout) -> list[str]:
        """Wait until a sonar hears something nearer than a distance; answers which of them do."""
        sides = words_of(sensors, SIDES, "sonar")
        limit = distance or DEFAULT_DISTANCE
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.subscribed(SONAR, "wait"):
            self._senses.publish(WAITING)
            # NAOqi's own events have a distance of their own; what the sonars measure is in the memory.
            self._senses.wait(SONAR_START)
            while True:
                now = self._module.clock.now()
                distances = dict(zip(sides, self._senses.sonar(sides)))
                self._senses.publish(WAITING, sonar=[distances.get(side, math.inf) for side in SIDES])
                near = {side: metres for side, metres in distances.items() if metres < limit}
                if near or self._module.clock.now() >= end:
                    self._senses.measurements.sonars += near.items()
                    self._module.happened = (now if near else 0.0, 0.0)
                    if not near:
                        self._module.remark(f"nothing nearer than {limit:g} m within {timeout_of(timeout):g} s")
                    return list(near)
                self._senses.wait(SONAR_PERIOD)

    def wait_for_fall(self, timeout: Timeout) -> bool:
        """Wait until the robot has fallen; answers whether it has."""
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.events_of(FALLEN) as events:
            self._senses.publish(WAITING)
            for event in events.until(end):
                if event.value:
                    self._module.happened = (self._senses.event_time(event), 0.0)
                    self._senses.measurements.fell = True
                    return True
        self._module.remark(f"no fall within {timeout_of(timeout):g} s")
        return False

    functions = {
        "waitForTouch": wait_for_touch,
        "waitForChestButton": wait_for_chest_button,
        "waitForObstacle": wait_for_obstacle,
        "waitForFall": wait_for_fall,
    }
