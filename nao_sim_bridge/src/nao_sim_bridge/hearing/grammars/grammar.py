"""What to listen for, as a tree: words, and how they may follow each other. Plain values that go over a pipe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, Tuple, Union

from nao_sim_bridge.hearing.grammars.phrases import spoken_words

# How a stretch of any other speech is written in what was heard.
OTHER_SPEECH = "<...>"


@dataclass(frozen=True)
class Words:
    """Words that are said one after the other.

    Attributes:
        spoken: The words, at least one.
        heard: What stands for them in the result.
    """

    spoken: Tuple[str, ...]
    heard: str


@dataclass(frozen=True)
class Anything:
    """Any other speech, or none; whether it is written in the result when there was some."""

    written: bool = True


@dataclass(frozen=True)
class Sequence:
    """Parts that follow each other; none for nothing at all."""

    parts: Tuple[Node, ...]


@dataclass(frozen=True)
class Choice:
    """One of several parts; no part at all can never be said."""

    parts: Tuple[Node, ...]


@dataclass(frozen=True)
class Repeat:
    """A part, several times.

    Attributes:
        least: How often at least.
        most: How often at most; None for any number of times.
    """

    part: Node
    least: int
    most: int | None


Node = Union[Words, Anything, Sequence, Choice, Repeat]


@dataclass(frozen=True)
class Grammar:
    name: str
    root: Node


def words(text: str) -> Words:
    """Words of a phrase as it is written; they are heard as written."""
    return Words(tuple(spoken_words(text)), text)


def vocabulary(name: str, phrases: Iterable[str], word_spotting: bool = False) -> Grammar:
    """A grammar of whole phrases.

    Args:
        phrases: As a client writes them; each is heard as written.
        word_spotting: Find them inside of longer speech too; then "<...> phrase <...>" is heard. Words of two or three
            sounds ("no", "two") are often missed there, so that they are not found in all that sounds like them.

    Raises:
        BadValue: A phrase has no word.
    """
    entries = [words(phrase) for phrase in dict.fromkeys(phrases)]
    if not word_spotting:
        return Grammar(name, Choice(tuple(entries)))
    # Written as the robot does it: with other speech around, whether there was some or not.
    spotted = [Words(e.spoken, f"{OTHER_SPEECH} {e.heard} {OTHER_SPEECH}") for e in entries]
    return Grammar(name, Sequence((Anything(written=False), Choice(tuple(spotted)), Anything(written=False))))
