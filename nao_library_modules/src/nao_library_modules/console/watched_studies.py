"""Studies whose logs have what robots sense, alarms, and stops of other programs; with a console or without one.

The state of the robot at the begin of a trial is in its log as well.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..studies.robot_events import STATE
from ..studies.studies import Studies
from ..studies.study_files import StudyFiles
from ..studies.trial_runner import TrialRunner
from .view.alarms import AlarmWatch, TrialFacts
from .view.robot_state import ServerRecordings, state_of, state_text

if TYPE_CHECKING:
    from .view.live_view import Views


PATIENCE = 5.0
"""s of this computer for which the entry waits for the whole state; what is still unknown then is empty."""


class TrialWatch:
    """Adds one event with the state of the robot and the active alarms when a trial begins or is resumed.

    Later begins and ends of alarms are events of the robot, and so in the log by themselves.

    Args:
        runner: Not started yet.
        watch: Of its robot.
        recordings: Its `TrialRecordings`.
        clock: s of this computer.
    """

    def __init__(
        self, runner: TrialRunner, watch: AlarmWatch, recordings: Any, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._runner, self._watch, self._recordings, self._clock = runner, watch, recordings, clock
        self._lock = threading.Lock()
        self._until: float | None = None  # deadline of the entry; None: the trial has not begun
        self._written = False
        self._logged: set[str] = set()  # codes of the alarms in these entries
        self._ends: list[Callable[[], None]] = []

    def begin(self) -> None:
        """Watch from now on; the entry follows the first event of the trial."""
        self._ends = [
            self._runner.on_change(self._trial_changed),
            self._watch.follow(self._facts, self._looked),
            self._watch.acquire(),
        ]

    def end(self) -> None:
        for end in self._ends:
            end()

    def _trial_changed(self, _: TrialRunner) -> None:
        if self._until is None and self._runner.state.status:
            self._until = self._clock() + PATIENCE
            self._looked()

    def _looked(self) -> None:
        """Add the entry as soon as the state is known, and later a further one for alarms that were found late."""
        with self._lock:
            if self._until is None or not (self._written or self._watch.complete or self._clock() > self._until):
                return
            first, self._written = not self._written, True
            found = [alarm for alarm in self._watch.alarms if first or alarm.found]
            late = [alarm for alarm in found if alarm.code not in self._logged]
            self._logged.update(alarm.code for alarm in found)
        state = state_of(self._watch.body)
        if first:
            codes = [alarm.code for alarm in found]
            text = "; ".join([state_text(state), *(alarm.what for alarm in found)])
            self._runner.robot.events.add(STATE, text, trial=self._runner.id, **state, alarms=codes)
        elif late:
            text = "; ".join(alarm.what for alarm in late)
            self._runner.robot.events.add(STATE, text, trial=self._runner.id, alarms=[alarm.code for alarm in late])

    def _facts(self, recordings: Mapping[str, ServerRecordings], now: float) -> TrialFacts:
        runner = self._runner
        if runner.state.over:
            return TrialFacts()
        stopped = self._recordings.stopped(dict(runner.state.recordings), recordings, now)
        return TrialFacts(stopped, runner.log.trouble)


def watch_trial(watch: AlarmWatch, runner: TrialRunner, recordings: Any) -> Callable[[], None]:
    """Have the state and the alarms of a robot in the log of a trial; returns what ends that."""
    watching = TrialWatch(runner, watch, recordings)
    watching.begin()
    return watching.end


def studies_alone(files: StudyFiles, name: str = "") -> tuple[Studies, Any]:
    """Studies and the `RobotClient` of a robot. The program is a node already.

    `name`: of the robot; empty: the first. Raises NotThere if there is none.
    """
    from .robots.robot_client import Robots
    from .view.live_view import Views

    views = Views(files.folder)
    return studies_of(files, views), Robots().robot(name)


def studies_of(files: StudyFiles, views: Views) -> Studies:
    """Studies that log what robots sense, stops of other programs and alarms."""
    from .robots.robot_goals import hear_stops

    def listen(robot: Any) -> Callable[[], None]:
        deaf, leave = hear_stops(robot), views.of(robot).senses.acquire()

        def end() -> None:
            deaf()
            leave()

        return end

    def watch(runner: TrialRunner, recordings: Any) -> Callable[[], None]:
        return watch_trial(views.of(runner.robot).alarms, runner, recordings)

    return Studies(files, listen, watch)
