"""What to listen for, as a tree: words, and how they may follow each other. Plain values that go over a pipe.

Phrases are cut into the words that a person says, numbers as a person reads them.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import Iterable, Tuple, Union

from nao_sim_bridge.base.errors import BadValue

# How a stretch of any other speech is written in what was heard.
OTHER_SPEECH = "<...>"
SIGNS = {"&": " and ", "+": " plus ", "=": " equals ", "@": " at "}
QUOTES = str.maketrans({"’": "'", "‘": "'", "`": "'", "´": "'"})
# A token: a number with what belongs to it, letters with dots between ("U.S."), or a word with apostrophes.
TOKEN = re.compile(r"\d+(?:\.\d+)?(?:st|nd|rd|th)?%?|(?:[^\W\d_]\.){2,}|[^\W\d_]+(?:'[^\W\d_]+)*'?", re.IGNORECASE)
THOUSANDS = re.compile(r"(?<=\d),(?=\d{3}(?:\D|$))")
ONES = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen "
    "eighteen nineteen"
).split()
TENS = "twenty thirty forty fifty sixty seventy eighty ninety".split()
SCALES = ((10**9, "billion"), (10**6, "million"), (1000, "thousand"), (100, "hundred"))
ORDINALS = {
    "one": "first",
    "two": "second",
    "three": "third",
    "five": "fifth",
    "eight": "eighth",
    "nine": "ninth",
    "twelve": "twelfth",
}
# Longer ones are said digit by digit, as a telephone number.
MOST_DIGITS = 12
NUMBER = re.compile(r"(\d+)(?:\.(\d+))?(st|nd|rd|th|%)?$", re.IGNORECASE)


@dataclass(frozen=True)
class Words:
    """Words, at least one, that are said one after the other; `heard` stands for them in the result."""

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
    """A part, `least` to `most` times, None for any number of times."""

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
    """A grammar of whole phrases, each heard as a client writes it.

    With word spotting they are found inside of longer speech too; then "<...> phrase <...>" is heard. Words of two or
    three sounds ("no", "two") are often missed there, so that they are not found in all that sounds like them.

    Raises:
        BadValue: A phrase has no word.
    """
    entries = [words(phrase) for phrase in dict.fromkeys(phrases)]
    if not word_spotting:
        return Grammar(name, Choice(tuple(entries)))
    # Written as the robot does it: with other speech around, whether there was some or not.
    spotted = [Words(e.spoken, f"{OTHER_SPEECH} {e.heard} {OTHER_SPEECH}") for e in entries]
    return Grammar(name, Sequence((Anything(written=False), Choice(tuple(spotted)), Anything(written=False))))


def spoken_words(phrase: str) -> list[str]:
    """The words of a phrase in lower case: without punctuation, numbers written out.

    Raises:
        BadValue: The phrase has no word.
    """
    text = unicodedata.normalize("NFC", phrase).translate(QUOTES)
    for sign, word in SIGNS.items():
        text = text.replace(sign, word)
    words: list[str] = []
    for token in TOKEN.findall(THOUSANDS.sub("", text)):
        if token[0].isdigit():
            words += number_words(token) or []
        elif "." in token:
            words += [letter.lower() for letter in token if letter.isalpha()]
        else:
            words.append(token.lower())
    if not words:
        raise BadValue("phrase", phrase, "at least one word or number")
    return words


def number_words(text: str) -> list[str] | None:
    """Words of a number ("21", "3.5", "2nd", "50%"); None for what is none."""
    match = NUMBER.match(text)
    if match is None:
        return None
    whole, fraction, ending = match.groups()
    if len(whole) > MOST_DIGITS or (len(whole) > 1 and whole.startswith("0")):
        words = [ONES[int(digit)] for digit in whole]
    else:
        words = cardinal(int(whole))
    if fraction is not None:
        words += ["point", *(ONES[int(digit)] for digit in fraction)]
    if ending == "%":
        return [*words, "percent"]
    return [*words[:-1], ordinal(words[-1])] if ending else words


def cardinal(number: int) -> list[str]:
    """Words of a number that is not negative."""
    if number < 20:
        return [ONES[number]]
    if number < 100:
        tens, ones = divmod(number, 10)
        return [TENS[tens - 2], *([ONES[ones]] if ones else [])]
    for size, name in SCALES:
        if number >= size:
            count, rest = divmod(number, size)
            return [*cardinal(count), name, *(cardinal(rest) if rest else [])]
    raise AssertionError(number)  # every number from 100 on has a scale


def ordinal(word: str) -> str:
    """The last word of a number, counting: "one" becomes "first"."""
    if word in ORDINALS:
        return ORDINALS[word]
    return word[:-1] + "ieth" if word.endswith("y") else word + "th"
