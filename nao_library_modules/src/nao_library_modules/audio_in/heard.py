"""What a goal has heard so far, and the messages that carry it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from genpy import Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header

from nao_library_msgs.msg import HeardSound, RecordedFile

from .events import LocatedSound

HEAD, BASE = "Head", "base_footprint"
"""Frames of the robot, as its description and nao_joint_states name them."""


class Span(NamedTuple):
    """From when to when something was heard.

    Attributes:
        onset: ROS time of its first sound, s; 0: not known.
        end: ROS time of its last sound, s; 0: not known, or it has not ended.
    """

    onset: float = 0.0
    end: float = 0.0


class HeardWord(NamedTuple):
    """A word or phrase that was recognised.

    Attributes:
        word: As the vocabulary has it.
        confidence: 0..1.
        span: When it was said.
    """

    word: str
    confidence: float
    span: Span


class Heard:
    """What the functions of one chain heard, for its result."""

    def __init__(self) -> None:
        """Nothing yet."""
        self.words: list[str] = []
        self.confidences: list[float] = []
        self.spans: list[Span] = []
        self.sounds: list[HeardSound] = []
        self.files: list[RecordedFile] = []
        self.microphones: list[str] = []
        self.energies: list[float] = []

    def add_words(self, words: Sequence[HeardWord]) -> None:
        """Note words."""
        self.words += [heard.word for heard in words]
        self.confidences += [heard.confidence for heard in words]
        self.spans += [heard.span for heard in words]

    def add_energies(self, energies: Mapping[str, float]) -> None:
        """Note energies of microphones."""
        self.microphones += energies
        self.energies += energies.values()

    def fill(self, result: Any) -> None:
        """Put everything into a result message."""
        result.words, result.confidences = self.words, self.confidences
        result.onsets, result.ends = times_of(self.spans)
        result.sounds, result.files = self.sounds, self.files
        result.microphones, result.energies = self.microphones, self.energies


def times_of(spans: Sequence[Span]) -> tuple[list[Time], list[Time]]:
    """Onsets and ends as a message has them."""
    return [Time.from_sec(span.onset) for span in spans], [Time.from_sec(span.end) for span in spans]


def sound_message(when: float, prefix: str, confidence: float, sound: LocatedSound | None = None) -> HeardSound:
    """A sound as a message.

    Args:
        when: ROS time, s.
        prefix: That of the robot's frames, with its slash; may be empty.
        confidence: 0..1.
        sound: Where it came from, if that is known.
    """
    header = Header(stamp=Time.from_sec(when), frame_id=prefix + HEAD)
    message = HeardSound(header=header, confidence=confidence, base_frame=prefix + BASE)
    if sound is not None:
        message.located = True
        message.azimuth, message.elevation = sound.in_head.azimuth, sound.in_head.elevation
        message.base_azimuth, message.base_elevation = sound.in_base.azimuth, sound.in_base.elevation
        message.energy = sound.energy
        message.head = Point(*sound.head)
    return message
