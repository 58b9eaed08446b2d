r"""Text with tags, as \rspd=80\ , read into pieces: what is spoken and how, pauses, and marks on the way.

Source: names and ranges of the tags from NAOqi's documentation of ALTextToSpeech. Tags that no engine here can follow
are taken out of the text, so that nobody hears them.
"""

from __future__ import annotations

import logging
import math
import re
from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator, List, Mapping, Optional, Union

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.speech.parameters import Prosody, limited

log = logging.getLogger("nao_sim.speech")

# A tag is closed by a backslash; one with a value whose closing is forgotten ends with the value. Of blanks
# there are few: a search through many would take the square of their number.
TAG = re.compile(
    r"""\\(?P<name>[A-Za-z]+)(?:=\s{0,20}(?P<value>"[^"\\]*"|[^\\\s]*)(?:\s{1,20}(?!\\[A-Za-z]+[=\\]))?)?\\"""
    r"""|\\(?P<open>[A-Za-z]+)=(?P<rest>[^\\\s]+)(?=\s|$)"""
)
PLAIN = Prosody()
MOST_TOLD = 100
"""Tags that are left out and of which that is said."""
LONGEST_PAUSE = 65.535
LAST_BOOKMARK = 65535
# Unit of \wait=N\ , s.
WAIT_UNIT = 0.2
STRONG_BOUNDARY, WEAK_BOUNDARY = 0.3, 0.1
# What a style makes of the voice: factors of speed and pitch.
STYLES = {"neutral": (1.0, 1.0), "joyful": (1.05, 1.12), "didactic": (0.88, 1.0)}
# What marks a sentence's end or forbids it, see `sentences`; no text of a user holds these.
BREAK, NO_BREAK = "\ue000", "\ue001"


@dataclass(frozen=True)
class Spoken:
    text: str
    prosody: Prosody


@dataclass(frozen=True)
class Pause:
    """Silence, in s."""

    seconds: float


@dataclass(frozen=True)
class Bookmark:
    r"""The place of a \mrk=N\ ."""

    number: int


@dataclass(frozen=True, eq=False)
class Cue:
    """A place in the text where something else happens; `action` is called as the voice passes it."""

    action: Callable[[], Any]


@dataclass(frozen=True, eq=False)
class Gate:
    """A place where the voice waits: `action` is called there, and it goes on when the task it returns has ended."""

    action: Callable[[], Optional[Task]]


Piece = Union[Spoken, Pause, Bookmark, Cue, Gate]


class TagReader:
    """Reads texts; says once of each tag that it is left out."""

    def __init__(self, warn: Callable[[str], None] = log.warning) -> None:
        self._warn = warn
        self._told: set[str] = set()

    def read(self, text: str, prosody: Prosody = PLAIN) -> list[Piece]:
        """Pieces of a text in their order; `prosody` is for where no tag says otherwise."""
        return list(_Reading(self, prosody).pieces(text))

    def limit(self, tag: str, limit: float) -> None:
        """Say, once for each of the first tags, that its value is beyond what a voice can."""
        if tag not in self._told and len(self._told) < MOST_TOLD:
            self._told.add(tag)
            self._warn(f"tag \\{tag}\\ is taken for {limit:g}, its limit")

    def leave_out(self, tag: str, why: str) -> None:
        """Say, once for each of the first tags, that it does nothing."""
        if tag not in self._told and len(self._told) < MOST_TOLD:
            self._told.add(tag)
            self._warn(f"tag \\{tag}\\ is left out of what is said: {why}")


