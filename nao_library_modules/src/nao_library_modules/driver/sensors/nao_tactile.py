"""The node nao_tactile: touch sensors, bumpers, the chest button and the feet."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import rospy
from std_msgs.msg import Bool

from nao_library_msgs.msg import Bumper, ChestButton, Fsr, HandTouch, HeadTouch, TactileTouch
from naoqi.errors import NaoError

from ...core.health import Report
from ...core.nao_facts import BY_EVENT, FOOT_CONTACT, SIDES, sensor_key, weight_keys
from ...core.robot import ask
from ...core.robot_events import EventRelay
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock, tf_prefix
from ..base.driver_node import LazyTopic, number, publish
from ..base.lazy_subscription import LazySubscription
from ..base.polling import Polling

log = logging.getLogger(__name__)

MEMORY = "ALMemory"
GRAVITY = 9.81
"""The robot gives forces in kg."""
CENTER = "{}Foot/FSR/CenterOfPressure/{}"
CONTACT = "{}FootContact"
LIGHTEST = 0.5
"""N: below it a foot has no centre of pressure."""


@dataclass(frozen=True)
class FootPressure:
    """One foot."""

    forces: tuple[float, ...]  # front left, front right, rear left, rear right, N
    total: float  # N
    center: tuple[float, float]  # of pressure, x, y in the frame of the sole, m; NaN without load
    contact: bool  # whether it touches the ground


def keys_of(side: str) -> list[str]:
    """Keys of one foot, in the order of `read_foot`."""
    center = [sensor_key(CENTER.format(side[0].upper(), axis)) for axis in "XY"]
    return [*weight_keys(side), *center, CONTACT.format(side)]


def read_foot(values: Sequence[Any]) -> FootPressure:
    """A foot from the values of its keys; missing ones are NaN."""
    numbers = [float(each) if isinstance(each, (bool, int, float)) else math.nan for each in values]
    forces = tuple(GRAVITY * each for each in numbers[:4])
    total = GRAVITY * numbers[4]
    loaded = total >= LIGHTEST
    center = (numbers[5], numbers[6]) if loaded else (math.nan, math.nan)
    return FootPressure(forces, total, center, numbers[7] > 0.5)


def read_feet(robot: Any) -> dict[str, FootPressure]:
    """Both feet, by side, in one call; raises NaoError if the robot cannot be asked."""
    keys = [key for side in SIDES for key in keys_of(side)]
    values = ask(robot, MEMORY, "getListData", keys)
    count = len(keys) // len(SIDES)
    return {side: read_foot(values[place * count : (place + 1) * count]) for place, side in enumerate(SIDES)}


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
        self, robot: Any, publish: Callable[[TouchSensor, bool], None], publish_clicks: Callable[[int], None]
    ) -> None:
        """Begin to listen; the robot need not be connected yet.

        Args:
            publish: Gets a sensor and whether it is touched, in a thread of libqi or of this object; must not wait.
            publish_clicks: Gets how often the chest button was clicked, likewise.
        """
        self._robot = robot
        self._publish = publish
        self._publish_clicks = publish_clicks
        # The lock is held while a change is published: changes of one sensor come in several threads of libqi.
        self._lock = threading.Lock()
        self._touched: dict[str, bool | None] = {s.event: None if s.place == FEET else False for s in SENSORS.values()}
        self._heard: set[str] = set()
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), self._on_event)
        self._listening = LazySubscription(robot, "touch sensors", self._begin, self._relay.close, self._look_again)
        self._listening.want(True)

    def report(self) -> Report:
        with self._lock:
            values = {event: {None: "unknown", True: "touched", False: ""}[now] for event, now in self._touched.items()}
        return self._listening.report("closed", "touches are published", "touches cannot be read", values)

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
        Returns True: nothing has to be restarted.
        """
        with self._lock:
            heard = [sensor for event, sensor in SENSORS.items() if event in self._heard]
            self._heard.clear()
        try:
            if heard:
                self._read({sensor: (sensor.event,) for sensor in heard})
        except NaoError as error:
            log.debug("touch sensors: %s", error)  # a lost connection is reported elsewhere; the next look asks again
            with self._lock:
                self._heard.update(sensor.event for sensor in heard)
        return True

    def _read(self, keys_of: Mapping[TouchSensor, Sequence[str]]) -> None:
        keys = [key for keys in keys_of.values() for key in keys]
        answer = ask(self._robot, MEMORY, "getListData", keys)
        values = dict(zip(keys, answer))
        for sensor, keys in keys_of.items():
            known = [values[key] for key in keys if isinstance(values[key], (bool, int, float))]
            if known:
                self._take(sensor, any(value > 0.5 for value in known), is_event=False)

    # --- in threads of libqi --------------------------------------------------------------------------------------

    def _on_event(self, name: str, value: Any) -> None:
        if name in CLICKS:
            self._publish_clicks(CLICKS[name])
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
                self._publish(sensor, touched)


