"""How different two rows of phones sound. Arithmetic only."""

from __future__ import annotations

from typing import Sequence

VOWELS = frozenset("AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split())
# Consonants that are easily taken for each other: alike but for the voice, or nearly made at the same place.
ALIKE = frozenset(
    frozenset(pair.split())
    for pair in ("P B", "T D", "K G", "F V", "S Z", "TH DH", "SH ZH", "CH JH", "M N", "N NG", "F TH", "V DH")
)
VOWEL_COST, ALIKE_COST, COST = 0.6, 0.5, 1.0


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