class _Reading:
    """The state of the voice while one text is read."""

    def __init__(self, reader: TagReader, prosody: Prosody) -> None:
        self._reader = reader
        self._start = prosody
        self._style = "neutral"
        self._changes: dict[str, float] = {}
        self._spelling = False
        self._phonetic = False

    def pieces(self, text: str) -> Iterator[Piece]:
        place = 0
        for tag in TAG.finditer(text):
            yield from self._speak(text[place : tag.start()])
            place = tag.end()
            name, value = (tag["name"] or tag["open"]).lower(), tag["value"] or tag["rest"]
            act = ACTIONS.get(name)
            if act is None:
                self._reader.leave_out(name, "the engines here cannot follow it")
                continue
            try:
                yield from act(self, value) or ()
            except ValueError:
                self._reader.leave_out(f"{name}={value}", "no such value")
        yield from self._speak(text[place:])

    def _speak(self, text: str) -> Iterator[Piece]:
        text = text.replace("\\", " ")
        if self._phonetic or not text:
            return
        if self._spelling:
            text = " " + ", ".join(letter for letter in text if letter.isalnum()) + " "
        yield Spoken(text, self._prosody())

    def _prosody(self) -> Prosody:
        speed, pitch = STYLES[self._style]
        return limited(
            Prosody(
                self._start.speed * speed * self._changes.get("rspd", 1.0),
                self._start.pitch * pitch * self._changes.get("vct", 1.0),
                self._changes.get("vol", self._start.gain),
            )
        )

    def _limited(self, tag: str, value: str | None, low: float, high: float) -> float:
        """The value of a tag, brought to its limit as on a robot; a ValueError for what is no number."""
        number = _within(value, -math.inf)
        within = min(max(number, low), high)
        if within != number:
            self._reader.limit(f"{tag}={value}", within)
        return within

    # --- tags -----------------------------------------------------------------------------------------------------

    def speed(self, value: str | None) -> None:
        self._changes["rspd"] = self._limited("rspd", value, 50.0, 400.0) / 100.0

    def pitch(self, value: str | None) -> None:
        self._changes["vct"] = self._limited("vct", value, 50.0, 200.0) / 100.0

    def volume(self, value: str | None) -> None:
        self._changes["vol"] = self._limited("vol", value, 0.0, 100.0) / 80.0

    def pause(self, value: str | None) -> list[Piece]:
        return [Pause(min(_within(value, 0.0) / 1000.0, LONGEST_PAUSE))]

    def wait(self, value: str | None) -> list[Piece]:
        return [Pause(self._limited("wait", value, 0.0, 20.0) * WAIT_UNIT)]

    def bookmark(self, value: str | None) -> list[Piece]:
        return [Bookmark(int(_within(value, 0, LAST_BOOKMARK)))]

    def reset(self, _: str | None) -> None:
        self._changes.clear()
        self._style, self._spelling, self._phonetic = "neutral", False, False

    def style(self, value: str | None) -> None:
        self._style = _one_of(value, STYLES)

    def boundary(self, value: str | None) -> list[Piece]:
        length = {"S": STRONG_BOUNDARY, "W": WEAK_BOUNDARY, "N": 0.0}[_one_of(value, ("S", "W", "N"))]
        return [Pause(length)] if length else []

    def sentence_break(self, value: str | None) -> list[Piece]:
        mark = BREAK if _one_of(value, ("0", "1")) == "1" else NO_BREAK
        return [Spoken(mark, self._prosody())]

    def normalisation(self, value: str | None) -> None:
        kind = _one_of(value, ("spell", "normal", "address", "sms"))
        self._spelling = kind == "spell"
        if kind in ("address", "sms"):
            self._reader.leave_out(f"tn={kind}", "the engines read every text as they read any")

    def read_mode(self, value: str | None) -> None:
        kind = _one_of(value, ("sent", "char", "word"))
        self._spelling = kind == "char"
        if kind == "word":
            self._reader.leave_out("readmode=word", "the engines read sentences")

    def text_kind(self, value: str | None) -> None:
        self._phonetic = _one_of(value, ("orth", "lhp", "pinyin", "hcm")) != "orth"
        if self._phonetic:
            self._reader.leave_out(f"toi={value}", "no engine here reads phonetic text; it is not spoken")


Act = Callable[[_Reading, Optional[str]], Optional[List[Piece]]]
ACTIONS: Mapping[str, Act] = {
    "rspd": _Reading.speed,
    "vct": _Reading.pitch,
    "vol": _Reading.volume,
    "pau": _Reading.pause,
    "wait": _Reading.wait,
    "mrk": _Reading.bookmark,
    "rst": _Reading.reset,
    "style": _Reading.style,
    "bound": _Reading.boundary,
    "eos": _Reading.sentence_break,
    "tn": _Reading.normalisation,
    "readmode": _Reading.read_mode,
    "toi": _Reading.text_kind,
}


def joined(pieces: list[Piece]) -> list[Piece]:
    """Pieces with neighbouring texts of one prosody made one."""
    result: list[Piece] = []
    for piece in pieces:
        last = result[-1] if result else None
        if isinstance(piece, Spoken) and isinstance(last, Spoken) and piece.prosody == last.prosody:
            result[-1] = replace(last, text=last.text + piece.text)
        else:
            result.append(piece)
    return result


def _within(value: str | None, low: float, high: float = float("inf")) -> float:
    number = float(value or "")
    if not low <= number <= high:
        raise ValueError(value)
    return number


def _one_of(value: str | None, allowed: Any) -> str:
    if value not in allowed:
        raise ValueError(value)
    return value
