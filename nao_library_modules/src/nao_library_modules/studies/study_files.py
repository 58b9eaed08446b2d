"""Files of studies: protocols, trials, participants.

DIR/STUDY/PSEUDONYM-N is the folder of a trial, DIR/protocols has the protocols of this computer. A mistyped pseudonym
is corrected, or taken back while nothing was played.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..behaviors.strict_yaml import dump, load
from ..core.errors import of_those
from ..core.files import FileTrouble, config_file, make_folder, sync_folder, write_durable
from .commands import ConsoleFileError
from .protocol import StudyError, StudyProtocol
from .protocol_reader import NAME, NAME_FORM, read_protocol, read_protocol_file
from .schedule import order_of
from .trial_log import (
    ABORTED,
    CORRECTED,
    ENDED,
    FINISHED,
    PATIENCE,
    TAKEN_BACK,
    LeftTrial,
    TrialLog,
    TrialState,
    is_written,
    read_events,
    write_events_table,
)

SHIPPED, OWN = "console/protocols", "protocols"
PARTICIPANTS, ABOUT, PROTOCOL = "participants.yaml", "trial.yaml", "protocol.yaml"
END = ".yaml"
MEDIA = re.compile(r"(video|sound)(-\d+)?\.(mp4|avi|wav|ogg)")
"""Files of a trial that pages may have."""
_TRIAL = re.compile(r"(?P<participant>.+)-(?P<number>\d+)")


@dataclass(frozen=True)
class TrialFolder:
    """A trial on the disk."""

    path: Path
    study: str
    participant: str
    number: int  # of the trial of this participant, from 1; also of one that was aborted

    @property
    def id(self) -> str:
        """Its name: STUDY/PSEUDONYM-N."""
        return f"{self.study}/{self.path.name}"

    def state(self) -> TrialState:
        """How far it is, from its events. Raises StudyError if they cannot be read."""
        return TrialState.of(read_events(self.path), self.runs())

    def runs(self) -> bool:
        """Whether a program runs it at this moment, this one or another."""
        return is_written(self.path)

    def protocol(self) -> StudyProtocol:
        """The protocol as it was when the trial began."""
        return read_protocol_file(self.path / PROTOCOL)


class StudyFiles:
    """The files of all studies.

    `folder`: of the studies; made when something is written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder.expanduser().absolute()

    def protocols(self) -> dict[str, Path]:
        """Protocols by their names: those that come along, and those of this computer, which go before."""
        shipped = sorted(config_file(SHIPPED).glob(f"*{END}"))
        own = sorted((self.folder / OWN).glob(f"*{END}"))
        return {path.stem: path for path in (*shipped, *own)}

    def protocol_text(self, name: str) -> str:
        """Text of a protocol. Raises StudyError if there is none."""
        known = self.protocols()
        if name not in known:
            raise StudyError(f"there is no protocol {name!r}{of_those(name, known)}")
        return _text(known[name])

    def newest_protocol(self) -> str:
        """Name of the protocol of the trial that was begun last; empty if there is none, or its protocol has gone."""
        begun = [(path.stat().st_mtime, path.parent.parent.name) for path in self.folder.glob(f"*/*/{ABOUT}")]
        study = max(begun, default=(0.0, ""))[1]
        known = self.protocols()
        for name in sorted(known, key=lambda name: name != study):  # mostly the file is called as the study
            try:
                if study and read_protocol_file(known[name]).name == study:
                    return name
            except ConsoleFileError:
                continue
        return ""

    def store_protocol(self, name: str, text: str) -> Path:
        """Store a protocol of this computer; where it is. Raises ConsoleFileError if it cannot be run."""
        _require_name(name, "protocol")
        read_protocol(text, name)
        return write_durable(self.folder / OWN / f"{name}{END}", text)

    def studies(self) -> list[str]:
        """Names of the studies that have trials, or participants."""
        named = {path.parent.name for path in self.folder.glob(f"*/{PARTICIPANTS}")}
        return sorted(named | {path.parent.parent.name for path in self.folder.glob(f"*/*/{ABOUT}")})

    def trials(self, study: str) -> list[TrialFolder]:
        """Trials of a study, by participant and number."""
        _require_name(study, "study")
        found = []
        for path in (self.folder / study).glob("*-*"):
            match = _TRIAL.fullmatch(path.name)
            if match and NAME.fullmatch(match["participant"]) and path.is_dir():
                found.append(TrialFolder(path, study, match["participant"], int(match["number"])))
        return sorted(found, key=lambda trial: (trial.participant, trial.number))

    def trial(self, trial_id: str) -> TrialFolder:
        """A trial by its id. Raises StudyError if there is none."""
        study, _, name = trial_id.partition("/")
        trials = {trial.id: trial for trial in self.trials(study)}
        if trial_id not in trials:
            raise StudyError(f"there is no trial {trial_id!r}{of_those(trial_id, trials)}")
        return trials[trial_id]

    def media(self, trial_id: str, name: str) -> Path:
        """A video or sound of a trial. Raises StudyError if there is none, or the name is of something else."""
        path = self.trial(trial_id).path / name
        if not MEDIA.fullmatch(name) or path.is_symlink() or not path.is_file():
            raise StudyError(f"there is no {name!r} of trial {trial_id}")
        return path

    def participants(self, study: str) -> dict[str, int]:
        """Numbers of the participants of a study by their pseudonyms."""
        path = self.folder / study / PARTICIPANTS
        if not path.is_file():
            return {}
        numbers = load(_text(path), path.name)
        if not isinstance(numbers, dict) or not all(type(number) is int for number in numbers.values()):
            raise StudyError(f"{path} is to be a mapping of pseudonyms to numbers")
        return dict(numbers)

    def number_of(self, study: str, pseudonym: str) -> int:
        """Number of a participant: a new one has that of the pseudonym (P07: 7) if it is free, else the lowest free.

        It is on the disk when this returns, and nobody else gets it: the numbers in the trials count as well.
        """
        with self.locked(study):
            known, numbers = self._numbers_with(study, pseudonym)
            if numbers != known:
                self.write_participants(study, numbers)
            return numbers[pseudonym]

    def coming_number(self, study: str, pseudonym: str) -> int:
        """The number that a participant has, or would get; nothing is written."""
        return self._numbers_with(study, pseudonym)[1][pseudonym]

    def write_participants(self, study: str, numbers: Mapping[str, int]) -> None:
        """Write the numbers of the participants; they are on the disk when this returns. Under `locked`."""
        write_durable(self.folder / study / PARTICIPANTS, dump(dict(numbers)))

    def _numbers_with(self, study: str, pseudonym: str) -> tuple[dict[str, int], dict[str, int]]:
        """Numbers as the file has them, and with those that only trials have and that of a participant."""
        require_pseudonym(pseudonym)
        known = self.participants(study)
        numbers = dict(known) if pseudonym in known else {**known, **self._numbers_in_trials(study, known)}
        if pseudonym not in numbers:
            digits = re.search(r"\d+$", pseudonym)
            number, taken = int(digits[0]) if digits else 0, {*numbers.values()}
            if number < 1 or number in taken:
                number = next(i for i in range(1, len(taken) + 2) if i not in taken)
            numbers[pseudonym] = number
        return known, numbers

    def _numbers_in_trials(self, study: str, known: Mapping[str, int]) -> dict[str, int]:
        """Numbers of participants who have trials, and are not known: the file of numbers was lost or changed."""
        states = [(trial.participant, trial.state()) for trial in self.trials(study) if trial.participant not in known]
        found = {name: state.about.get("number") for name, state in states if state.holds_number}
        return {name: number for name, number in found.items() if isinstance(number, int)}

    def new_trial(self, study: str, pseudonym: str) -> TrialFolder:
        """Folder of a new trial, which has the next number."""
        with self.locked(study):
            number = max((t.number for t in self.trials(study) if t.participant == pseudonym), default=0) + 1
            path = self.folder / study / f"{pseudonym}-{number}"
            try:
                path.mkdir()
                sync_folder(path.parent)
            except OSError as error:
                raise FileTrouble(path, error) from error
            return TrialFolder(path, study, pseudonym, number)

    def describe(self, trial: TrialFolder, about: Mapping[str, Any], protocol: str) -> None:
        """Write what is told of a trial beside its events, and the text of its protocol.

        Raises FileTrouble, and removes the folder, if they cannot be written.
        """
        try:
            write_durable(trial.path / PROTOCOL, protocol)
            write_durable(trial.path / ABOUT, dump(dict(about)))
        except FileTrouble:
            shutil.rmtree(trial.path, ignore_errors=True)
            raise

    def change_description(self, trial: TrialFolder, changes: Mapping[str, Any]) -> None:
        """Change what is told of a trial beside its events. Raises FileTrouble if it cannot be written."""
        path = trial.path / ABOUT
        if path.is_file():
            write_durable(path, dump({**load(_text(path), path.name), **changes}))

    @contextmanager
    def locked(self, study: str) -> Iterator[None]:
        """Keep other programs from giving, changing or taking back numbers at the same time."""
        _require_name(study, "study")
        folder = self.folder / study
        try:
            make_folder(folder)
            file = (folder / ".lock").open("w")
        except OSError as error:
            raise StudyError(f"{folder} cannot be written: {error.strerror}") from error
        with file:
            fcntl.flock(file, fcntl.LOCK_EX)
            yield


def _text(path: Path) -> str:
    """The text of a file. Raises StudyError if it cannot be read: nobody gives numbers anew, or another protocol."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{path} cannot be read: {error}; mend it, or rename it to go on without it") from error


def require_pseudonym(name: str) -> None:
    """See that a participant may be called so. Raises StudyError."""
    _require_name(name, "participant")


def _require_name(name: str, what: str) -> None:
    if not NAME.fullmatch(name) or (what == "study" and name == OWN):
        raise StudyError(f"{name!r} is no name of a {what}: {NAME_FORM}")


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
