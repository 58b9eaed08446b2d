"""Which gestures go with a sentence, and when. Arithmetic only: times are passed in."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Sequence, Tuple

from nao_sim_bridge.speech.animations import POSTURE, AnimationLibrary
from nao_sim_bridge.speech.gesture import Animation

DISABLED, RANDOM, CONTEXTUAL = "disabled", "random", "contextual"
MODES = (DISABLED, RANDOM, CONTEXTUAL)
# A gesture begins so much before its word, s, and may be so much quicker or slower than it is made.
LEAD = 0.3
QUICKEST, SLOWEST = 0.72, 1.5
# Gestures of one text do not follow each other closer, s.
REST = 0.1


@dataclass
class BodyLanguage:
    """How a robot moves while it speaks: `way` is random or contextual, and counts while it is enabled."""

    way: str = CONTEXTUAL
    enabled: bool = True

    @property
    def mode(self) -> str:
        """One of `MODES`."""
        return self.way if self.enabled else DISABLED

    @mode.setter
    def mode(self, mode: str) -> None:
        self.enabled = mode != DISABLED
        if self.enabled:
            self.way = mode


@dataclass(frozen=True)
class PlannedGesture:
    """A gesture that begins `start` s after its sentence and takes `length` s."""

    start: float
    animation: Animation
    length: float

    @property
    def end(self) -> float:
        return self.start + self.length


def plan(
    duration: float,
    words: Sequence[Tuple[float, str]],
    mode: str,
    library: AnimationLibrary,
    chance: random.Random,
    posture: str = POSTURE,
    sentence: str = "",
) -> list[PlannedGesture]:
    """Gestures of a sentence, all over when it is; a sentence too short for any has the shortest one, done quickly.

    The contextual mode looks at the words, (s from the beginning, word) in their order, and at the end of the sentence,
    which says what fills the rest; `chance` chooses among those that fit equally, all made for the posture.
    """
    if mode == DISABLED:
        return []
    contextual = mode == CONTEXTUAL
    fillers = library.of_sentence(sentence if contextual else "", posture)
    planned: list[PlannedGesture] = []
    begin = 0.0
    if contextual:
        for time, word in words:
            start = max(time - LEAD, begin)
            fitting = [a for a in library.of_word(word, posture) if a.length * QUICKEST <= duration - start]
            if not fitting or start > time:  # the hands are still busy with a word before
                continue
            animation = chance.choice(fitting)
            planned += _filled(begin, start - REST, fillers, chance)
            planned.append(PlannedGesture(start, animation, min(animation.length, duration - start)))
            begin = planned[-1].end + REST
    planned += _filled(begin, duration, fillers, chance)
    if planned:
        return planned
    of_words = [a for _, word in words for a in library.of_word(word, posture)] if contextual else []
    return _quick(of_words or fillers)


def _quick(animations: Sequence[Animation]) -> list[PlannedGesture]:
    """The shortest one, at once and as quick as it may be; it may go on when the text is over."""
    if not animations:
        return []
    animation = min(animations, key=lambda a: a.length)
    return [PlannedGesture(0.0, animation, animation.length * QUICKEST)]


def _filled(begin: float, end: float, fillers: Sequence[Animation], chance: random.Random) -> list[PlannedGesture]:
    """Gestures that go with any text, one after the other, in a stretch of time."""
    planned: list[PlannedGesture] = []
    while True:
        fitting = [a for a in fillers if a.length * QUICKEST <= end - begin]
        if not fitting:
            return planned
        animation = chance.choice(fitting)
        left = end - begin
        # The last one takes what is left, so that hands do not wait for the end of the text.
        last = left - animation.length - REST < animation.length * QUICKEST
        length = min(left, animation.length * SLOWEST) if last else animation.length
        planned.append(PlannedGesture(begin, animation, length))
        begin += length + REST
