"""What a robot hears, sees and says, and what touches it, as events of its stream, while somebody wants to know."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from .background import Subscriptions, Takers
from .latched import Latched, Recovery
from .memory_topics import MemoryTopics
from .sense_texts import BUMPER, CHEST, HAND, HEAD, Perception, Sightings, clicked, heard, said, touched

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
