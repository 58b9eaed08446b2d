"""How far a trial is, worked out from its events alone: while it runs, when it is resumed, and afterwards."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..robots.events import ALARM, STATE
from .conditions import NOTHING
from .course import is_inside
from .protocol import DONE

TRIAL = "trial"
"""Kind of the events that a trial itself adds; their `data` has what as one of those below."""
BEGAN, RESUMED, STEP_BEGAN, STEP_ENDED, PAUSED, CONTINUED, HELD, ENDED = (
    *("began", "resumed", "step began", "step ended", "paused", "continued", "held", "ended"),
)
TROUBLE_SEEN = "trouble seen"
LOG_GAP = "log gap"
"""What a deviation has as `what` that tells when the log could not be written."""
CORRECTED, TAKEN_BACK = "pseudonym corrected", "participant taken back"
RECORDING_BEGAN, RECORDING_ENDED = "recording began", "recording ended"
RUNNING, INTERRUPTED, FINISHED, ABORTED = "running", "interrupted", "finished", "aborted"
STATES = (RUNNING, PAUSED, HELD, INTERRUPTED, FINISHED, ABORTED)
TIMEOUT, SKIPPED, FAILED, REPEATED, STOPPED = "timeout", "skipped", "failed", "repeated", "stopped"
CUT = "cut"
"""End of a step in a `while` that has ended it."""
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
    began: float | None  # None: the log does not tell
    ended: float | None = None  # None: it has not
    outcome: str = ""  # done, timeout, skipped, failed, repeated, stopped, cut; empty: it has not ended
    answer: str = ""  # choice, sensor, word, name of the face
    seconds: float | None = None  # reaction time: from `began` to the answer
    error: str = ""
    finished: float | None = None  # when what the robot did was over, of speech the last sound; None: it does not tell
    rounds: Mapping[str, int] = field(default_factory=dict)  # name of a loop's value -> value, from outside
    note_texts: list[str] = field(default_factory=list)  # written before the next step began
    deviation_texts: list[str] = field(default_factory=list)


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
    note_texts: list[str] = field(default_factory=list)
    deviation_texts: list[str] = field(default_factory=list)  # gaps among them
    alarms: list[str] = field(default_factory=list)  # those that began in the trial, for people
    robot: dict[str, Any] = field(default_factory=dict)  # how it was at the begin; empty: the log does not tell
    gaps: list[str] = field(default_factory=list)  # what the log lacks
    taken_back: bool = False  # its participant was, before a step began
    trouble: str = ""  # of the log, until somebody has seen it
    open: list[StepOutcome] = field(default_factory=list)  # steps that run: a `while`, and the one in it

    @staticmethod
    def of(events: Iterable[Mapping[str, Any]], runs: bool = False) -> TrialState:
        """Of a log. Without an end a trial is `INTERRUPTED`, unless it was paused or held, or a program `runs` it."""
        state, last = TrialState(), 0
        for event in events:
            number = event.get("n")
            if isinstance(number, int):
                if number > last + 1:
                    missing = f"event {last + 1} is" if number == last + 2 else f"events {last + 1} to {number - 1} are"
                    state._lacks(f"{missing} not in the log")
                last = number
            state.apply(event)
        if state.status == RUNNING and not runs:
            state.status = INTERRUPTED
        return state

    @property
    def over(self) -> bool:
        """Whether it is finished or aborted."""
        return self.status in (FINISHED, ABORTED)

    @property
    def rehearsal(self) -> bool:
        """Whether it only rehearses: it is none of the participant's trials."""
        return bool(self.about.get("rehearsal", False))

    @property
    def holds_number(self) -> bool:
        """Whether the number of its participant is used up by it: it is no rehearsal, and was not taken back."""
        return not self.rehearsal and not self.taken_back

    @property
    def counts(self) -> bool:
        """Whether summaries count it: it is neither aborted nor a rehearsal."""
        return self.status != ABORTED and not self.rehearsal

    @property
    def status_text(self) -> str:
        """Its status, and whether it is a rehearsal, for people."""
        return f"{self.status or 'empty'}{', rehearsal' if self.rehearsal else ''}"

    @property
    def steps_text(self) -> str:
        """How many steps were begun, which are its rows in the table, and how they ended, for people."""
        ends = Counter(outcome.outcome or "not ended" for outcome in self.outcomes)
        told = ", ".join(f"{count} {end}" for end, count in ends.items())
        return f"{len(self.outcomes)} step{'' if len(self.outcomes) == 1 else 's'}" + (f": {told}" if told else "")

    @property
    def notes(self) -> int:
        return len(self.note_texts)

    @property
    def deviations(self) -> int:
        return len(self.deviation_texts)

    @property
    def current(self) -> StepOutcome | None:
        """The step that was begun and has not ended; of a `while` and the step in it the `while`."""
        return self.open[0] if self.open else None

    @property
    def last(self) -> StepOutcome | None:
        """The step that was begun last, but for those in a `while`."""
        return next((each for each in reversed(self.outcomes) if not is_inside(each.path)), None)

    def attempts(self, path: str) -> int:
        """How often a step has been begun."""
        return sum(outcome.path == path for outcome in self.outcomes)

    def apply(self, event: Mapping[str, Any]) -> None:
        """Take an event into account; `event`: as it is logged."""
        kind, stamp, told = event.get("kind"), float(event.get("stamp") or 0.0), event.get("data") or {}
        what = told.get("what")
        if kind == ALARM and what == BEGAN:
            self.alarms.append(str(event.get("text", "")))
        if kind == STATE and not self.robot:
            self.robot = dict(told)
        if kind == "note":
            self._mark(str(event.get("text", "")), lambda of: of.note_texts)
        elif kind == "deviation":
            self._mark(str(event.get("text", "")), lambda of: of.deviation_texts)
        if kind == "deviation" and what == LOG_GAP:
            self.trouble = str(event.get("text", ""))
        if kind != TRIAL or not isinstance(what, str):
            return
        if what == BEGAN:
            self.about, self.values, self.began, self.status = dict(told), dict(told["values"]), stamp, RUNNING
        elif what in (PAUSED, HELD):
            self.status = what
        elif what in (CONTINUED, RESUMED):
            self.status = RUNNING
            for outcome in reversed(self.open[:] if what == RESUMED else []):
                self._end(outcome, {"outcome": STOPPED, "error": "the console was gone"}, stamp)
        elif what == STEP_BEGAN:
            self._lacks_end(told["path"])
            self.outcomes.append(_outcome(told, began=stamp))
            self.open.append(self.outcomes[-1])
        elif what == STEP_ENDED:
            self._end(self._begun(told), told, stamp)
        elif what == CORRECTED:
            self.about.update(participant=told["participant"], trial=told["corrected"])
            self.values["participant"] = told["participant"]
        elif what == TAKEN_BACK:
            self.taken_back = True
        elif what == TROUBLE_SEEN:
            self.trouble = ""
        elif what == RECORDING_BEGAN:
            self.recordings[told["recording"]] = dict(told)
        elif what == RECORDING_ENDED:
            self.files.append({**self.recordings.pop(told["recording"], {}), **told})
        elif what == ENDED:
            if told["outcome"] == FINISHED:
                self._lacks_end()
            self.status, self.ended = told["outcome"], stamp

    def _begun(self, told: Mapping[str, Any]) -> StepOutcome:
        """The step that an event of an end is about; one is added where the log lacks its begin."""
        place = (told["path"], told.get("attempt", 1))
        for outcome in reversed(self.outcomes):
            if (outcome.path, outcome.attempt) == place and outcome.ended is None:
                return outcome
        self._lacks_end(place[0])
        lacking = self._lacks(f"the begin of step {place[0]} is not in the log")
        self.outcomes.append(_outcome(told, began=None, error=lacking))
        return self.outcomes[-1]

    def _end(self, outcome: StepOutcome, told: Mapping[str, Any], stamp: float) -> None:
        if any(each is outcome for each in self.open):
            while self.open.pop() is not outcome:  # a step in it
                continue
        outcome.ended, outcome.outcome = stamp, told["outcome"]
        outcome.answer, outcome.seconds = told.get("answer", ""), told.get("seconds")
        outcome.finished = told.get("finished")
        outcome.error = "; ".join(filter(None, (outcome.error, told.get("error", ""))))
        if outcome.outcome in ON:
            if not is_inside(outcome.path):
                self.path = outcome.path
            if outcome.label:
                self.values[outcome.label] = outcome.answer or (NOTHING if outcome.outcome != DONE else DONE)
                self.values[f"{outcome.label}_seconds"] = outcome.seconds

    def _lacks_end(self, path: str = "") -> None:
        """Note of which steps the log does not tell the end: those that run, but for a `while` around `path`."""
        while self.open and not path.startswith(f"{self.open[-1].path}.w"):
            self._lacks_end_of(self.open.pop())

    def _lacks_end_of(self, outcome: StepOutcome) -> None:
        outcome.error = self._lacks(f"the end of step {outcome.path} is not in the log")

    def _lacks(self, what: str) -> str:
        """Note what the log lacks, a deviation; `what`."""
        self.gaps.append(what)
        self.deviation_texts.append(what)
        return what

    def _mark(self, text: str, texts_of: Callable[[TrialState | StepOutcome], list[str]]) -> None:
        """Keep the text of a note or a deviation, of the trial and of the step that was begun last."""
        texts_of(self).append(text)
        if self.outcomes:
            texts_of(self.outcomes[-1]).append(text)


def _outcome(told: Mapping[str, Any], began: float | None, error: str = "") -> StepOutcome:
    """A step, of the event of its begin or its end."""
    names = ("path", "phase", "label", "step", "title")
    rounds = told.get("rounds") or {}
    about = (told.get(name, "") for name in names)
    return StepOutcome(*about, told.get("attempt", 1), began, error=error, rounds=rounds)
