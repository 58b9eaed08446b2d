"""`nao study`: studies with participants, without a browser."""

from __future__ import annotations

import queue
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from naoqi.errors import NaoError

from ...core.errors import of_those
from ...core.files import FileTrouble, write_whole
from ..cli_settings import CliSettings, NaoCommand, NaoGroup, settings_of
from ..output import CommandFailed, CommandInterrupted, overwrite_option, say_json, say_lines, table, wanted_file
from .console_commands import command_check

if TYPE_CHECKING:
    from ...studies.protocol import StudyProtocol, WantedRecordings
    from ...studies.studies import Studies
    from ...studies.study_files import StudyFiles, TrialFolder
    from ...studies.trial_log import TrialState
    from ...studies.trial_runner import TrialRunner

FOLDER = "~/.ros/nao_studies"
END = ".yaml"
RECORDED = ("bag", "video", "sound")
LOOK_PERIOD = 0.5
"""s between looks at a trial in which nothing happens."""
TOLD_AFTER = 3.0
"""s between two lines about a log that a trial waits for at its end."""
WIZARD = {"n": ("next", "next"), "r": ("repeat", "repeat"), "a": ("abort", "abort")}
STOPPED = {"c": ("continue", "go_on"), "n": ("next", "next"), "a": ("abort", "abort")}
"""Of a trial whose step failed, or that was stopped: key -> what it does in words, and the control of the trial."""
folder_option = click.option(
    "--studies",
    "folder",
    default=FOLDER,
    show_default=True,
    type=click.Path(path_type=Path, file_okay=False),
    help="Folder of the studies.",
)


@click.group(cls=NaoGroup, name="study")
def study_command() -> None:
    """Studies with participants: check protocols, run trials, get the table.

    The page "Study" of `nao console` does the same with the same files.
    """


@study_command.command("list", cls=NaoCommand)
@folder_option
@click.pass_context
def list_studies(context: click.Context, folder: Path) -> None:
    """The protocols, the studies, and the trials that have not ended."""
    files = _files(folder)
    protocols = {name: str(path) for name, path in files.protocols().items()}
    trials = {name: [(trial, trial.state()) for trial in files.trials(name)] for name in files.studies()}
    if settings_of(context).json:
        states = {name: {trial.path.name: state.status for trial, state in found} for name, found in trials.items()}
        say_json({"protocols": protocols, "studies": states})
        return
    say_lines(table([("protocol", name, path) for name, path in protocols.items()]))
    say_lines(table([("study", name, f"{len(found)} trials") for name, found in trials.items()]))
    opened = [(trial, state) for found in trials.values() for trial, state in found if not state.over]
    say_lines(table([("open", trial.id, _status(trial, state)) for trial, state in opened]))


@study_command.command("check", cls=NaoCommand)
@click.argument("protocol", metavar="PROTOCOL|FILE")
@folder_option
@click.pass_context
def check(context: click.Context, protocol: str, folder: Path) -> None:
    """Whether a protocol can be run: each mistake is told with its line.

    Servers and stored behaviours are those that run. Where none does, the code tells what this package's servers can
    do, and the behaviours are those of the usual folder.
    """
    from ...studies.protocol_check import ProtocolCheck
    from ...studies.schedule import order_of

    read = _protocol(_files(folder), protocol)
    problems = ProtocolCheck(command_check(settings_of(context))).problems(read)
    if problems:
        raise CommandFailed("\n".join([f"protocol {read.name} cannot be run:", *map(str, problems)]))
    order = order_of(read, 1)
    if settings_of(context).json:
        say_json({"name": read.name, "order": order})
        return
    click.echo(f"nothing wrong was found in {read.name}")
    if read.factors:
        click.echo(f"participant 1 has {len(order)} trials:")
        say_lines(f"  {i}. {_words(condition)}" for i, condition in enumerate(order, 1))


