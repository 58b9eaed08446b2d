"""What a robot hears, sees, says and feels, as events: from topics of its memory, while a page or a trial follows them.

A latched topic, or a key of the robot's memory, first sends its present value to a new subscriber. It sends the value
again when the robot has been reconnected or the node behind the topic has restarted. Neither is an event.
"""

from __future__ import annotations

import math
import re
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Mapping

from naoqi.errors import NaoError

from ...core.errors import did_you_mean
from ...core.nao_facts import SENSORS
from .background import Subscriptions, Takers

CONNECTED = frozenset({"connected", "silent"})
"""States of nao_library_msgs/ConnectionState in which the robot is known to be the one of before."""
SETTLED = 10.0
"""s of this computer after a connection is back, within which topics send their present state."""


class Recovery:
    """Whether the robot is lost or has just been reconnected: the next message is a state then. Any thread.

    `clock`: s of this computer.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._until = -math.inf

    @property
    def lasts(self) -> bool:
        return self._clock() < self._until

    def end(self) -> None:
        """The state has arrived."""
        self._until = -math.inf

    def connection_is(self, state: str) -> None:
        """The connection to the robot changes. `state`: of nao_library_msgs/ConnectionState."""
        if state not in CONNECTED:
            self._until = math.inf
        elif self._until == math.inf:
            self._until = self._clock() + SETTLED


class Latched:
    """The state of one latched topic. Any thread.

    Args:
        repeats: The topic holds the last event, as a sentence or a fall: each message is news, whatever its value,
            unless it only repeats the present one. Otherwise only a changed value is news.
        clock: s of this computer.

    Attributes:
        value: The state; None before the first message.
        held: Whether the topic had a value when it was subscribed; only `repeats` needs to know.
        recovery: Takes the state of the connection; after a lost one the next message is a state.
    """

    def __init__(self, repeats: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._repeats = repeats
        self.recovery = Recovery(clock)
        self._lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Forget the state, at the end of the subscription."""
        with self._lock:
            self.value: Any = None
            self.held = False
            self._link: Any = None
            self._heard = False
            self.recovery.end()

    def take(self, value: Any, message: Any = None) -> bool:
        """Take the value of a message; whether it is news. `message`: of rospy, with the header of its connection."""
        link = getattr(message, "_connection_header", None)
        with self._lock:
            first_of_link = not self._heard or link is not self._link
            known = self._heard or self.held
            before, self.value = self.value, value
            self._link, heard, self._heard = link, self._heard, True
            if not self._repeats:
                return heard and value != before
            state = (first_of_link and known) or self.recovery.lasts
            self.recovery.end()
            return not state


FLOAT, TEXT = "float", "string"
NOTHING = "null"
"""JSON of a key without a value."""
RATE = 10.0
"""Hz, at most so many messages of a key."""


