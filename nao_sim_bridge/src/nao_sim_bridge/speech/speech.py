"""What an engine is asked for, and what it makes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.errors import SimulationError


class SpeechError(SimulationError):
    """Something cannot be said; the text says why."""


@dataclass(frozen=True)
class Utterance:
    """A piece of text that is spoken in one go.

    Attributes:
        voice: The engine's name of the voice.
        text: What is said; no tags.
        speed: 1 is as fast as the voice speaks by itself.
    """

    engine: str
    voice: str
    text: str
    speed: float = 1.0


@dataclass(frozen=True)
class Word:
    """One word of a text that is spoken.

    Attributes:
        first: Place of its first character in the text.
        length: Characters.
        start: s from the beginning of the sound.
        end: s from the beginning of the sound.
    """

    first: int
    length: int
    start: float
    end: float


@dataclass(frozen=True, eq=False)
class Speech:
    """An utterance as sound.

    Attributes:
        samples: (frames,) float32 in -1..1, one channel, read-only.
        rate: Samples a second.
        words: In the order in which they are spoken.
    """

    samples: np.ndarray
    rate: int
    words: Tuple[Word, ...]

    @property
    def duration(self) -> float:
        """How long it sounds, s."""
        return len(self.samples) / self.rate


class Engine(Protocol):
    """Turns text into sound."""

    def synthesise(self, utterance: Utterance) -> Speech:
        """Make the sound; blocks until it is there.

        Raises:
            SpeechError: The engine or the voice is missing, or it cannot say this.
        """

    def missing(self, engine: str, voice: str) -> str | None:
        """Why a voice cannot speak, None when it can."""

    def close(self) -> None:
        """Free what it holds."""


def silence(seconds: float, rate: int) -> np.ndarray:
    """(frames,) samples of nothing."""
    return np.zeros(max(round(seconds * rate), 0), dtype=np.float32)


def listed(names: Sequence[str]) -> str:
    """Names as an error text lists them."""
    return ", ".join(names) if names else "none"