@study_command.command("run", cls=NaoCommand)
@click.argument("protocol", metavar="PROTOCOL|FILE")
@click.option("--participant", required=True, metavar="PSEUDONYM", help="Who takes part.")
@click.option(
    "--trial", "position", type=click.IntRange(1), help="Which of the participant's.  [default: the next one]"
)
@click.option("--all", "every", is_flag=True, help="All trials that the participant still has.")
@click.option("--choose", multiple=True, metavar="LABEL=CHOICE", help="Of a step of the wizard; the others are asked.")
@click.option(
    "--value", "given", multiple=True, metavar="NAME=TEXT", help="Of the protocol's values: another one in this trial."
)
@click.option("--record", metavar="bag,video,sound", help="What is recorded.  [default: as the protocol has it]")
@click.option(
    "--rehearse", is_flag=True, help="No trial of the participant: uses up no number, summaries leave it out."
)
@folder_option
@click.pass_context
def run(
    context: click.Context,
    protocol: str,
    participant: str,
    position: int | None,
    every: bool,
    choose: tuple[str, ...],
    given: tuple[str, ...],
    record: str | None,
    rehearse: bool,
    folder: Path,
) -> None:
    """Run a trial of a participant here, and wait for its end; what the wizard decides is asked.

    Number, order and conditions of the participant are told before. Ctrl-C aborts the trial. What was logged stays.
    """
    from ...studies.study_files import schedule_of

    settings = settings_of(context)
    files = _files(folder)
    if rehearse and every:
        raise click.UsageError("--rehearse is one trial: without --all")
    read = _protocol(files, protocol)
    wanted = _recordings(read, record)
    choices, values = _assigned(choose, "LABEL=CHOICE"), _assigned(given, "NAME=TEXT")
    for name in values:
        if name not in read.values:
            raise click.UsageError(f"{read.name} has no value {name!r}{of_those(name, read.values)}")
    studies, robot = _studies(settings, files)
    ids: list[str] = []
    troubles: list[str] = []
    for line in _told(lambda: schedule_of(files, read, participant)).lines(read.blind):
        click.echo(line, err=settings.json)
    while not ids or (every and not position and not _done(studies, read, participant)):
        more = {"position": position or 0, "record": wanted, "values": values, "rehearsal": rehearse}
        begin = partial(studies.begin, read, participant, robot, "nao", **more)
        ids.append(_play(settings, begin, choices, troubles))
    if settings.json:
        say_json({"trials": ids, "troubles": troubles})


@study_command.command("order", cls=NaoCommand)
@click.argument("protocol", metavar="PROTOCOL|FILE")
@click.argument("participant", metavar="PSEUDONYM")
@folder_option
@click.pass_context
def order(context: click.Context, protocol: str, participant: str, folder: Path) -> None:
    """Number, order and conditions of a participant, also of one who has not begun. Nothing is written."""
    from ...studies.study_files import schedule_of

    files = _files(folder)
    read = _protocol(files, protocol)
    schedule = _told(lambda: schedule_of(files, read, participant))
    if settings_of(context).json:
        about = {"number": schedule.number, "new": schedule.new, "order": schedule.order, "next": schedule.next}
        say_json({"name": read.name, "participant": participant, "blind": read.blind, **({} if read.blind else about)})
        return
    say_lines(schedule.lines(read.blind))


@study_command.command("rename", cls=NaoCommand)
@click.argument("study", metavar="STUDY")
@click.argument("old", metavar="PSEUDONYM")
@click.argument("new", metavar="NEW")
@folder_option
@click.pass_context
def rename(context: click.Context, study: str, old: str, new: str, folder: Path) -> None:
    """Correct a mistyped pseudonym in all trials of a participant; number, order and answers stay."""
    from ...studies.study_files import correct_pseudonym

    number = _told(lambda: correct_pseudonym(_files(folder), study, old, new, "nao"))
    if settings_of(context).json:
        say_json({"study": study, "old": old, "participant": new, "number": number})
        return
    click.echo(f"{old} is {new} now, participant {number} of {study}")


@study_command.command("take-back", cls=NaoCommand)
@click.argument("study", metavar="STUDY")
@click.argument("participant", metavar="PSEUDONYM")
@folder_option
@click.pass_context
def take_participant_back(context: click.Context, study: str, participant: str, folder: Path) -> None:
    """Take back a participant who has played nothing: the number is free again."""
    from ...studies.study_files import take_back

    number = _told(lambda: take_back(_files(folder), study, participant, "nao"))
    if settings_of(context).json:
        say_json({"study": study, "participant": participant, "number": number})
        return
    click.echo(f"{participant} is taken back, number {number} of {study} is free")


@study_command.command("resume", cls=NaoCommand)
@click.argument("trial", metavar="STUDY/PSEUDONYM-N")
@click.option("--choose", multiple=True, metavar="LABEL=CHOICE", help="Of a step of the wizard; the others are asked.")
@folder_option
@click.pass_context
def resume(context: click.Context, trial: str, choose: tuple[str, ...], folder: Path) -> None:
    """Resume a trial whose program was gone, behind the last step that had ended."""
    settings = settings_of(context)
    choices = _assigned(choose, "LABEL=CHOICE")
    studies, robot = _studies(settings, _files(folder))
    troubles: list[str] = []
    _play(settings, partial(studies.resume, trial, robot, "nao"), choices, troubles)
    if settings.json:
        say_json({"trials": [trial], "troubles": troubles})


