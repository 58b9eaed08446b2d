"""What was said, heard and done in a dialogue, and when: kept as JSON, drawn below a sound. No ROS."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Callable, List, Sequence

from nao_library_modules.base.whole_file import write_whole

FORMAT = "nao_library dialogue 1"
ROBOT, PERSON = "robot", "person"
SAYS, HEARS, DOES = "says", "hears", "does"


class DialogueRecordError(ValueError):
    """A file that is no record of a dialogue."""


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
    content = {"format": FORMAT, "units": "s", "turns": [asdict(turn) for turn in turns]}
    write_whole(path, json.dumps(content, indent=1) + "\n")


def load(path: Path) -> List[Turn]:
    """Read a record.

    Raises:
        DialogueRecordError: The file cannot be read or is none.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DialogueRecordError(f"{path}: cannot be read: {error}") from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise DialogueRecordError(f"{path}: is no record of a dialogue: format is not {FORMAT!r}")
    try:
        return [_turn(entry) for entry in content["turns"]]
    except (KeyError, TypeError, ValueError) as error:
        raise DialogueRecordError(f"{path}: has a turn that is wrong: {error}") from error


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
