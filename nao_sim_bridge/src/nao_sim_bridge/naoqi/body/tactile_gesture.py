"""ALTactileGesture of the simulated robot: gestures on the head."""

from __future__ import annotations

import threading
from typing import Any, Sequence

import qi

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.touch_gestures import FREE, LONGEST_TIME, GestureBook, GestureRecogniser, Times
from nao_sim_bridge.model.touch_names import HEAD
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALTactileGesture"
GESTURE, RELEASE = f"{NAME}/Gesture", f"{NAME}/Release"


class ALTactileGesture:
    """ALTactileGesture as the simulated robot offers it; called after every tick for its events and signals."""

    def __init__(self, memory: MemoryStore) -> None:
        self._book = GestureBook()
        self._times = Times()
        self._on_gesture, self._on_release = qi.Signal("(s)"), qi.Signal("()")
        self._recogniser = GestureRecogniser(self._book, self._times)
        self._memory = memory
        self._lock = threading.Lock()  # methods come in several threads
        for event in (GESTURE, RELEASE):
            memory.declare_event(event, NAME)

    def __call__(self, snapshot: Snapshot) -> None:
        touched = snapshot.touched
        pattern = "".join("1" if sensor in touched else "0" for sensor in HEAD) if touched else FREE
        seen = self._recogniser.feed(pattern, snapshot.time)
        if seen.gesture:
            self._memory.raise_event(GESTURE, seen.gesture)
            self._on_gesture(seen.gesture)
        if seen.released:
            self._memory.raise_event(RELEASE, 1)
            self._on_release()

    @property
    def signals(self) -> dict[str, Any]:
        return {"onGesture": self._on_gesture, "onRelease": self._on_release}

    def take_over(self, former: ALTactileGesture) -> None:
        """Go on with the signals that clients are connected to."""
        self._on_gesture, self._on_release = former._on_gesture, former._on_release
        former._on_gesture = former._on_release = lambda *_: None

    def createGesture(self, sequence: Any) -> str:
        with self._lock:
            return self._book.add(_patterns(sequence))

    def getGesture(self, sequence: Any) -> str | None:
        return self._book.name_of(_patterns(sequence))

    def getGestures(self) -> dict[str, list[str]]:
        with self._lock:
            return self._book.all()

    def getSequence(self, name: str) -> list[str]:
        with self._lock:
            sequence = self._book.sequence_of(name)
        return [] if sequence is None else sequence

    def setHoldTime(self, seconds: Any) -> bool:
        return self._set_time("hold", seconds)

    def setSequenceTime(self, seconds: Any) -> bool:
        return self._set_time("sequence", seconds)

    def setSettleTime(self, seconds: Any) -> bool:
        return self._set_time("settle", seconds)

    def _set_time(self, which: str, seconds: Any) -> bool:
        setattr(self._times, which, _time(seconds, f"{which} time"))
        return True


def _patterns(sequence: str | Sequence[str]) -> list[str]:
    """A list of patterns, which NAOqi also takes as a text with commas."""
    return [word.strip() for word in sequence.split(",")] if isinstance(sequence, str) else list(sequence)


def _time(value: Any, field: str) -> float:
    """A time in s, which NAOqi also takes as a text."""
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            raise BadValue(field, value[:40], "a number of seconds") from None
    return number(value, field, 0.0, LONGEST_TIME)
