"""How much speaks for a phrase: how it fits the sound beside what else may have been said. Arithmetic only."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

from nao_sim_bridge.hearing.everyday_speech import Piece, score_within, words_within
from nao_sim_bridge.hearing.settings import ConfidenceSettings

# Bounds of the figures: beyond, they say nothing more.
MOST_EVERYDAY, LEAST_SOUNDS, LONGEST = 2.0, -5.0, 9
MOST_DIFFERENCE_WHOLE, MOST_DIFFERENCE_INSIDE = 2.0, 1.0
VOWELS = frozenset("AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split())
# Consonants that are easily taken for each other: alike but for the voice, or nearly made at the same place.
ALIKE = frozenset(
    frozenset(pair.split())
    for pair in ("P B", "T D", "K G", "F V", "S Z", "TH DH", "SH ZH", "CH JH", "M N", "N NG", "F TH", "V DH")
)
VOWEL_COST, ALIKE_COST, COST = 0.6, 0.5, 1.0


@dataclass(frozen=True)
class Evidence:
    """What speaks for a phrase and against it.

    Attributes:
        difference: How different it sounds from the everyday words in its place, for each of its phones, 0..2.
        everyday: How much better than those words it fits the sound, a frame, -2..2.
        sounds: How much better than any sequence of sounds it fits, a frame; hardly above 0, at least -5.
        same: Whether those words are its own.
        length: 0..1, number of its phones; 1 for nine and more.
    """

    difference: float
    everyday: float
    sounds: float
    same: bool
    length: float

    def confidence(self, settings: ConfidenceSettings) -> float:
        """0..1."""
        s = settings
        total = (
            s.bias
            - s.difference * self.difference
            + s.everyday * self.everyday
            + s.sounds * self.sounds
            + s.same * self.same
            + s.length * self.length
        )
        return 1.0 / (1.0 + math.exp(-total))


def evidence(
    phrase: Sequence[Piece],
    spoken: Sequence[str],
    everyday: Sequence[Piece],
    sounds: Sequence[Piece],
    inside: bool = False,
) -> Evidence:
    """Weigh a phrase.

    Args:
        phrase: Its words and the silence between them.
        spoken: Its words as they are written.
        everyday: The utterance in everyday words.
        sounds: The utterance in single sounds.
        inside: Whether there may be other speech around the phrase; else all words of the utterance should be its own.
    """
    start, end = phrase[0].start, phrase[-1].end
    frames = end - start + 1
    phones = [phone for piece in phrase for phone in piece.phones]
    words = words_within(everyday, start, end) if inside else [piece for piece in everyday if piece.phones]
    most = MOST_DIFFERENCE_INSIDE if inside else MOST_DIFFERENCE_WHOLE
    score = score_within(phrase, start, end)
    better = (score - score_within(everyday, start, end)) / frames
    return Evidence(
        difference=min(distance(phones, [phone for word in words for phone in word.phones]) / len(phones), most),
        everyday=min(max(better, -MOST_EVERYDAY), MOST_EVERYDAY),
        sounds=max((score - score_within(sounds, start, end)) / frames, LEAST_SOUNDS),
        same=[word.word for word in words] == list(spoken),
        length=min(len(phones), LONGEST) / LONGEST,
    )


def difference(phone: str, other: str) -> float:
    """How different two phones sound, 0..1."""
    if phone == other:
        return 0.0
    if phone in VOWELS and other in VOWELS:
        return VOWEL_COST
    return ALIKE_COST if frozenset((phone, other)) in ALIKE else COST


def distance(phones: Sequence[str], others: Sequence[str]) -> float:
    """Least sum of differences, and of phones left out or put in (1 each), that makes one row the other.

    >>> distance(["R", "EH", "D"], ["B", "R", "EH", "D"])
    1.0
    """
    row = [float(count) for count in range(len(others) + 1)]
    for phone in phones:
        following = [row[0] + COST]
        for index, other in enumerate(others):
            changed = row[index] + difference(phone, other)
            following.append(min(changed, row[index + 1] + COST, following[-1] + COST))
        row = following
    return row[-1]