@study_command.command("abort", cls=NaoCommand)
@click.argument("trial", metavar="STUDY/PSEUDONYM-N")
@folder_option
@click.pass_context
def abort(context: click.Context, trial: str, folder: Path) -> None:
    """Give up a trial whose program was gone, and end the recordings that it has left. What was logged stays."""
    from ...studies.studies import Studies
    from ...studies.trial_recordings import BAG

    settings = settings_of(context)
    files = _files(folder)
    recorded = _told(lambda: files.trial(trial).state().recordings)
    robot = None
    if any(kind != BAG for kind in recorded):  # which the servers record
        try:
            _, robot = _studies(settings, files)
        except click.ClickException as error:
            click.echo(f"the {' and '.join(recorded)} may go on: {error.message}", err=True)
    state = _told(lambda: Studies(files).abort(trial, robot, "nao"))
    if settings.json:
        say_json({"trial": trial, "state": state.status, "files": state.files})
        return
    click.echo(f"trial {trial} is {state.status}")
    say_lines(f"{file['recording']}: {file.get('error') or file.get('file')}" for file in state.files)


@study_command.command("table", cls=NaoCommand)
@click.argument("study", metavar="STUDY|DIR")
@click.option("--csv", "file", default="", type=click.Path(), metavar="FILE.csv", help="A row a step of a trial.")
@click.option("--trials", "trials", default="", type=click.Path(), metavar="FILE.csv", help="A row a trial.")
@click.option("--by-round", is_flag=True, help="Answers of each round of a loop.")
@click.option("--all-trials", is_flag=True, help="Count aborted trials and rehearsals, too.")
@overwrite_option
@folder_option
@click.pass_context
def study_table(
    context: click.Context,
    study: str,
    file: str,
    trials: str,
    by_round: bool,
    all_trials: bool,
    overwrite: bool,
    folder: Path,
) -> None:
    """Answers and reaction times by condition; with --csv and --trials the whole tables as files.

    Trials that were aborted and rehearsals are not counted, and marked in the files.

    STUDY is the name of one in the folder of the studies, or its own folder.
    """
    from ...studies.study_files import StudyFiles
    from ...studies.study_table import summaries_of, table_of

    places = {end: wanted_file(each, overwrite, ("csv",)) for end, each in (("", file), ("_trials", trials))}
    path = Path(study).expanduser().absolute()
    files, name = (StudyFiles(path.parent), path.name) if path.is_dir() else (_files(folder), study)
    found = _told(lambda: table_of(files, name))
    tables = {"": (found.csv, len(found.rows)), "_trials": (found.trials_csv, len(found.trials))}
    written = []
    for end, target in places.items():
        if target is None:
            continue
        target = target / f"{name}{end}.csv" if target.is_dir() else target
        text, rows = tables[end]
        try:
            write_whole(target, text())
        except FileTrouble as error:
            raise CommandFailed(str(error)) from None
        written.append((target, rows))
    summaries = summaries_of(found, by_round, all_trials)
    left_out = () if all_trials else found.left_out
    if settings_of(context).json:
        rows = [
            {
                "step": each.label,
                "round": each.round,
                "condition": each.condition,
                "count": each.count,
                "answers": each.answers,
                "mean_s": each.mean,
                "median_s": each.median,
                "deviation_s": each.deviation,
            }
            for each in summaries
        ]
        gaps = [{"trial": trial, "gap": gap} for trial, gap in found.gaps]
        files = {str(target): count for target, count in written}
        out = [{"trial": trial, "state": what} for trial, what in left_out]
        say_json({"rows": len(found.rows), "files": files, "summaries": rows, "gaps": gaps, "left_out": out})
        return
    lines = [("step", *(("round",) if by_round else ()), "condition", "times", "mean s", "median s", "answers")]
    for each in summaries:
        rounds = (str(each.round or ""),) if by_round else ()
        times = (str(each.count), _number(each.mean), _number(each.median))
        answers = ", ".join(f"{answer} {count}" for answer, count in sorted(each.answers.items()))
        lines.append((each.label, *rounds, each.condition, *times, answers))
    say_lines(table(lines))
    say_lines(f"{trial}: not counted, {what}" for trial, what in left_out)
    say_lines(f"{trial}: {gap}" for trial, gap in found.gaps)
    say_lines(f"written: {target}, {count} rows" for target, count in written)


