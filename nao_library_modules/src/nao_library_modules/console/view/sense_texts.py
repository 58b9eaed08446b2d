"""What the robot's senses tell, as events for people: kind, text and values of JSON. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Mapping

from ...nao.touch_names import SENSORS

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
