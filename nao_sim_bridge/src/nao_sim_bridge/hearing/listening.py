"""What goes over the pipe to the recogniser's process and back, beside blocks of sound. Plain values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

from nao_sim_bridge.hearing.grammars.grammar import Grammar


@dataclass(frozen=True)
class Hypothesis:
    """One phrase that may have been said.

    Attributes:
        phrase: As the grammar writes it.
        confidence: 0..1.
        grammar: Name of the grammar that it belongs to.
        onset: Time of its first sound, s.
        end: Time of its last sound, s.
    """

    phrase: str
    confidence: float
    grammar: str
    onset: float
    end: float


@dataclass(frozen=True)
class Recognised:
    """What was made of an utterance.

    Attributes:
        start: Time at which it began, s.
        end: Time at which it ended, s.
        hypotheses: What may have been said, best first; none when it was nothing that is listened for.
    """

    start: float
    end: float
    hypotheses: Tuple[Hypothesis, ...]


@dataclass(frozen=True)
class Listening:
    """What to listen for, and how.

    Attributes:
        grammars: Sets of phrases.
        hypotheses: How many of the best ones to tell.
        sensitivity: 0..1; the higher, the quieter speech may be.
    """

    grammars: Tuple[Grammar, ...] = ()
    hypotheses: int = 1
    sensitivity: float = 0.5