class MemoryTopics:
    """The memory of one robot. Any thread; `watch` and what it returns call services and may take a while."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._lock = threading.Lock()
        self._own: dict[str, int] = {}  # key -> how many watch it; of those that nobody else has watched

    def watch(self, key: str, kind: str, callback: Callable[[Any], None]) -> Callable[[], None]:
        """Have messages of a key: FloatStamped for FLOAT (whole numbers and truth values too), StringStamped for TEXT.

        Returns what ends it. Raises NaoError if there is no nao_memory, or no such key.
        """
        from nao_library_msgs.msg import FloatStamped, StringStamped
        from nao_library_msgs.srv import ListMemory, WatchMemory

        if any(sign in key for sign in "*?[") or not key:
            raise NaoError(f"{key!r} is no key: one key, without * and ?")
        before = self._robot.call("nao_memory/list", ListMemory, pattern=key)
        if not before.keys:
            known = self._robot.call("nao_memory/list", ListMemory, pattern="").keys
            raise NaoError(f"the robot's memory has no key {key!r}{did_you_mean(key, known)}")
        watched = bool(before.topics and before.topics[0])
        answer = self._robot.call("nao_memory/watch", WatchMemory, pattern=key, rate=RATE, type=kind)
        topic = next(iter(answer.topics), "")
        if not topic:
            raise NaoError(f"{key}: {answer.message or 'it has no topic'}")
        with self._lock:
            own = key in self._own or not watched
            if own:
                self._own[key] = self._own.get(key, 0) + 1
        end = self._robot.topic(topic, FloatStamped if kind == FLOAT else StringStamped, callback)

        def leave() -> None:
            end()
            if own:
                self._leave(key)

        return leave

    def watch_last(self, key: str, last: Latched, callback: Callable[[Any], None]) -> Callable[[], None]:
        """As `watch`, a key of texts that holds what happened last: whether it holds anything yet is asked before."""
        from nao_library_msgs.srv import GetMemory

        answer = self._robot.call("nao_memory/get", GetMemory, pattern=key)
        last.held = any(value != NOTHING for value in answer.values)
        return self.watch(key, TEXT, callback)

    def _leave(self, key: str) -> None:
        from nao_library_msgs.srv import UnwatchMemory

        with self._lock:
            self._own[key] -= 1
            if self._own[key]:
                return
            del self._own[key]
        try:
            self._robot.call("nao_memory/unwatch", UnwatchMemory, pattern=key)
        except NaoError:
            pass  # the driver has ended, and its watch with it


HEAD = {1: "front head", 2: "middle head", 3: "rear head"}
HAND = dict(enumerate(f"{side} hand {part}" for side in ("right", "left") for part in ("back", "left", "right")))
BUMPER = {0: "right bumper", 1: "left bumper"}
CHEST = "chest"
"""Short names of touch sensors by their numbers in the driver's messages."""
DEVICES = {sensor.name: sensor.devices for sensor in SENSORS}
CLICKS = {1: "once", 2: "twice"}
AGAIN = 2.0
"""s for which something must be out of sight to be told of anew."""
TAG = re.compile(r"\\[a-z]+=[^\\]*\\|\^[a-zA-Z]+(\([^)]*\))?")
"""Marks in a text to be spoken: \\rspd=90\\, ^start(animations/...)."""


@dataclass(frozen=True)
class Perception:
    """Something that a robot has perceived.

    Attributes:
        kind: heard, touched, seen, felt or said: that of a ConsoleEvent.
        values: Of the event, as JSON has them.
    """

    kind: str
    text: str
    values: Mapping[str, Any] = field(default_factory=dict)


def heard(words: Sequence[str], confidences: Sequence[float]) -> Perception | None:
    """Words, the best first; None if there are none."""
    found = [(word, round(float(sure), 3)) for word, sure in zip(words, confidences) if word.strip()]
    if not found:
        return None
    values = {"words": [word for word, _ in found], "confidences": [sure for _, sure in found]}
    return Perception("heard", f"{found[0][0]!r} ({100 * found[0][1]:.0f} % sure)", values)


def touched(sensor: str, pressed: bool) -> Perception:
    values = {"sensor": sensor, "touched": pressed, "devices": list(DEVICES.get(sensor, ()))}
    return Perception("touched", f"{sensor} {'pressed' if pressed else 'released'}", values)


def clicked(count: int) -> Perception:
    times = CLICKS.get(count, f"{count} times")
    return Perception("touched", f"chest button clicked {times}", {"sensor": CHEST, "clicks": count})


def said(sentence: str) -> Perception | None:
    """A sentence that the robot says; None at its end."""
    text = " ".join(TAG.sub(" ", sentence).split())
    return Perception("said", text, {"sentence": text}) if text else None


def felt(text: str, **values: Any) -> Perception:
    return Perception("felt", text, values)


class Sightings:
    """What is in sight, so that it is told when it comes, not with every picture."""

    def __init__(self) -> None:
        self._last: dict[str, float] = {}

    def seen(self, what: str, name: str, stamp: float) -> Perception | None:
        """A face, a landmark, a movement, at a time in s; None if it was in sight before."""
        text = f"{what} {name}".strip()
        before = self._last.get(text)
        self._last[text] = stamp
        if before is not None and 0.0 <= stamp - before < AGAIN:
            return None
        return Perception("seen", text, {"what": what, "name": name})


SENTENCE = "ALTextToSpeech/CurrentSentence"


