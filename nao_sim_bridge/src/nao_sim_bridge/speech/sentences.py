"""Pieces of a text, sorted into sentences: the first one sounds while the next ones are made."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Iterable, Iterator, Sequence, Tuple, Union

from nao_sim_bridge.speech.tags import BREAK, NO_BREAK, Bookmark, Cue, Gate, Pause, Piece, Spoken, joined

# A longer one is cut at a comma or a blank, so that no sentence keeps everybody waiting.
LONGEST = 300
# The end of a sentence: signs, perhaps a quotation mark, then a blank; scripts without blanks need none. A line's end.
# It begins with the first of its signs: a row of them is looked at once, and not again from each.
END = re.compile(rf"(?<![.!?…])[.!?…]+[\"'»”’)\]]*(?=\s|$)|[。！？]+[」』”]?|\n+|{BREAK}")
# Behind these, and behind single capitals, a full stop ends nothing.
ABBREVIATIONS = frozenset(
    "dr mr mrs ms prof st vs etc e.g i.e approx no vol fig bzw z.b usw ca nr hr fr m mme mlle sr sra ing".split()
)
CUT = re.compile(r"[,;:、，]\s*|\s+")


@dataclass(frozen=True)
class Sentence:
    """What is spoken in one breath: text, pauses and marks in their order, at least one."""

    parts: Tuple[Union[Spoken, Pause, Bookmark, Cue], ...]

    @property
    def text(self) -> str:
        """The words, as they are written."""
        return " ".join("".join(part.text for part in self.parts if isinstance(part, Spoken)).split())


Item = Union[Sentence, Gate]


def sentences(pieces: Sequence[Piece]) -> list[Item]:
    """The sentences of a text, and the gates between them."""
    items: list[Item] = []
    parts: list[Piece] = []

    def close() -> None:
        if parts and (items or not _is_blank(parts) or _has_marks(parts)):
            items.append(Sentence(tuple(parts)))
        parts.clear()

    for piece in joined(list(pieces)):
        if isinstance(piece, Gate):
            close()
            items.append(piece)
        elif isinstance(piece, Spoken):
            for text, ends in _cut(piece.text):
                parts.append(replace(piece, text=text))
                if ends:
                    close()
        else:
            parts.append(piece)
    close()
    return [item for item in items if isinstance(item, Gate) or not _is_blank(item.parts) or _has_marks(item.parts)]


def _is_blank(parts: Iterable[Piece]) -> bool:
    return not any(isinstance(part, Spoken) and part.text.strip() for part in parts)


def _has_marks(parts: Iterable[Piece]) -> bool:
    return any(not isinstance(part, Spoken) for part in parts)


def _cut(text: str) -> Iterator[tuple[str, bool]]:
    """The text in portions, each with whether a sentence ends there."""
    *ended, last = text.split(NO_BREAK)
    text = ", ".join([*(part.rstrip().rstrip(".!?…") for part in ended), last])
    begin = 0
    for end in END.finditer(text):
        if end.group() == "." and _abbreviates(text[begin : end.start()]):
            continue
        yield from _no_longer(text[begin : end.end()].replace(BREAK, " "), True)
        begin = end.end()
    if text[begin:]:
        yield from _no_longer(text[begin:], False)


def _abbreviates(before: str) -> bool:
    """Whether a full stop after this text belongs to its last word."""
    words = before.rsplit(None, 1)
    last = words[-1].lstrip("(\"'«“") if words else ""
    return last.lower() in ABBREVIATIONS or (len(last) == 1 and last.isupper() and last != "I")


def _no_longer(text: str, ends: bool) -> Iterator[tuple[str, bool]]:
    while len(text) > LONGEST:
        cuts = [cut.end() for cut in CUT.finditer(text, LONGEST // 2, LONGEST)]
        commas = [cut for cut in cuts if text[:cut].rstrip()[-1:] in tuple(",;:、，")]
        place = (commas or cuts or [LONGEST])[-1]
        yield text[:place], True
        text = text[place:]
    yield text, ends