def _status(trial: TrialFolder, state: TrialState) -> str:
    """Of a trial that is not over, for people."""
    return f"{state.status or 'empty'}, runs in another program" if trial.runs() else state.status or "empty"


def _files(folder: Path) -> StudyFiles:
    from ...studies.study_files import StudyFiles

    return StudyFiles(folder)


def _protocol(files: StudyFiles, name: str) -> StudyProtocol:
    """A protocol by its name or its file."""
    from ...studies.protocol_reader import read_protocol_file

    if name.endswith(END) or "/" in name:
        return _told(lambda: read_protocol_file(Path(name).expanduser()))
    known = files.protocols()
    if name not in known:
        raise CommandFailed(f"there is no protocol {name!r}{of_those(name, known)}; a file ends in {END}")
    return _told(lambda: read_protocol_file(known[name]))


def _told(act: Callable[[], Any]) -> Any:
    """What a function answers; its errors are those of the command, each mistake of a file on a line of its own."""
    from ...studies.commands import ConsoleFileError

    try:
        return act()
    except ConsoleFileError as error:
        raise CommandFailed("\n".join([f"{error.name} cannot be run:", *map(str, error.problems)])) from None
    except (NaoError, OSError) as error:
        raise CommandFailed(str(error)) from None


def _studies(settings: CliSettings, files: StudyFiles) -> tuple[Studies, Any]:
    """The studies, and the robot that is meant."""
    from ...console.watched_studies import studies_alone
    from ..goals import start_node

    namespace = settings.stack.namespace
    start_node()
    return _told(lambda: studies_alone(files, namespace))


def _recordings(protocol: StudyProtocol, text: str | None) -> WantedRecordings | None:
    from ...studies.protocol import BAG_TOPICS, WantedRecordings

    if text is None:
        return None
    words = [word for word in text.split(",") if word]
    for word in words:
        if word not in RECORDED:
            raise click.UsageError(f"there is no recording {word!r}{of_those(word, RECORDED)}")
    bag = protocol.record.bag or BAG_TOPICS
    video = protocol.record.video or "top"
    return WantedRecordings(bag if "bag" in words else (), video if "video" in words else "", "sound" in words)


def _assigned(texts: Sequence[str], form: str) -> dict[str, str]:
    """What words as NAME=TEXT say. `form`: what they are to be, for the error."""
    found = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name:
            raise click.UsageError(f"{text!r} is wrong: {form}")
        found[name] = value
    return found


def _done(studies: Studies, protocol: StudyProtocol, participant: str) -> bool:
    from ...studies.protocol import StudyError

    try:
        studies.position_of(protocol, participant)
    except StudyError:
        return True
    return False


def _play(
    settings: CliSettings, begin: Callable[..., TrialRunner], choices: Mapping[str, str], troubles: list[str]
) -> str:
    """Begin a trial, tell of it, and decide what the wizard decides, until it is over; its id.

    `troubles`: what was wrong with its log is added.
    """
    from ...studies.protocol import ChoiceStep, SenseStep, StudyError
    from ...studies.trial_log import FINISHED, HELD, PAUSED

    changes: queue.SimpleQueue[Any] = queue.SimpleQueue()
    log_teller = _LogTeller()

    def changed(runner: TrialRunner) -> None:
        log_teller.look(runner)  # here: the command may be waiting for an answer of the wizard
        changes.put(runner)

    runner = _told(lambda: begin(listener=changed))
    condition = "" if runner.protocol.blind else f": {_words(runner.state.about['condition']) or 'no factors'}"
    click.echo(f"trial {runner.id}{', a rehearsal' if runner.state.rehearsal else ''}{condition}", err=settings.json)
    shown: set[int] = set()
    asked, pauses = None, 0
    try:
        while not runner.wait(0):
            try:
                changes.get(timeout=LOOK_PERIOD)
            except queue.Empty:  # the last change may come just before its thread ends
                continue
            _show(settings, runner, shown)
            if runner.state.status == PAUSED and runner.pauses != pauses:
                pauses = runner.pauses
                _decide(runner, "the trial was stopped", STOPPED)
                continue
            outcome = runner.outcome
            place = (outcome.path, outcome.attempt, outcome.outcome) if outcome is not None else None
            if place == asked or outcome is None:
                continue
            step = runner.step
            if runner.state.status == HELD:
                asked = place
                _decide(runner, f"a step failed: {outcome.error}", WIZARD)
            elif isinstance(step, SenseStep) and outcome.ended is None:  # the participant may have to act now
                asked = place
                click.echo(f"  {outcome.path} {outcome.text}: waiting", err=settings.json)
            elif isinstance(step, ChoiceStep):
                asked = place
                choice = _chosen(step, outcome.text, choices)
                try:
                    runner.choose(choice, "nao")
                except StudyError as error:  # its time was up, or it was stopped, while somebody was asked
                    click.echo(f"  {error}", err=True)
    except (KeyboardInterrupt, click.Abort):
        _abort(runner)
        troubles += log_teller.end(runner)
        raise CommandInterrupted("the trial is aborted") from None
    except (NaoError, click.ClickException) as error:
        _abort(runner)
        troubles += log_teller.end(runner)
        raise CommandFailed(getattr(error, "message", str(error))) from None
    _show(settings, runner, shown)
    troubles += log_teller.end(runner)
    if runner.lost:
        raise CommandFailed(f"trial {runner.id} is not in its log to the end")
    if runner.state.status != FINISHED:
        raise CommandFailed(f"trial {runner.id} is {runner.state.status}")
    return runner.id


