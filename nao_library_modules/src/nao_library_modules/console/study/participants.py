"""Pseudonyms that were mistyped: corrected, or taken back while nothing was played."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

from ...base.suggestion import of_those
from ...base.whole_file import FileTrouble, sync_folder
from .errors import StudyError
from .files import StudyFiles, TrialFolder, require_pseudonym
from .left import LeftTrial
from .log import PATIENCE, TrialLog, read_events, write_events_table
from .order import order_of
from .protocol import StudyProtocol
from .state import ABORTED, CORRECTED, ENDED, FINISHED, TAKEN_BACK


@dataclass(frozen=True)
class Schedule:
    """What a participant of a study has before him.

    Attributes:
        number: Of the participant.
        new: Whether the pseudonym is new in the study.
        order: Conditions of the trials, in their order: factor -> level.
        next: Which of them is the next one, from 1; 0: all are finished.
    """

    number: int
    new: bool
    order: tuple[Mapping[str, str], ...]
    next: int

    def lines(self, blind: bool) -> list[str]:
        """It for people; `blind`: whoever reads it must not know the conditions."""
        count = f"{len(self.order)} trial{'s' if len(self.order) > 1 else ''}"
        if blind:
            return [f"{count}; the wizard is blind: number, order and conditions are not shown"]
        told = f"Participant {self.number}{' (new)' if self.new else ''}, {count} in this order:"
        rows = [", ".join(f"{name}: {level}" for name, level in each.items()) for each in self.order]
        marks = [" (next)" if i == self.next else "" for i in range(1, len(rows) + 1)]
        return [told, *(f"{i}. {row or 'no factors'}{mark}" for i, (row, mark) in enumerate(zip(rows, marks), 1))]


def schedule_of(files: StudyFiles, protocol: StudyProtocol, pseudonym: str) -> Schedule:
    """What a participant has before him, also one who is not there yet: nothing is written.

    Raises StudyError if nobody can be called so.
    """
    number = files.coming_number(protocol.name, pseudonym)
    order = order_of(protocol, number)
    finished = finished_positions(files, protocol.name, pseudonym)
    coming = next((i for i in range(1, len(order) + 1) if i not in finished), 0)
    new = pseudonym not in files.participants(protocol.name)
    return Schedule(number, new, tuple(order), coming)


@dataclass(frozen=True)
class Participant:
    """A participant of a study. `trials`: how many were begun. `played`: whether a step of them was."""

    pseudonym: str
    number: int
    trials: int
    played: bool


def participants_of(files: StudyFiles, study: str) -> list[Participant]:
    """The participants of a study who have numbers, in the order in which they got them."""
    trials = [(trial.participant, trial.state()) for trial in files.trials(study)]
    found = []
    for pseudonym, number in files.participants(study).items():
        own = [state for name, state in trials if name == pseudonym and not state.rehearsal]
        found.append(Participant(pseudonym, number, len(own), any(state.outcomes for state in own)))
    return found


def finished_positions(files: StudyFiles, study: str, pseudonym: str) -> set[int]:
    """Which of the trials of a participant are finished, from 1; rehearsals are none of them."""
    states = [trial.state() for trial in files.trials(study) if trial.participant == pseudonym]
    return {state.about.get("position", 0) for state in states if state.status == FINISHED and not state.rehearsal}


def correct_pseudonym(files: StudyFiles, study: str, old: str, new: str, by: str = "", robot: Any = None) -> int:
    """Give a participant another pseudonym, with all trials; number, order and answers stay. Returns the number.

    Each trial has an event of it in its log, with both pseudonyms. Whatever happens meanwhile, nobody else gets the
    number; the same call carries on with what a power cut has left.

    Args:
        files: Of the studies.
        study: The study.
        old: The pseudonym as it was typed.
        new: As it should be.
        by: Who corrects it.
        robot: The `RobotClient`, whose time the events have; None: that of the last event of each trial.

    Raises:
        StudyError: There is no such participant, the new pseudonym is another one's, or a trial runs.
        FileTrouble: The disk cannot be written.
    """
    require_pseudonym(new)
    with files.locked(study), ExitStack() as logs:
        number, numbers = _known(files, study, old)
        if new == old:
            raise StudyError(f"{old} is called so already")
        trials = _trials(files, study, old)
        there = _trials(files, study, new)
        taken = new not in numbers and any(trial.state().holds_number for trial in there)
        if taken or numbers.get(new, number) != number:
            told = f"{new} is another participant of {study}, number {numbers.get(new, 'unknown')}"
            raise StudyError(f"{told}: if {old} has played nothing, take {old} back, and begin the trial as {new}")
        opened = [(trial, logs.enter_context(_Left(trial, robot))) for trial in trials]
        files.write_participants(study, {**numbers, new: number})
        used = {trial.number for trial in there}
        for trial, left in opened:
            count = trial.number if trial.number not in used else max(used) + 1
            used.add(count)
            target = trial.path.with_name(f"{new}-{count}")
            name = f"{study}/{target.name}"
            text = f"the pseudonym {old} is corrected to {new}"
            left.tell(CORRECTED, text, by, old=old, participant=new, corrected=name)
            left.put()
            files.change_description(trial, {"participant": new, "trial": name})
            try:
                os.rename(trial.path, target)
                sync_folder(target.parent)
            except OSError as error:
                raise FileTrouble(target, error) from error
        del numbers[old]
        files.write_participants(study, {**numbers, new: number})
    for trial in _trials(files, study, new):
        write_events_table(trial.path)
    return number


def take_back(files: StudyFiles, study: str, pseudonym: str, by: str = "", robot: Any = None) -> int:
    """Take a participant back who has played nothing: the number is free again. Returns it.

    Trials that were begun before a step stay as aborted, with an event of it in their logs.

    Raises:
        StudyError: There is no such participant, a step was begun, or a trial runs.
        FileTrouble: The disk cannot be written.
    """
    with files.locked(study), ExitStack() as logs:
        number, numbers = _known(files, study, pseudonym)
        opened = [(trial, logs.enter_context(_Left(trial, robot))) for trial in _trials(files, study, pseudonym)]
        played = [trial.id for trial, left in opened if left.state.outcomes and not left.state.rehearsal]
        if played:
            told = f"{pseudonym} has played in {', '.join(played)}: number {number} is used up"
            raise StudyError(f"{told}; a mistyped pseudonym can be corrected")
        for trial, left in opened:
            if left.state.rehearsal or not left.state.status:
                continue
            if not left.state.taken_back:
                left.tell(TAKEN_BACK, f"the participant {pseudonym} is taken back, number {number} is free", by)
            if not left.state.over:
                left.tell(ENDED, f"trial {trial.id} is {ABORTED}", by, outcome=ABORTED)
            left.put()
        del numbers[pseudonym]
        files.write_participants(study, numbers)
    for trial, _ in opened:
        write_events_table(trial.path)
    return number


class _Left(LeftTrial):
    """A trial of which nothing runs, whose log is closed at the end. Raises StudyError if it runs, or is recorded."""

    def __init__(self, trial: TrialFolder, robot: Any) -> None:
        self._trial_log = TrialLog(trial.path)
        super().__init__(trial.id, self._trial_log, read_events(trial.path), robot)
        if self.state.recordings:
            self._trial_log.close()
            told = f"trial {trial.id} still records {', '.join(self.state.recordings)}"
            raise StudyError(f"{told}: abort it before, which ends the recordings")

    def put(self) -> None:
        """Have what was told on the disk. Raises StudyError if it cannot be written."""
        trouble = self._trial_log.trouble
        if self._trial_log.close(0.0 if trouble else PATIENCE):
            raise StudyError(f"the log of trial {self.id} cannot be written: {trouble}")

    def __enter__(self) -> _Left:
        return self

    def __exit__(self, *_: Any) -> None:
        self._trial_log.close()


def _known(files: StudyFiles, study: str, pseudonym: str) -> tuple[int, dict[str, int]]:
    """The number of a participant, and those of all."""
    numbers = files.participants(study)
    if pseudonym not in numbers:
        raise StudyError(f"there is no participant {pseudonym!r} in {study}{of_those(pseudonym, numbers)}")
    return numbers[pseudonym], numbers


def _trials(files: StudyFiles, study: str, pseudonym: str) -> list[TrialFolder]:
    return [trial for trial in files.trials(study) if trial.participant == pseudonym]
