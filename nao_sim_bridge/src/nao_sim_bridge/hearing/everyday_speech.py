"""Writes down any English speech as well as it can: what phrases are measured against. In the recogniser's process."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Callable, Iterable, Sequence, Tuple

import pocketsphinx

# The decoder's scores are logarithms divided by this.
SCORE_UNIT = 1.0 / 1024.0
# Mark of a further pronunciation of a word.
FURTHER = re.compile(r"\(\d+\)$")
# How marks of silence and of noises begin, in the place of words.
NO_WORD = ("<", "[", "+")


@dataclass(frozen=True)
class Piece:
    """A word, or silence between words, as a decoder found it.

    Attributes:
        word: As the decoder names it, without the number of its pronunciation.
        phones: How it was said; empty for silence.
        start: Its first frame.
        end: Its last frame.
        score: How well it fits the sound: logarithm of a likelihood.
    """

    word: str
    phones: Tuple[str, ...]
    start: int
    end: int
    score: float

    @property
    def frames(self) -> int:
        return self.end - self.start + 1


class EverydaySpeech:
    """A decoder for the words of a large dictionary, and for how they follow each other in English."""

    def __init__(self) -> None:
        pocketsphinx.set_loglevel("FATAL")
        # One fast search is enough: the sense of what is said does not matter here.
        self._engine = pocketsphinx.Decoder(
            pocketsphinx.Config(
                lm=pocketsphinx.get_model_path("en-us/en-us.lm.bin"),
                dict=pocketsphinx.get_model_path("en-us/cmudict-en-us.dict"),
                cmn="batch",
                fwdflat=False,
                bestpath=False,
                loglevel="FATAL",
            )
        )

    def heard(self, sound: bytes) -> list[Piece]:
        """The words of an utterance of int16 samples, 16 kHz, and the silence between them."""
        engine = self._engine
        heard = search(engine, sound)
        return pieces(engine, lambda word: (engine.lookup_word(word) or "").split()) if heard else []


def search(engine: pocketsphinx.Decoder, sound: bytes) -> bool:
    """Have a decoder search an utterance of int16 samples, 16 kHz; whether it found something."""
    engine.start_utt()
    engine.process_raw(sound, False, True)
    engine.end_utt()
    return engine.hyp() is not None


def pieces(engine: pocketsphinx.Decoder, phones_of: Callable[[str], Sequence[str]]) -> list[Piece]:
    """What the last search of a decoder found.

    Args:
        engine: The decoder; its search found something.
        phones_of: Phones of a word, named with the number of its pronunciation; called for words only.
    """
    found = []
    for s in engine.seg():
        phones = () if s.word.startswith(NO_WORD) else tuple(phones_of(s.word))
        found.append(Piece(FURTHER.sub("", s.word), phones, s.start_frame, s.end_frame, log_score(s.ascore)))
    return [piece for piece in found if piece.frames > 0]


def log_score(likelihood: float) -> float:
    """Logarithm of a likelihood as the decoder tells it."""
    return math.log(max(likelihood, 1e-300)) / SCORE_UNIT


def score_within(found: Iterable[Piece], start: int, end: int) -> float:
    """Score of what was found between two frames (both included), each piece counted for its part in between."""
    total = 0.0
    for piece in found:
        common = min(end, piece.end) - max(start, piece.start) + 1
        total += piece.score * max(common, 0) / piece.frames
    return total


def words_within(found: Sequence[Piece], start: int, end: int) -> list[Piece]:
    """The words that lie between two frames for the most part, and those that fill most of what is between."""
    inside = []
    for piece in found:
        common = min(end, piece.end) - max(start, piece.start) + 1
        if piece.phones and 2 * common >= min(piece.frames, end - start + 1):
            inside.append(piece)
    return inside
