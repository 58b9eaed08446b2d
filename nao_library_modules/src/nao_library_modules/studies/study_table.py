"""What was measured: a row a step, a row a trial, and what is counted and averaged by condition. Pure."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .protocol import DONE, NOTHING, SENSES, StudyError
from .schedule import any_round, round_numbers
from .study_files import StudyFiles
from .trial_log import ON, TIMEOUT, TrialState, csv_text

BEFORE = ("study", "participant", "number", "trial", "position", "trial_state", "rehearsal")
BEHIND = (
    *(
        "phase",
        "path",
        "round",
        "outer_round",
        "round_value",
        "label",
        "kind",
        "text",
        "attempt",
        "began_s",
        "ended_s",
        "outcome",
    ),
    *("answer", "reaction_s", "error", "notes", "deviations", "note_text", "deviation_text"),
)
OF_ROBOT = ("posture", "fallen", "limp", "stiffness", "battery")
"""What is known of the robot at the begin of a trial; the columns have `begin_` before it."""
OF_TRIAL = (
    *("began_s", "ended_s", "duration_s", "steps", "notes", "deviations", "note_text", "deviation_text", "alarms"),
    *(f"begin_{name}" for name in OF_ROBOT),
)
ANSWERED = ("wizard", "while", *SENSES)
"""Kinds of steps whose answers are counted, with a label or without; of others the answers of those with a label."""


@dataclass(frozen=True)
class StudyTable:
    """The table of a study.

    Attributes:
        factors: Names of the columns with the levels.
        rows: Of a step each: column -> value.
        trials: Of a trial each: column -> value, with the answers by their labels.
        gaps: Id of a trial, and what its log lacks.
        left_out: Ids of the trials that summaries leave out, and what they are.
    """

    factors: tuple[str, ...]
    rows: tuple[Mapping[str, Any], ...]
    trials: tuple[Mapping[str, Any], ...] = ()
    gaps: tuple[tuple[str, str], ...] = ()
    left_out: tuple[tuple[str, str], ...] = ()

    def csv(self) -> str:
        """A row a step, as CSV."""
        return _csv((*BEFORE, *self.factors, *BEHIND), self.rows)

    def trials_csv(self) -> str:
        """A row a trial, as CSV; the columns of the answers come last."""
        known = (*BEFORE, *self.factors, *OF_TRIAL)
        answers = dict.fromkeys(column for row in self.trials for column in row if column not in known)
        return _csv((*known, *answers), self.trials)


@dataclass(frozen=True)
class ConditionSummary:
    """A step in a condition, over all trials. Times in s."""

    condition: str
    label: str
    round: int | None  # of the innermost loop; None: all of them
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
    whole = [trial_row(state, study, trial.participant, trial.number) for trial, state in states]
    gaps = tuple((trial.id, gap) for trial, state in states for gap in state.gaps)
    left_out = tuple((trial.id, state.status_text) for trial, state in states if not state.counts)
    return StudyTable(tuple(factors), tuple(rows), tuple(whole), gaps, left_out)


def trial_row(state: TrialState, study: str, participant: str, trial: int) -> dict[str, Any]:
    """A trial, with the last answer of each label: `LABEL` and `LABEL_seconds`, in rounds `LABEL_r1` and so on."""
    row = _about(state, study, participant, trial)
    ended = state.ended
    row.update(began_s=state.began or None, ended_s=ended, duration_s=None)
    if ended is not None:
        row.update(duration_s=round(ended - state.began, 4))
    row.update(steps=len(state.outcomes), notes=state.notes, deviations=state.deviations, alarms=len(state.alarms))
    row.update(note_text=_joined(state.note_texts), deviation_text=_joined(state.deviation_texts))
    row.update({f"begin_{name}": state.robot.get(name) for name in OF_ROBOT})
    for outcome in state.outcomes:
        asks = outcome.kind in ANSWERED
        if outcome.label and outcome.outcome in ON and (asks or outcome.answer):
            rounds = "".join(f"_r{number}" for number in round_numbers(outcome.path))
            row[f"{outcome.label}{rounds}"] = outcome.answer or (DONE if outcome.outcome == DONE else NOTHING)
            if asks:
                row[f"{outcome.label}{rounds}_seconds"] = outcome.seconds
    return row


def _about(state: TrialState, study: str, participant: str, trial: int) -> dict[str, Any]:
    return {
        "study": study,
        "participant": participant,
        "number": state.about.get("number"),
        "trial": trial,
        "position": state.about.get("position"),
        "trial_state": state.status,
        "rehearsal": state.rehearsal,
        **state.about.get("condition", {}),
    }


def rows_of(state: TrialState, study: str, participant: str, trial: int) -> Iterable[dict[str, Any]]:
    """Rows of a trial: a step each, in the order in which they were begun."""
    for outcome in state.outcomes:
        rounds = [None, None, *round_numbers(outcome.path)]
        yield {
            **_about(state, study, participant, trial),
            "phase": outcome.phase,
            "path": outcome.path,
            "round": rounds[-1],
            "outer_round": rounds[-2],
            "round_value": next(reversed([*outcome.rounds.values()]), None),
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
            "note_text": _joined(outcome.note_texts),
            "deviation_text": _joined(outcome.deviation_texts),
        }


def summaries_of(table: StudyTable, by_round: bool = False, all_trials: bool = False) -> list[ConditionSummary]:
    """Answers and reaction times by step and condition, of the steps that have answers; unlabelled ones by their path.

    What was repeated or stopped does not count.

    Args:
        table: Of the study.
        by_round: A summary for each round of a loop as well.
        all_trials: Also those that were aborted, and rehearsals.
    """
    left_out = set() if all_trials else {trial for trial, _ in table.left_out}
    groups: dict[tuple[str, str, int], list[Mapping[str, Any]]] = {}
    for row in table.rows:
        if f"{row['study']}/{row['participant']}-{row['trial']}" in left_out:
            continue
        if (row["kind"] in ANSWERED or (row["label"] and row["answer"])) and row["outcome"] in (DONE, TIMEOUT):
            condition = ", ".join(f"{name}: {row.get(name)}" for name in table.factors) or "all"
            label = str(row["label"] or any_round(row["path"]))
            number = row["round"] if by_round else None
            groups.setdefault((label, condition, number or 0), []).append(row)
    return [
        _summary(condition, label, number or None, rows) for (label, condition, number), rows in sorted(groups.items())
    ]


def _summary(condition: str, label: str, number: int | None, rows: Sequence[Mapping[str, Any]]) -> ConditionSummary:
    answers: dict[str, int] = {}
    for row in rows:
        answer = str(row["answer"] or (DONE if row["outcome"] == DONE else NOTHING))
        answers[answer] = answers.get(answer, 0) + 1
    reactions = tuple(row["reaction_s"] for row in rows if row["reaction_s"] is not None)
    return ConditionSummary(condition, label, number, len(rows), answers, reactions)


def _joined(texts: Sequence[str]) -> str:
    return "; ".join(texts)


def _csv(columns: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> str:
    return csv_text(columns, [[row.get(column) for column in columns] for row in rows])
