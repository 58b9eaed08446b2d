"""What the hearing functions share: what a chain has heard, what goals leave going, the use of NAOqi's extractors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import InitVar, asdict, dataclass, field
from typing import Any, NamedTuple

from genpy import Time

from nao_library_msgs.msg import HeardSound, RecordedFile

from ..base.kept import Kept
from ..functions.parts import Part
from ..server.extractor_use import ExtractorUse, subscriber_name
from ..server.nao_basic import NaoBasic


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
