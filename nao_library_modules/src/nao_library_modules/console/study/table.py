"""What was measured: a row a trial and step, and what is counted and averaged by condition. Pure."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .errors import StudyError
from .files import StudyFiles
from .log import csv_text
from .protocol import NOTHING
from .state import DONE, TrialState

BEFORE = ("study", "participant", "number", "trial", "position", "trial_state")
BEHIND = (
    *("phase", "path", "label", "kind", "text", "attempt", "began_s", "ended_s", "outcome", "answer", "reaction_s"),
    *("error", "notes", "deviations"),
)
ANSWERED = ("wizard", "touch", "word", "face")
"""Kinds of steps whose answers are counted."""


@dataclass(frozen=True)
class StudyTable:
    """The table of a study.

    Attributes:
        factors: Names of the columns with the levels.
        rows: Column -> value.
        gaps: Id of a trial, and what its log lacks.
    """

    factors: tuple[str, ...]
    rows: tuple[Mapping[str, Any], ...]
    gaps: tuple[tuple[str, str], ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns in their order."""
        return (*BEFORE, *self.factors, *BEHIND)

    def csv(self) -> str:
        """All of it as CSV."""
        return csv_text(self.columns, [[row.get(column) for column in self.columns] for row in self.rows])


@dataclass(frozen=True)
class ConditionSummary:
    """A step in a condition, over all trials. Times in s."""

    condition: str
    label: str
    count: int  # how often it was done
    answers: Mapping[str, int]  # answer -> how often
    reactions: tuple[float, ...]

    @property
    def mean(self) -> float | None:
        """Of the reaction times; None without any."""
        return statistics.fmean(self.reactions) if self.reactions else None

    @property
    def median(self) -> float | None:
        return statistics.median(self.reactions) if self.reactions else None

    @property
    def deviation(self) -> float | None:
        """Standard deviation of the reaction times; None of fewer than two."""
        return statistics.stdev(self.reactions) if len(self.reactions) > 1 else None


def table_of(files: StudyFiles, study: str) -> StudyTable:
    """The table of a study. Raises StudyError if there is no such study."""
    trials = files.trials(study)
    if not trials:
        raise StudyError(f"study {study!r} has no trials: there are studies {', '.join(files.studies()) or 'none'}")
    states = [(trial, trial.state()) for trial in trials]
    factors = dict.fromkeys(name for _, state in states for name in state.about.get("condition", {}))
    rows = [row for trial, state in states for row in rows_of(state, study, trial.participant, trial.number)]
    gaps = tuple((trial.id, gap) for trial, state in states for gap in state.gaps)
    return StudyTable(tuple(factors), tuple(rows), gaps)


def rows_of(state: TrialState, study: str, participant: str, trial: int) -> Iterable[dict[str, Any]]:
    """Rows of a trial: a step each, in the order in which they were begun."""
    about = state.about
    for outcome in state.outcomes:
        yield {
            "study": study,
            "participant": participant,
            "number": about.get("number"),
            "trial": trial,
            "position": about.get("position"),
            "trial_state": state.status,
            **about.get("condition", {}),
            "phase": outcome.phase,
            "path": outcome.path,
            "label": outcome.label,
            "kind": outcome.kind,
            "text": outcome.text,
            "attempt": outcome.attempt,
            "began_s": outcome.began,
            "ended_s": outcome.ended,
            "outcome": outcome.outcome,
            "answer": outcome.answer,
            "reaction_s": outcome.seconds,
            "error": outcome.error,
            "notes": state.notes,
            "deviations": state.deviations,
        }


def summaries_of(table: StudyTable) -> list[ConditionSummary]:
    """Answers and reaction times by step and condition, of the steps that have answers; unlabelled ones by their path.

    What was repeated or stopped does not count.
    """
    groups: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for row in table.rows:
        if row["kind"] in ANSWERED and row["outcome"] in (DONE, "timeout"):
            condition = ", ".join(f"{name}: {row.get(name)}" for name in table.factors) or "all"
            groups.setdefault((str(row["label"] or row["path"]), condition), []).append(row)
    return [_summary(condition, label, rows) for (label, condition), rows in sorted(groups.items())]


def _summary(condition: str, label: str, rows: Sequence[Mapping[str, Any]]) -> ConditionSummary:
    answers: dict[str, int] = {}
    for row in rows:
        answer = str(row["answer"] or NOTHING)
        answers[answer] = answers.get(answer, 0) + 1
    reactions = tuple(row["reaction_s"] for row in rows if row["reaction_s"] is not None)
    return ConditionSummary(condition, label, len(rows), answers, reactions)
