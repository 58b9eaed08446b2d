"""How much speaks for a phrase: how it fits the sound beside what else may have been said. Arithmetic only."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

from nao_sim_bridge.hearing.everyday_speech import Piece, score_within, words_within
from nao_sim_bridge.hearing.phone_distance import distance
from nao_sim_bridge.hearing.settings import ConfidenceSettings

# Bounds of the figures: beyond, they say nothing more.
MOST_EVERYDAY, LEAST_SOUNDS, LONGEST = 2.0, -5.0, 9
MOST_DIFFERENCE_WHOLE, MOST_DIFFERENCE_INSIDE = 2.0, 1.0


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
    return Evidence(
        difference=min(distance(phones, [phone for word in words for phone in word.phones]) / len(phones), most),
        everyday=_bounded((score - score_within(everyday, start, end)) / frames, -MOST_EVERYDAY, MOST_EVERYDAY),
        sounds=max((score - score_within(sounds, start, end)) / frames, LEAST_SOUNDS),
        same=[word.word for word in words] == list(spoken),
        length=min(len(phones), LONGEST) / LONGEST,
    )


def _bounded(value: float, least: float, most: float) -> float:
    return min(max(value, least), most)
