"""How words are pronounced: what is spoken instead of what is written."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Tuple


@dataclass(frozen=True)
class Pronunciations:
    """Replacements of whole words, whatever their capitals.

    Attributes:
        entries: (word as written, word as spoken), no word twice.
    """

    entries: Tuple[Tuple[str, str], ...] = ()

    def with_entry(self, word: str, spoken: str) -> Pronunciations:
        """These and one more, which replaces an older one of the same word."""
        return Pronunciations((*self.without(word).entries, (word, spoken)))

    def without(self, word: str) -> Pronunciations:
        return Pronunciations(tuple(entry for entry in self.entries if entry[0].lower() != word.lower()))

    def knows(self, word: str) -> bool:
        return any(entry[0].lower() == word.lower() for entry in self.entries)

    def spoken(self, text: str) -> tuple[str, list[tuple[int, int]]]:
        """The text as it is spoken, and for each of its characters the part of `text` that it comes from.

        Parts are given by their first character and the one behind the last.
        """
        unchanged = [(place, place + 1) for place in range(len(text))]
        if not self.entries:
            return text, unchanged
        by_word = {word.lower(): spoken for word, spoken in self.entries}
        longest_first = sorted(by_word, key=len, reverse=True)
        pattern = re.compile(rf"(?<!\w)(?:{'|'.join(map(re.escape, longest_first))})(?!\w)", re.IGNORECASE)
        result: list[str] = []
        origins: list[tuple[int, int]] = []
        place = 0
        for found in pattern.finditer(text):
            spoken = by_word[found.group().lower()]
            result += [text[place : found.start()], spoken]
            origins += unchanged[place : found.start()] + [found.span()] * len(spoken)
            place = found.end()
        return "".join([*result, text[place:]]), origins + unchanged[place:]