class Senses:
    """The senses of one robot. Any thread. What is a state of it, as its posture, is in `BodyWatch`.

    ROS API (relative names):
        Subscribes, while somebody wants it, `word_recognized`, `head_touch`, `hand_touch`, `bumper`, `chest_button`,
        `nao_vision/faces_detected`, `nao_vision/landmark_detected`, `nao_vision/movement_detected`, `connection`, and
        of the robot's memory (`nao_memory/watch`) what it says.

    Attributes:
        acquire: Has its perceptions added to `robot.events` until what it returns is called.
        pressed: Touch sensors that are pressed, by their names in the robot's memory; replaced at each change.
    """

    def __init__(self, robot: Any, memory: MemoryTopics) -> None:
        self._robot = robot
        self._memory = memory
        self._lock = threading.Lock()
        self.acquire = Takers(lambda: self._subscriptions.begin(*self._starts()), self._end).acquire
        self._subscriptions = Subscriptions(f"senses of {robot.name}")
        self._sightings = Sightings()
        self._spoken = Latched(repeats=True)  # the newest sentence
        self._touch_recovery = Recovery()
        self.pressed: frozenset[str] = frozenset()

    def _end(self) -> None:
        with self._lock:
            self.pressed = frozenset()
        self._spoken.clear()
        self._touch_recovery.end()
        self._subscriptions.end()

    def _starts(self) -> list[Callable[[], Callable[[], None]]]:
        """What begins each subscription; that of the memory comes last, as it may take a while to answer."""
        from nao_library_msgs import msg

        topics = (
            ("word_recognized", msg.WordRecognized, lambda told: self._tell(heard(told.words, told.confidence_values))),
            ("head_touch", msg.HeadTouch, lambda told: self._touch(HEAD.get(told.button), told.state)),
            ("hand_touch", msg.HandTouch, lambda told: self._touch(HAND.get(told.hand), told.state)),
            ("bumper", msg.Bumper, lambda told: self._touch(BUMPER.get(told.bumper), told.state)),
            ("chest_button", msg.ChestButton, self._on_chest),
            ("connection", msg.ConnectionState, self._on_connection),
            ("nao_vision/faces_detected", msg.FaceDetected, self._on_face),
            ("nao_vision/landmark_detected", msg.LandmarkDetected, self._on_landmarks),
            ("nao_vision/movement_detected", msg.MovementDetected, partial(self._see, "movement", "")),
        )
        return [
            *(partial(self._robot.topic, name, kind, callback, queue_size=50) for name, kind, callback in topics),
            partial(self._memory.watch_last, SENTENCE, self._spoken, self._on_sentence),
        ]

    def _tell(self, perception: Perception | None, stamp: float | None = None) -> None:
        if perception is not None:
            self._robot.events.add(perception.kind, perception.text, stamp=stamp, **perception.values)

    # --- messages, in threads of ROS ------------------------------------------------------------------------------

    def _touch(self, sensor: str | None, state: int) -> None:
        if sensor is None:
            return
        perception = touched(sensor, bool(state))
        devices = frozenset(perception.values["devices"])
        with self._lock:
            again = state and devices <= self.pressed
            self.pressed = self.pressed | devices if state else self.pressed - devices
        if not (again and self._touch_recovery.lasts):  # a driver that is back tells what is touched
            self._tell(perception)

    def _on_chest(self, told: Any) -> None:
        if told.clicks:
            self._tell(clicked(told.clicks))
        else:
            self._touch(CHEST, told.state)

    def _on_face(self, told: Any) -> None:
        self._see("face", told.face_label.data, told)

    def _on_landmarks(self, told: Any) -> None:
        for mark in told.mark_ids:
            self._see("landmark", str(mark.data), told)

    def _see(self, what: str, name: str, told: Any) -> None:
        # By arrival: stamps of a robot's pictures may be of its own clock.
        stamp = told.header.stamp.to_sec() or None
        self._tell(self._sightings.seen(what, name, self._robot.now()), stamp)

    def _on_connection(self, told: Any) -> None:
        for each in (self._spoken.recovery, self._touch_recovery):
            each.connection_is(told.state)

    def _on_sentence(self, told: Any) -> None:
        if self._spoken.take(told.data, told):
            self._tell(said(told.data), told.header.stamp.to_sec())
