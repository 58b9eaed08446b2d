"""How far a trial is, worked out from its events alone: while it runs, when it is taken up again, and afterwards."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from .protocol import DONE, NOTHING

TRIAL = "trial"
"""Kind of the events that a trial itself adds; their `data` has what as one of those below."""
BEGAN, TAKEN_UP, STEP_BEGAN, STEP_ENDED, PAUSED, CONTINUED, HELD, ENDED = (
    *("began", "taken up", "step began", "step ended", "paused", "continued", "held", "ended"),
)
RECORDING_BEGAN, RECORDING_ENDED = "recording began", "recording ended"
RUNNING, INTERRUPTED, FINISHED, ABORTED = "running", "interrupted", "finished", "aborted"
STATES = (RUNNING, PAUSED, HELD, INTERRUPTED, FINISHED, ABORTED)
TIMEOUT, SKIPPED, FAILED, REPEATED, STOPPED = "timeout", "skipped", "failed", "repeated", "stopped"
ON = (DONE, TIMEOUT, SKIPPED, FAILED)
"""Ends of a step behind which the next one comes; a failed one where the protocol says so, or the wizard goes on."""


@dataclass
class StepOutcome:
    """A step that was begun. Times are ROS times, s."""

    path: str
    phase: str
    label: str
    kind: str
    text: str
    attempt: int  # how often it has been begun
    began: float
    ended: float | None = None  # None: it has not
    outcome: str = ""  # done, timeout, skipped, failed, repeated, stopped; empty: it has not ended
    answer: str = ""  # choice, sensor, word, name of the face
    seconds: float | None = None  # reaction time: from `began` to the answer
    error: str = ""


@dataclass
class TrialState:
    """How far a trial is."""

    about: dict[str, Any] = field(default_factory=dict)  # what the event of its begin holds
    status: str = ""  # one of `STATES`; empty: it has not begun
    path: str = ""  # of the last step that is over, empty: none is
    values: dict[str, Any] = field(default_factory=dict)  # for conditions and texts
    outcomes: list[StepOutcome] = field(default_factory=list)
    recordings: dict[str, dict[str, Any]] = field(default_factory=dict)  # kind -> what runs
    files: list[dict[str, Any]] = field(default_factory=list)  # recordings that have ended
    began: float = 0.0
    ended: float | None = None
    notes: int = 0
    deviations: int = 0

    @staticmethod
    def of(events: Iterable[Mapping[str, Any]], runs: bool = False) -> TrialState:
        """Of a log. Without an end a trial is `INTERRUPTED`, unless it was paused or held, or a program `runs` it."""
        state = TrialState()
        for event in events:
            state.apply(event)
        if state.status == RUNNING and not runs:
            state.status = INTERRUPTED
        return state

    @property
    def over(self) -> bool:
        """Whether it is finished or aborted."""
        return self.status in (FINISHED, ABORTED)

    @property
    def current(self) -> StepOutcome | None:
        """The step that was begun and has not ended."""
        last = self.outcomes[-1] if self.outcomes else None
        return last if last is not None and last.ended is None else None

    def attempts(self, path: str) -> int:
        """How often a step has been begun."""
        return sum(outcome.path == path for outcome in self.outcomes)

    def apply(self, event: Mapping[str, Any]) -> None:
        """Take an event into account; `event`: as it is logged."""
        kind, stamp, told = event.get("kind"), float(event.get("stamp") or 0.0), event.get("data") or {}
        self.notes += kind == "note"
        self.deviations += kind == "deviation"
        what = told.get("what")
        if kind != TRIAL or not isinstance(what, str):
            return
        if what == BEGAN:
            self.about, self.values, self.began, self.status = dict(told), dict(told["values"]), stamp, RUNNING
        elif what in (PAUSED, HELD):
            self.status = what
        elif what in (CONTINUED, TAKEN_UP):
            self.status = RUNNING
            if what == TAKEN_UP and self.current is not None:
                self._end({"outcome": STOPPED, "error": "the console was gone"}, stamp)
        elif what == STEP_BEGAN:
            names = ("path", "phase", "label", "step", "title", "attempt")
            self.outcomes.append(StepOutcome(*(told[name] for name in names), began=stamp))
        elif what == STEP_ENDED:
            self._end(told, stamp)
        elif what == RECORDING_BEGAN:
            self.recordings[told["recording"]] = dict(told)
        elif what == RECORDING_ENDED:
            self.files.append({**self.recordings.pop(told["recording"], {}), **told})
        elif what == ENDED:
            self.status, self.ended = told["outcome"], stamp

    def _end(self, told: Mapping[str, Any], stamp: float) -> None:
        outcome = self.current
        if outcome is None:
            return
        outcome.ended, outcome.outcome = stamp, told["outcome"]
        outcome.answer, outcome.seconds = told.get("answer", ""), told.get("seconds")
        outcome.error = told.get("error", "")
        if outcome.outcome in ON:
            self.path = outcome.path
            if outcome.label:
                self.values[outcome.label] = outcome.answer or (NOTHING if outcome.outcome != DONE else DONE)
                self.values[f"{outcome.label}_seconds"] = outcome.seconds
