"""Touch sensors, buttons and contact of the feet: their events, and their state at the beginning. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...nao.body_devices import FOOT_CONTACT
from ...nao.touch_names import BY_EVENT
from ...robot.event_relay import EventRelay
from ...ros.health import Report
from ..base.lazy_subscription import LazySubscription

log = logging.getLogger(__name__)

MEMORY = "ALMemory"
HEAD, HAND, BUMPER, CHEST, FEET = "head", "hand", "bumper", "chest button", "feet"


@dataclass(frozen=True)
class TouchSensor:
    """A sensor that is touched while one of its keys in the robot's memory is not 0."""

    event: str  # raised at each change
    place: str  # HEAD, HAND, BUMPER, CHEST or FEET
    number: int  # as the message of that place numbers them
    keys: tuple[str, ...]


PLACES = {
    "FrontTactilTouched": (HEAD, 1),
    "MiddleTactilTouched": (HEAD, 2),
    "RearTactilTouched": (HEAD, 3),
    "HandRightBackTouched": (HAND, 0),
    "HandRightLeftTouched": (HAND, 1),
    "HandRightRightTouched": (HAND, 2),
    "HandLeftBackTouched": (HAND, 3),
    "HandLeftLeftTouched": (HAND, 4),
    "HandLeftRightTouched": (HAND, 5),
    "RightBumperPressed": (BUMPER, 0),
    "LeftBumperPressed": (BUMPER, 1),
    "ChestButtonPressed": (CHEST, 0),
}
SENSORS = {
    **{event: TouchSensor(event, *place, BY_EVENT[event].keys) for event, place in PLACES.items()},
    "footContactChanged": TouchSensor("footContactChanged", FEET, 0, (FOOT_CONTACT,)),
}
"""Event -> its sensor."""
CLICKS = {
    "ALChestButton/SimpleClickOccurred": 1,
    "ALChestButton/DoubleClickOccurred": 2,
    "ALChestButton/TripleClickOccurred": 3,
}


class TouchSensors:
    """Reports every change of every sensor, also after a lost connection.

    The state at the beginning counts as a change if the sensor is touched, and so does what has changed while the robot
    was lost; for the feet the beginning is always reported.
    """

    def __init__(
        self, robot: Any, tell: Callable[[TouchSensor, bool], None], tell_clicks: Callable[[int], None]
    ) -> None:
        """Begin to listen; the robot need not be connected yet.

        Args:
            tell: Gets a sensor and whether it is touched, in a thread of libqi or of this object; must not wait.
            tell_clicks: Gets how often the chest button was clicked, likewise.
        """
        self._robot = robot
        self._tell = tell
        self._tell_clicks = tell_clicks
        # The lock is held while a change is told: changes of one sensor come in several threads of libqi.
        self._lock = threading.Lock()
        self._touched: dict[str, bool | None] = {s.event: None if s.place == FEET else False for s in SENSORS.values()}
        self._heard: set[str] = set()
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), self._on_event)
        self._listening = LazySubscription(robot, "touch sensors", self._begin, self._relay.close, self._look_again)
        self._listening.want(True)

    def report(self) -> Report:
        with self._lock:
            values = {event: {None: "unknown", True: "touched", False: ""}[now] for event, now in self._touched.items()}
        return self._listening.report("closed", "touches are told", "deaf", values)

    def close(self) -> None:
        self._listening.close()

    # --- in the thread of the demand ------------------------------------------------------------------------------

    def _begin(self) -> None:
        self._relay.close()  # events of a connection that was lost
        with self._lock:
            self._heard.clear()
        for event in (*SENSORS, *CLICKS):
            self._relay.subscribe(event)
        self._read({sensor: sensor.keys for sensor in SENSORS.values()})

    def _look_again(self) -> bool:
        """Read the sensors whose events came: libqi delivers events in quick succession in any order.

        The keys of the sensors would not do: a bouncing foot has no contact for a moment, for which there is no event.
        Returns True: nothing has to be started anew.
        """
        with self._lock:
            heard = [sensor for event, sensor in SENSORS.items() if event in self._heard]
            self._heard.clear()
        try:
            if heard:
                self._read({sensor: (sensor.event,) for sensor in heard})
        except NaoError as error:
            log.debug("touch sensors: %s", error)  # a lost connection is told elsewhere; the next look asks again
            with self._lock:
                self._heard.update(sensor.event for sensor in heard)
        return True

    def _read(self, keys_of: Mapping[TouchSensor, Sequence[str]]) -> None:
        keys = [key for keys in keys_of.values() for key in keys]
        answer = self._robot.proxy(MEMORY).call_async("getListData", keys).result(timeout=ANSWER_LIMIT)
        values = dict(zip(keys, answer))
        for sensor, keys in keys_of.items():
            known = [values[key] for key in keys if isinstance(values[key], (bool, int, float))]
            if known:
                self._take(sensor, any(value > 0.5 for value in known), is_event=False)

    # --- in threads of libqi --------------------------------------------------------------------------------------

    def _on_event(self, name: str, value: Any) -> None:
        if name in CLICKS:
            self._tell_clicks(CLICKS[name])
        elif isinstance(value, (bool, int, float)):
            self._take(SENSORS[name], value > 0.5, is_event=True)

    def _take(self, sensor: TouchSensor, touched: bool, is_event: bool) -> None:
        with self._lock:
            if is_event:
                self._heard.add(sensor.event)
            elif sensor.event in self._heard:
                return  # what was read is older than the event
            if self._touched[sensor.event] is not touched:
                self._touched[sensor.event] = touched
                self._tell(sensor, touched)
