"""What a robot hears, sees, feels and says, as events of its stream, while somebody wants to know."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from .background import Subscriptions, Takers
from .memory_topics import TEXT, MemoryTopics
from .sense_texts import BUMPER, CHEST, HAND, HEAD, Perception, Sightings, clicked, felt, heard, said, touched

SENTENCE, POSTURE, FALLEN = "ALTextToSpeech/CurrentSentence", "PostureChanged", "robotHasFallen"


class Senses:
    """The senses of one robot. Any thread.

    ROS API (relative names):
        Subscribes, while somebody wants it, `word_recognized`, `head_touch`, `hand_touch`, `bumper`, `chest_button`,
        `foot_contact`, `nao_vision/faces_detected`, `nao_vision/landmark_detected`, `nao_vision/movement_detected`,
        and of the robot's memory (`nao_memory/watch`) what it says, its posture and whether it has fallen.

    Attributes:
        acquire: Has its perceptions added to `robot.events` until what it returns is called.
        posture: As the robot calls it; empty until it is told.
        pressed: Touch sensors that are pressed, by their names in the robot's memory; replaced at each change.
    """

    def __init__(self, robot: Any, memory: MemoryTopics) -> None:
        self._robot = robot
        self._memory = memory
        self._lock = threading.Lock()
        self.acquire = Takers(lambda: self._subscriptions.begin(*self._starts()), self._end).acquire
        self._subscriptions = Subscriptions(f"senses of {robot.name}")
        self._sightings = Sightings()
        self._stands: bool | None = None
        self._spoken: str | None = None  # the newest sentence; None: not told yet
        self.posture = ""
        self.pressed: frozenset[str] = frozenset()

    def _end(self) -> None:
        with self._lock:
            self.posture, self.pressed, self._stands, self._spoken = "", frozenset(), None, None
        self._subscriptions.end()

    def _starts(self) -> list[Callable[[], Callable[[], None]]]:
        """What begins each subscription; those of the memory come last, as it may take a while to answer."""
        from std_msgs.msg import Bool

        from nao_library_msgs import msg

        topics = (
            ("word_recognized", msg.WordRecognized, lambda told: self._tell(heard(told.words, told.confidence_values))),
            ("head_touch", msg.HeadTouch, lambda told: self._touch(HEAD.get(told.button), told.state)),
            ("hand_touch", msg.HandTouch, lambda told: self._touch(HAND.get(told.hand), told.state)),
            ("bumper", msg.Bumper, lambda told: self._touch(BUMPER.get(told.bumper), told.state)),
            ("chest_button", msg.ChestButton, self._on_chest),
            ("foot_contact", Bool, self._on_contact),
            ("nao_vision/faces_detected", msg.FaceDetected, self._on_face),
            ("nao_vision/landmark_detected", msg.LandmarkDetected, self._on_landmarks),
            ("nao_vision/movement_detected", msg.MovementDetected, partial(self._see, "movement", "")),
        )
        keys = ((SENTENCE, self._on_sentence), (POSTURE, self._on_posture), (FALLEN, self._on_fall))
        return [
            *(partial(self._robot.topic, name, kind, callback, queue_size=50) for name, kind, callback in topics),
            *(partial(self._memory.watch, key, TEXT, callback) for key, callback in keys),
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
            self.pressed = self.pressed | devices if state else self.pressed - devices
        self._tell(perception)

    def _on_chest(self, told: Any) -> None:
        if told.clicks:
            self._tell(clicked(told.clicks))
        else:
            self._touch(CHEST, told.state)

    def _on_contact(self, told: Any) -> None:
        before, self._stands = self._stands, told.data
        if before is not None and before != told.data:
            self._tell(felt("stands on the ground" if told.data else "has lost the ground", ground=told.data))

    def _on_face(self, told: Any) -> None:
        self._see("face", told.face_label.data, told)

    def _on_landmarks(self, told: Any) -> None:
        for mark in told.mark_ids:
            self._see("landmark", str(mark.data), told)

    def _see(self, what: str, name: str, told: Any) -> None:
        # By arrival: stamps of a robot's pictures may be of its own clock.
        stamp = told.header.stamp.to_sec() or None
        self._tell(self._sightings.seen(what, name, self._robot.now()), stamp)

    def _on_sentence(self, told: Any) -> None:
        before, self._spoken = self._spoken, told.data
        if before is not None:  # the first message has what was said before anybody listened
            self._tell(said(told.data), told.header.stamp.to_sec())

    def _on_posture(self, told: Any) -> None:
        before, self.posture = self.posture, told.data
        if before and told.data != before:
            self._tell(felt(f"posture {told.data}", posture=told.data), told.header.stamp.to_sec())

    def _on_fall(self, told: Any) -> None:
        if told.data.lower() in ("true", "1", "1.0"):
            self._tell(felt("has fallen", fallen=True), told.header.stamp.to_sec())
