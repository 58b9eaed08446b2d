"""What the hearing functions share: events of hearing, what a chain has heard, what goals leave going."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import InitVar, asdict, dataclass, field
from typing import Any, NamedTuple, Tuple

from genpy import Time

from nao_library_msgs.msg import HeardSound, RecordedFile

from ..core.chain import Part
from ..core.files import Kept
from ..core.robot_events import ExtractorUse, subscriber_name
from ..nao_basic import NaoBasic

Vector = Tuple[float, float, float]


@dataclass(frozen=True)
class Bearing:
    azimuth: float  # rad, positive to the left
    elevation: float  # rad, positive upwards

    @property
    def vector(self) -> Vector:
        """Unit vector: X ahead, Y to the left, Z up."""
        flat = math.cos(self.elevation)
        return flat * math.cos(self.azimuth), flat * math.sin(self.azimuth), math.sin(self.elevation)

    @classmethod
    def of(cls, vector: Vector) -> Bearing:
        """The direction of a vector of any length."""
        x, y, z = vector
        return cls(math.atan2(y, x), math.atan2(z, math.hypot(x, y)))


@dataclass(frozen=True)
class BegunSound:
    confidence: float  # 0..1
    time: float  # when it began, s of the robot; 0 if the robot does not report that


@dataclass(frozen=True)
class LocatedSound:
    in_head: Bearing  # in the frame of the head
    in_base: Bearing  # in NAOqi's FRAME_ROBOT
    head: Vector  # where the head was in FRAME_ROBOT, m
    confidence: float  # 0..1
    energy: float  # loudness as the robot reports it; 0 if it does not
    time: float  # when it was located, s of the robot


def turned(vector: Vector, angles: Sequence[float]) -> Vector:
    """A vector of a turned frame, in the frame that it is turned in.

    `vector`: in the turned frame. `angles`: (3,) rad about X, Y, Z, as in NAOqi's Position6D: Z is turned about last.
    """
    x, y, z = vector
    wx, wy, wz = angles
    y, z = y * math.cos(wx) - z * math.sin(wx), y * math.sin(wx) + z * math.cos(wx)
    x, z = x * math.cos(wy) + z * math.sin(wy), z * math.cos(wy) - x * math.sin(wy)
    return x * math.cos(wz) - y * math.sin(wz), x * math.sin(wz) + y * math.cos(wz), z


def located_sound(value: Any) -> LocatedSound:
    """A sound from the value of ALSoundLocalization/SoundLocated.

    `value`: [[s, us], [azimuth, elevation, confidence, energy], head in the torso, head in FRAME_ROBOT], the last two
    Position6D in m and rad. Raises ValueError if the value is something else.
    """
    try:
        (seconds, microseconds), (azimuth, elevation, confidence, *energy), _, head = value
        in_head = Bearing(float(azimuth), float(elevation))
        x, y, z, *angles = map(float, head)
        in_base = Bearing.of(turned(in_head.vector, angles))
        loudness, time = float(energy[0]) if energy else 0.0, float(seconds) + 1e-6 * float(microseconds)
        return LocatedSound(in_head, in_base, (x, y, z), float(confidence), loudness, time)
    except (TypeError, ValueError) as error:
        raise ValueError(f"no sound that was located: {value!r}") from error


def begun_sounds(value: Any) -> list[BegunSound]:
    """The sounds that begin in a value of SoundDetected.

    `value`: [[index, type, confidence, time in us], ...], type 1 for the begin of a sound, 0 for its end; a single one
    may stand alone. Raises ValueError if the value is something else.
    """
    try:
        rows = [value] if value and not isinstance(value[0], (list, tuple)) else value
        begun = [(float(confidence), time) for _, kind, confidence, *time in rows if int(kind) == 1]
        return [BegunSound(confidence, 1e-6 * float(time[0]) if time else 0.0) for confidence, time in begun]
    except (TypeError, ValueError) as error:
        raise ValueError(f"no sounds that were detected: {value!r}") from error


def recognised(value: Any) -> list[tuple[str, float]]:
    """Phrases and confidences (0..1) in a value of WordRecognized, the best first.

    Word spotting wraps phrases in marks, which are taken off. A value that was reset has none. Raises ValueError if the
    value is something else. `value`: [phrase, confidence, phrase, confidence, ...].
    """
    try:
        value = list(value or [])
        if len(value) % 2:
            raise ValueError("a phrase has no confidence")
        pairs = zip(value[::2], map(float, value[1::2]))
        return [(words, confidence) for phrase, confidence in pairs for words in [_bare(phrase)] if words]
    except (TypeError, ValueError) as error:
        raise ValueError(f"no words that were recognised: {value!r}") from error


def _bare(phrase: Any) -> str:
    if not isinstance(phrase, str):
        raise ValueError(f"{phrase!r} is no phrase")
    return phrase.replace("<...>", " ").strip()


def tells_later(**facts: Any) -> Callable[..., None]:
    """A check that refuses nothing: it leaves word in the context for later functions of the chain."""
    return lambda _self, context: context.update(facts)


class Span(NamedTuple):
    """ROS times, s, of the first and the last sound of what was heard; 0: not known, or it has not ended."""

    onset: float = 0.0
    end: float = 0.0


class HeardWord(NamedTuple):
    """A word or phrase that was recognised, as the vocabulary has it."""

    word: str
    confidence: float  # 0..1
    span: Span


@dataclass
class Heard:
    """What the functions of one chain heard, for its result."""

    words: list[HeardWord] = field(default_factory=list)
    sounds: list[HeardSound] = field(default_factory=list)
    files: list[RecordedFile] = field(default_factory=list)
    microphones: list[str] = field(default_factory=list)
    energies: list[float] = field(default_factory=list)

    def fill(self, result: Any) -> None:
        """Put everything into a result message."""
        for name, value in _fields_of(self.words).items():
            setattr(result, name, value)
        result.sounds, result.files = self.sounds, self.files
        result.microphones, result.energies = self.microphones, self.energies


def _fields_of(words: Sequence[HeardWord]) -> dict[str, list[Any]]:
    """Words as result and feedback have them."""
    return {
        "words": [heard.word for heard in words],
        "confidences": [heard.confidence for heard in words],
        "onsets": [Time.from_sec(heard.span.onset) for heard in words],
        "ends": [Time.from_sec(heard.span.end) for heard in words],
    }


class Hearing(ExtractorUse):
    """What the chain has heard, feedback, and how functions use NAOqi's extractors.

    `heard`: what the chain heard so far; new for each goal.
    """

    def __init__(self, module: NaoBasic, namespace: str) -> None:
        super().__init__(module, subscriber_name("nao_audio_in", namespace))
        self.heard = Heard()
        self._publish_feedback = module.publish_feedback

    def publish(self, status: str, words: Sequence[HeardWord] = (), stamp: float | None = None) -> None:
        """Publish what is heard meanwhile. Called from the thread that executes goals.

        Args:
            status: What the robot is doing.
            words: What was heard last.
            stamp: ROS time at which it was so, s; None: now.
        """
        self._publish_feedback(stamp=stamp, status=status, **_fields_of(words))


@dataclass(frozen=True)
class Recording:
    """A recording that runs."""

    path: str
    file_type: str
    rate: int  # Hz
    channels: Sequence[str]  # microphones
    began: float  # ROS time, s


@dataclass
class Recognition:
    """A recognition that a goal left running."""

    vocabulary: list[str]  # words and phrases; empty for those that were set before
    word_spotting: bool  # whether they are also found within longer sentences
    kept: bool  # whether the robot keeps what was set before, to be put back
    publishes: bool  # whether it publishes events that were not published before


@dataclass
class LeftGoing(Part):
    """What goals leave going beyond their end, also for the next server when this one dies."""

    kept: InitVar[Kept]
    recording: Recording | None = None  # also that of a goal that is not over
    recognition: Recognition | None = None
    paused: bool = False  # the recognition, by this server
    vocabulary_is_set: bool = False  # by setVocabulary, so that functions need no words of their own
    computing: bool = False  # energies, since enableEnergyComputation

    left_by_goals = frozenset({"recording", "paused", "vocabulary_is_set"})

    def __post_init__(self, kept: Kept) -> None:
        self._kept = kept

    def keep(self) -> None:
        """Save it beyond the death of the node."""
        self._kept.save(asdict(self))
