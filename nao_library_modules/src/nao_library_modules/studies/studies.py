"""Starts, resumes and aborts trials, and knows those that run."""

from __future__ import annotations

import importlib.metadata
import logging
import os
import platform
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, replace
from functools import lru_cache, partial
from typing import Any
from xml.etree import ElementTree

from naoqi.errors import NaoError

from ..core.errors import of_those
from ..core.files import FileTrouble, config_file
from ..core.waiting import Listeners
from .command_check import SERVICE
from .protocol import StudyError, StudyProtocol, WantedRecordings, filled
from .protocol_reader import hash_of
from .schedule import order_of
from .step_waits import EARS
from .study_files import StudyFiles, TrialFolder, correct_pseudonym, finished_positions, take_back
from .trial_log import ABORTED, ENDED, PATIENCE, LeftTrial, TrialLog, TrialState, read_events, write_events_table
from .trial_recordings import TrialRecordings
from .trial_runner import TrialRunner

log = logging.getLogger(__name__)

LONGEST_SETTING = 500
"""Characters of a parameter that is kept with a trial; descriptions of robots are longer."""


class Studies:
    """Studies in a folder. Its functions may be called from any thread.

    `files`: of the studies. `senses`: holds what adds touches, words and faces to the events of a robot while a trial
    runs; returns what ends that. `watch`: adds the state and the alarms of the robot to the log of a trial that
    begins; returns what ends that.
    """

    def __init__(
        self,
        files: StudyFiles,
        senses: Callable[[Any], Callable[[], None]] = lambda _: lambda: None,
        watch: Callable[[TrialRunner, TrialRecordings], Callable[[], None]] = lambda *_: lambda: None,
    ) -> None:
        self.files = files
        self._senses, self._watch = senses, watch
        self._lock = threading.Lock()  # pages take it ten times a second: never held while anything is waited for
        self._runners: dict[str, TrialRunner] = {}
        self._beginning: set[str] = set()  # namespaces of robots
        self._listeners = Listeners()

    def running(self, namespace: str) -> TrialRunner | None:
        """The trial that runs on a robot, or was the last one."""
        with self._lock:
            return self._runners.get(namespace)

    def open_trials(self) -> list[tuple[TrialFolder, TrialState]]:
        """Trials that were begun, are not over, and are not run by this program; another one may run them."""
        with self._lock:
            here = {runner.id for runner in self._runners.values() if not runner.state.over}
        found = []
        for study in self.files.studies():
            for trial in self.files.trials(study):
                state = trial.state()
                if state.status and not state.over and trial.id not in here:
                    found.append((trial, state))
        return found

    def position_of(self, protocol: StudyProtocol, pseudonym: str) -> int:
        """Which of his trials, from 1, is the next of a participant: the first that is not finished.

        Raises StudyError if all are.
        """
        finished = finished_positions(self.files, protocol.name, pseudonym)
        count = len(order_of(protocol, 1))
        position = next((i for i in range(1, count + 1) if i not in finished), 0)
        if not position:
            raise StudyError(f"{pseudonym} has done all {count} trials of {protocol.name}")
        return position

    def begin(
        self,
        protocol: StudyProtocol,
        pseudonym: str,
        robot: Any,
        by: str = "",
        position: int = 0,
        record: WantedRecordings | None = None,
        listener: Callable[[TrialRunner], None] | None = None,
        values: Mapping[str, Any] | None = None,
        stops: int | None = None,
        rehearsal: bool = False,
    ) -> TrialRunner:
        """Begin a trial.

        Args:
            protocol: Of the study.
            pseudonym: Of the participant.
            robot: The `RobotClient`.
            by: Who begins it.
            position: Which of the participant's trials, from 1; 0: the first that is not finished.
            record: What is recorded; as the protocol has it without.
            listener: Called after each event, also the first one.
            values: Those of the protocol that this trial has others of.
            stops: Of the robot when the trial was asked for; None: as many as now. A later stop holds it back.
            rehearsal: Whether it is none of the participant's trials: it uses up no number, and summaries leave it out.

        Raises:
            StudyError: It cannot begin: a trial runs on the robot, the participant is done, files cannot be written, a
                value is none of the protocol.
        """
        stops = robot.stops if stops is None else stops
        own = {**protocol.values, **(values or {})}
        for name in own:
            if name not in protocol.values:
                raise StudyError(f"{protocol.name} has no value {name!r}{of_those(name, protocol.values)}")
        with self._turn_of(robot):
            number_of = self.files.coming_number if rehearsal else self.files.number_of
            number = number_of(protocol.name, pseudonym)
            order = order_of(protocol, number)
            position = position or self.position_of(protocol, pseudonym)
            if not 1 <= position <= len(order):
                raise StudyError(f"there is no trial {position} in {protocol.name}: a participant has {len(order)}")
            condition = order[position - 1]
            wanted = protocol.record if record is None else record
            trial = self.files.new_trial(protocol.name, pseudonym)
            given = {"participant": pseudonym, "number": number, "trial": position, "trials": len(order)}
            known = {**replace(protocol, values=own).values_in(condition), **given}
            known = {name: filled(each, known) if isinstance(each, str) else each for name, each in known.items()}
            about = {
                "study": protocol.name,
                "participant": pseudonym,
                "number": number,
                "position": position,
                "condition": condition,
                "order": order,
                "seed": protocol.seed,
                "rehearsal": rehearsal,
                "protocol_sha256": hash_of(protocol.text),
                "record": _plain(asdict(wanted)),
            }
            self.files.describe(
                trial,
                {
                    **about,
                    "trial": trial.id,
                    "by": by,
                    "robot": robot.namespace,
                    "began": robot.now(),
                    "versions": versions(),
                    "values": own,
                    "settings": settings(robot.namespace),
                },
                protocol.text,
            )
            return self._start(
                protocol, trial, robot, by, {**about, "trial": trial.id, "values": known}, wanted, listener, stops
            )

    def resume(
        self,
        trial_id: str,
        robot: Any,
        by: str = "",
        listener: Callable[[TrialRunner], None] | None = None,
        stops: int | None = None,
    ) -> TrialRunner:
        """Resume a trial whose console was gone, behind the last step that had ended.

        `stops`: as for `begin`. Raises StudyError if it is over, runs elsewhere, or a trial runs on the robot.
        """
        stops = robot.stops if stops is None else stops
        with self._turn_of(robot):
            trial = self.files.trial(trial_id)
            state = trial.state()
            if state.over or not state.status:
                raise StudyError(f"trial {trial_id} is {state.status or 'empty'}: it cannot be resumed")
            record = dict(state.about.get("record", {}))
            wanted = replace(WantedRecordings(**record), bag=tuple(record.get("bag", ())))
            return self._start(trial.protocol(), trial, robot, by, state.about, wanted, listener, stops)

    def abort(self, trial_id: str, robot: Any = None, by: str = "") -> TrialState:
        """Give up a trial whose program was gone, and end the recordings that it has left; how it is then.

        `robot`: the `RobotClient`, which ends a video and sound; None: there is none. Raises StudyError if the trial is
        over, or a program runs it.
        """
        trial = self.files.trial(trial_id)
        trial_log = TrialLog(trial.path)  # nobody resumes it meanwhile
        try:
            left = LeftTrial(trial_id, trial_log, read_events(trial.path), robot)
            if left.state.over or not left.state.status:
                raise StudyError(f"trial {trial_id} is {left.state.status or 'empty'}: it cannot be aborted")
            TrialRecordings(trial.path, WantedRecordings()).end(left)
            left.tell(ENDED, f"trial {trial_id} is {ABORTED}", by, outcome=ABORTED)
        finally:
            trouble = trial_log.trouble
            lost = trial_log.close(0.0 if trouble else PATIENCE)
        self._tell()
        if lost:
            raise StudyError(f"trial {trial_id} is not aborted: {trouble}")
        write_events_table(trial.path)
        return left.state

    def correct_pseudonym(self, study: str, old: str, new: str, by: str = "", robot: Any = None) -> int:
        """As `study_files.correct_pseudonym`; pages are told."""
        number = correct_pseudonym(self.files, study, old, new, by, robot)
        self._tell()
        return number

    def take_back(self, study: str, pseudonym: str, by: str = "", robot: Any = None) -> int:
        """As `study_files.take_back`; pages are told."""
        number = take_back(self.files, study, pseudonym, by, robot)
        self._tell()
        return number

    def on_change(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Have a function called when a trial begins or is over; returns what ends that."""
        return self._listeners.add(listener)

    def _start(
        self,
        protocol: StudyProtocol,
        trial: TrialFolder,
        robot: Any,
        by: str,
        about: Mapping[str, Any],
        wanted: WantedRecordings,
        listener: Callable[[TrialRunner], None] | None,
        stops: int,
    ) -> TrialRunner:
        trial_log = TrialLog(trial.path)
        state = trial.state()  # read behind the lock of the log
        leave = [self._senses(robot)]

        def end(runner: TrialRunner) -> None:
            for each in leave:
                each()
            try:
                write_events_table(trial.path, PATIENCE)
            except FileTrouble as error:
                log.error("the table of trial %s is missing: %s", trial.id, error)
            self._tell()

        recordings = TrialRecordings(trial.path, wanted)
        runner = TrialRunner(
            *(protocol, robot, trial_log, state, about, ros_after),
            recordings,
            end,
            stops,
            lru_cache(maxsize=None)(partial(behavior_speaks, robot)),
        )
        if listener is not None:
            runner.on_change(listener)
        leave.append(self._watch(runner, recordings))
        runner.start(by)
        with self._lock:
            self._runners[robot.namespace] = runner  # not before it has begun: pages show whose trial it is
        self._tell()
        return runner

    @contextmanager
    def _turn_of(self, robot: Any) -> Iterator[None]:
        """Keep a robot for a trial that begins. Raises StudyError if another one begins, or runs."""
        with self._lock:
            runner = self._runners.get(robot.namespace)
            if runner is not None and not runner.wait(0):
                raise StudyError(f"trial {runner.id} runs on this robot: it has to be over before")
            if robot.namespace in self._beginning:
                raise StudyError("a trial is about to begin on this robot: wait until it runs, or has failed to")
            self._beginning.add(robot.namespace)
        try:
            yield
        finally:
            with self._lock:
                self._beginning.discard(robot.namespace)

    def _tell(self) -> None:
        for listener in self._listeners:
            listener()


def ros_after(seconds: float, callback: Callable[[], None]) -> Callable[[], None]:
    """Have a function called once after so many s of ROS time; returns what prevents that."""
    import rospy

    timer = rospy.Timer(rospy.Duration.from_sec(seconds), lambda _: callback(), oneshot=True)
    return timer.shutdown


def behavior_speaks(robot: Any, name: str) -> bool:
    """Whether a stored behaviour speaks or listens; also where nobody knows. `robot`: a `RobotClient`."""
    from nao_library_msgs.srv import ListBehaviors

    try:
        behaviors = robot.call(SERVICE, ListBehaviors).behaviors
    except NaoError:
        return True
    return any(each.name == name and {*each.servers} & {*EARS} for each in behaviors)


def versions() -> dict[str, str]:
    """Of what a trial runs with."""
    package = ElementTree.parse(config_file("limits.json").parents[1] / "package.xml").findtext("version", "")
    found = {"nao_library": package, "python": platform.python_version(), "system": platform.platform()}
    for name in ("nicegui", "rospy"):
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return {**found, "ros": os.environ.get("ROS_DISTRO", "")}


def settings(namespace: str) -> dict[str, Any]:
    """Parameters of the master below a namespace, but for long texts."""
    import rospy

    try:
        found = rospy.get_param(namespace)
    except Exception as error:  # rospy raises socket.error, ROSException, KeyError
        return {"error": str(error)}
    return _short(found) if isinstance(found, dict) else {}


def _short(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(name): _short(each) for name, each in value.items()}
    if isinstance(value, list):
        return [_short(each) for each in value][:LONGEST_SETTING]
    text = str(value)
    if len(text) > LONGEST_SETTING:
        return f"{text[:40]}... ({len(text)} characters)"
    return value if isinstance(value, (bool, int, float, str)) else text


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    return [_plain(each) for each in value] if isinstance(value, (list, tuple)) else value
