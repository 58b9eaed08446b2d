"""What becomes of a behaviour while it runs, from the feedback of its server. Pure."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from .steps import step_path
from .tracks import Tracks

RUNNING = ("began", "late", "told", "retried")
"""States of a step that goes on."""
OVER = ("ended", "failed", "skipped", "preempted")
MOST_LINES = 2000
"""Steps that are kept of one run."""
_PART = re.compile(r"[./#]?(\d+)")


@dataclass
class StepLine:
    """A step of the tree; times in s from the beginning of the behaviour, -1: not yet."""

    path: str
    what: str
    label: str = ""
    state: str = ""
    text: str = ""
    began: float = -1.0
    ended: float = -1.0

    @property
    def depth(self) -> int:
        """How many steps it is in."""
        return len(_PART.findall(self.path)) - 1 - self.path.count("#")

    @property
    def running(self) -> bool:
        return self.state in RUNNING


class RunView:
    """One run of a behaviour, from its beginning on; one thread tells, others look.

    `behavior`: its name; empty until it has begun.
    """

    def __init__(self) -> None:
        self.behavior = ""
        self._lines: dict[str, StepLine] = {}

    def told(self, feedback: Any) -> None:
        """Take in what the server tells. `feedback`: NaoBehaviorFeedback of a run."""
        if not feedback.path:
            return
        self.behavior = self.behavior or feedback.behavior
        if feedback.path not in self._lines and len(self._lines) >= MOST_LINES:
            return
        line = self._lines.setdefault(feedback.path, StepLine(feedback.path, feedback.what, feedback.label))
        if feedback.state == "began" and line.began < 0.0:
            line.began = feedback.time
        if feedback.state in OVER:
            line.ended = feedback.time
        if feedback.state != "told" or not line.state:
            line.state = feedback.state
        line.text = feedback.text or (line.text if feedback.state == "told" else "")

    def end(self) -> None:
        """The run is over: what has not ended was cut short."""
        for line in list(self._lines.values()):
            if line.running:
                line.state = "preempted"

    @property
    def running(self) -> bool:
        """Whether a step goes on."""
        return any(line.running for line in list(self._lines.values()))

    def tree(self) -> list[StepLine]:
        """All steps that have begun, parents before what is in them."""
        return sorted(list(self._lines.values()), key=lambda line: [int(each) for each in _PART.findall(line.path)])

    def states(self) -> dict[str, str]:
        """State of each step of the file."""
        states: dict[str, str] = {}
        for line in list(self._lines.values()):
            path = step_path(line.path)
            if "/" not in line.path:
                states[path] = line.state
            elif line.running:
                states[path] = "began"
        return states

    def measured(self) -> dict[str, float]:
        """Path -> s that each step took which has ended by itself."""
        return {
            line.path: line.ended - line.began
            for line in self._lines.values()
            if line.state == "ended" and 0.0 <= line.began <= line.ended
        }

    def cursor(self, tracks: Tracks, now: float) -> float:
        """Where the run is on the tracks, s: their times are guesses, so it follows the step that began last.

        `now`: s from the beginning of the behaviour.
        """
        place = 0.0
        latest = -1.0
        for line in list(self._lines.values()):
            box = tracks.box(step_path(line.path))
            if box is None or "/" in line.path or line.began < latest:
                continue
            latest = line.began
            elapsed = max(now - line.began, 0.0) if line.running else box.end - box.begin
            place = min(box.begin + elapsed, box.end)
        return place
