"""How much speaks for a phrase: how it fits the sound beside what else may have been said. Arithmetic only."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterable, Sequence, Tuple

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
class Piece:
    """A word, or silence between words, as a decoder found it from its first to its last frame.

    The word is without the number of its pronunciation; the phones are how it was said, none for silence; the score
    says how well it fits the sound, as logarithm of a likelihood.
    """

    word: str
    phones: Tuple[str, ...]
    start: int
    end: int
    score: float

    @property
    def frames(self) -> int:
        return self.end - self.start + 1

    def frames_within(self, start: int, end: int) -> int:
        """How many of its frames lie between two frames, both included."""
        return max(min(end, self.end) - max(start, self.start) + 1, 0)


@dataclass(frozen=True)
class Evidence:
    """What speaks for a phrase and against it, beside the everyday words in its place.

    The difference is how differently it sounds from them, for each of its phones, 0..2; `everyday` is how much better
    than them it fits the sound, a frame, -2..2; `sounds` is the same beside any sequence of sounds, hardly above 0, at
    least -5; `same` says whether they are its own words. The length is 1 for nine phones and more.
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
    """Weigh a phrase, its words and the silence between them, beside its utterance in everyday words and single sounds.

    `spoken` are its words as they are written. Unless other speech may be around it (`inside`), all words of the
    utterance should be its own.
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


def score_within(found: Iterable[Piece], start: int, end: int) -> float:
    """Score of what was found between two frames (both included), each piece counted for its part in between."""
    return sum(piece.score * piece.frames_within(start, end) / piece.frames for piece in found)


def words_within(found: Sequence[Piece], start: int, end: int) -> list[Piece]:
    """The words that lie between two frames for the most part, and those that fill most of what is between."""
    most = end - start + 1
    return [p for p in found if p.phones and 2 * p.frames_within(start, end) >= min(p.frames, most)]
