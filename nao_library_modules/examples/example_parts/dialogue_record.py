"""What was said, heard and done in a dialogue, and when: kept as JSON, drawn below a sound. No ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, List, Sequence

from .record_file import load_record, save_record

FORMAT = "nao_library dialogue 1"
ROBOT, PERSON = "robot", "person"
SAYS, HEARS, DOES = "says", "hears", "does"


@dataclass(frozen=True)
class Turn:
    """Something that somebody said, heard or did.

    Attributes:
        who: ROBOT or PERSON.
        what: SAYS, HEARS or DOES.
        text: The words, or what was done.
        began: s of the robot's time, counted from the first sample of the recording or the beginning of the dialogue.
        ended: The same; not before `began`.
        confidence: 0..1, of what was heard; None for everything else.
    """

    who: str
    what: str
    text: str
    began: float
    ended: float
    confidence: float | None = None

    def __post_init__(self) -> None:
        """Check it.

        Raises:
            ValueError: It cannot have happened.
        """
        if self.who not in (ROBOT, PERSON) or self.what not in (SAYS, HEARS, DOES):
            raise ValueError(f"{self.who!r} {self.what!r}: not robot or person, who says, hears or does")
        if not (math.isfinite(self.began) and math.isfinite(self.ended) and self.began <= self.ended):
            raise ValueError(f"from {self.began} s to {self.ended} s")

    @property
    def title(self) -> str:
        """The text, with the confidence if there is one."""
        return self.text if self.confidence is None else f"{self.text} ({self.confidence:.2f})"


class Notes:
    """What happens in a dialogue, in s from now on.

    Attributes:
        turns: All of it.

    Args:
        clock: Tells the time, s.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self.turns: list[Turn] = []
        self._clock = clock
        self._began = clock()

    def now(self) -> float:
        """Time since the beginning, s."""
        return self._clock() - self._began

    def did(self, who: str, what: str, text: str, began: float) -> None:
        """Note, and tell, what has just ended and began at a time, s."""
        self._add(Turn(who, what, text, began, self.now()))

    def heard(self, text: str, when: float, confidence: float) -> None:
        """Note, and tell, what the robot heard at a time, s."""
        self._add(Turn(ROBOT, HEARS, text, when, when, confidence))

    def _add(self, turn: Turn) -> None:
        self.turns.append(turn)
        before = {SAYS: f"{turn.who}: ", HEARS: "heard: ", DOES: f"{turn.who} "}[turn.what]
        print(f"{before}{turn.title}")


def save(turns: Sequence[Turn], path: Path) -> None:
    save_record(path, FORMAT, "s", "turn", turns)


def load(path: Path) -> List[Turn]:
    """Read a record; RecordError if it is none."""
    return load_record(path, FORMAT, "turn", _turn)


def _turn(entry: Any) -> Turn:
    confidence = entry["confidence"]
    return Turn(
        entry["who"],
        entry["what"],
        str(entry["text"]),
        float(entry["began"]),
        float(entry["ended"]),
        None if confidence is None else float(confidence),
    )