class _LogTeller:
    """Tells of trouble with the log of a trial when it begins and is over, and of all of it again at the end.

    Also of alarms: those that were there when the trial began, and each that begins.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._failing = False
        self._over: list[str] = []
        self._alarms = 0  # that were told
        self._found_told = False

    def look(self, runner: TrialRunner) -> None:
        """Tell what is new. Any thread."""
        failing, over = runner.log.trouble, runner.state.trouble
        with self._lock:
            found = runner.state.robot.get("alarms")
            if found and not self._found_told:
                click.echo(f"  alarms as the trial began: {', '.join(found)}", err=True)
            self._found_told = found is not None
            fresh = runner.state.alarms[self._alarms :]
            self._alarms += len(fresh)
            for alarm in fresh:
                click.echo(f"  alarm: {alarm}", err=True)
            if failing and not self._failing:
                click.echo(f"  {failing}. If that lasts, the trial waits before its next step", err=True)
            self._failing = bool(failing)
            if over and over not in self._over:
                self._over.append(over)
                click.echo(f"  {over}", err=True)

    def end(self, runner: TrialRunner) -> list[str]:
        """Tell all of it; what that is."""
        self.look(runner)
        if self._over:
            click.echo("\n".join([f"trouble with the log of trial {runner.id}:", *self._over]), err=True)
        return [f"{runner.id}: {each}" for each in self._over]


def _abort(runner: TrialRunner) -> None:
    """Abort a trial, and wait until it is in its log, or somebody does not want that."""
    runner.abort("nao")
    try:
        while not runner.wait(TOLD_AFTER):
            if runner.log.trouble:
                click.echo(f"  {runner.log.trouble}; Ctrl-C loses them", err=True)
    except KeyboardInterrupt:
        runner.abort("nao")
        runner.wait()


def _show(settings: CliSettings, runner: TrialRunner, shown: set[int]) -> None:
    """Tell of steps that have ended, a `while` behind the steps in it. `shown`: numbers of those that were told."""
    outcomes = list(runner.state.outcomes)
    ended = [i for i, each in enumerate(outcomes) if each.ended is not None and i not in shown]
    shown.update(ended)
    for each in sorted((outcomes[i] for i in ended), key=lambda each: each.ended or 0.0):
        answer = f" {each.answer}" if each.answer else ""
        seconds = f" after {each.seconds:.2f} s" if each.seconds is not None and each.answer else ""
        error = f": {each.error}" if each.error else ""
        click.echo(f"  {each.path} {each.text}: {each.outcome}{answer}{seconds}{error}", err=settings.json)


def _chosen(step: Any, question: str, choices: Mapping[str, str]) -> str:
    choice = choices.get(step.label)
    if choice is not None:
        return choice
    if not _can_ask():
        label = step.label or "LABEL"
        raise CommandFailed(f"{question}: nobody can be asked; --choose {label}={step.choices[0]} does that")
    return click.prompt(question, type=click.Choice(step.choices), err=True)


def _decide(runner: TrialRunner, what: str, controls: Mapping[str, tuple[str, str]]) -> None:
    """Ask what is to be done with a trial that waits. Raises CommandFailed if nobody can be asked."""
    if not _can_ask():
        raise CommandFailed(what)
    words = ", ".join(f"{key}: {word}" for key, (word, _) in controls.items())
    key = click.prompt(f"{what}. {words}", type=click.Choice(tuple(controls)), err=True)
    getattr(runner, controls[key][1])("nao")


def _can_ask() -> bool:
    return sys.stdin.isatty()


def _words(condition: Mapping[str, str]) -> str:
    return ", ".join(f"{name}: {level}" for name, level in condition.items())


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"
