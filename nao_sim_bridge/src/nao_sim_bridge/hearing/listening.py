"""What goes over the pipe to the recogniser's process and back, beside blocks of sound. Plain values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

from nao_sim_bridge.hearing.grammars.grammar import Grammar


@dataclass(frozen=True)
class Hypothesis:
    """A phrase of a grammar that may have been said, with a confidence of 0..1; onset and end of its sound in s."""

    phrase: str
    confidence: float
    grammar: str
    onset: float
    end: float


@dataclass(frozen=True)
class Recognised:
    """What may have been said in an utterance, best first, none when it was nothing listened for; times in s."""

    start: float
    end: float
    hypotheses: Tuple[Hypothesis, ...]


@dataclass(frozen=True)
class Listening:
    """What to listen for, how many of the best hypotheses to tell, and a sensitivity, 0..1, for quieter speech."""

    grammars: Tuple[Grammar, ...] = ()
    hypotheses: int = 1
    sensitivity: float = 0.5