QUEUE = 10
DEFAULT_RATE = 20.0


class NaoTactileNode:
    """What the touch sensors, bumpers, buttons and soles of one robot feel.

    Touches come from the robot's events; nothing is asked for again and again but the forces under the feet, while
    they have subscribers. A sensor that is touched when the robot is reached is published then.

    ROS API (relative names):
        Publishes `tactile_touch` (nao_library_msgs/TactileTouch) and `head_touch` (nao_library_msgs/HeadTouch): the
        same, under the older and the later name; `hand_touch` (nao_library_msgs/HandTouch), `bumper`
        (nao_library_msgs/Bumper), `chest_button` (nao_library_msgs/ChestButton), `foot_contact` (std_msgs/Bool,
        latched: whether at least one foot stands on the ground), `nao_robot/fsr/left`, `nao_robot/fsr/right`
        (nao_library_msgs/Fsr, while they have subscribers).
        Parameters `~fsr_rate` (20 Hz), `tf_prefix` (searched upwards; put before the frames).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._robot = robot
        self._head = node.publisher("tactile_touch", TactileTouch, queue_size=QUEUE)
        self._head_too = node.publisher("head_touch", HeadTouch, queue_size=QUEUE)
        self._hand = node.publisher("hand_touch", HandTouch, queue_size=QUEUE)
        self._bumper = node.publisher("bumper", Bumper, queue_size=QUEUE)
        self._chest = node.publisher("chest_button", ChestButton, queue_size=QUEUE)
        self._contact = node.publisher("foot_contact", Bool, queue_size=1, latch=True)
        self._prefix = tf_prefix()
        rate = number(node, "~fsr_rate", DEFAULT_RATE, "reading rate")
        self._pressure = Polling(robot, "foot pressure", rate, RosClock(), self._read)
        node.if_it_fails(self._pressure.close)
        self._feet = {side: node.publisher(f"nao_robot/fsr/{side}", Fsr, queue_size=QUEUE) for side in SIDES}
        self._lazy = LazyTopic(self._pressure.want, *self._feet.values())
        self._sensors = TouchSensors(robot, self._on_touch, self._on_clicks)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"touch": self._sensors.report, "foot pressure": self._pressure.report}

    def close(self) -> None:
        self._pressure.close()
        self._sensors.close()

    # --- touches; in threads of libqi -----------------------------------------------------------------------------

    def _on_touch(self, sensor: TouchSensor, touched: bool) -> None:
        which, state = sensor.number, int(touched)  # 0 released and 1 pressed in all these messages
        if sensor.place == HEAD:
            publish(self._head, TactileTouch(button=which, state=state))
            publish(self._head_too, HeadTouch(button=which, state=state))
        elif sensor.place == HAND:
            publish(self._hand, HandTouch(hand=which, state=state))
        elif sensor.place == BUMPER:
            publish(self._bumper, Bumper(bumper=which, state=state))
        elif sensor.place == CHEST:
            publish(self._chest, ChestButton(state=state))
        elif sensor.place == FEET:
            publish(self._contact, Bool(data=touched))

    def _on_clicks(self, count: int) -> None:
        publish(self._chest, ChestButton(state=ChestButton.stateReleased, clicks=count))

    # --- feet -----------------------------------------------------------------------------------------------------

    def _read(self) -> None:
        stamp = rospy.Time.now()
        for side, foot in read_feet(self._robot).items():
            if self._feet[side].get_num_connections():
                publish(self._feet[side], self._message(side, foot, stamp))

    def _message(self, side: str, foot: FootPressure, stamp: rospy.Time) -> Fsr:
        message = Fsr(total=foot.total, contact=foot.contact)
        message.header.stamp, message.header.frame_id = stamp, f"{self._prefix}{side[0]}_sole"
        message.front_left, message.front_right, message.rear_left, message.rear_right = foot.forces
        message.center_of_pressure.x, message.center_of_pressure.y = foot.center
        return message
