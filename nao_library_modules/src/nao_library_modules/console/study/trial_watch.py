"""State and alarms of the robot in the log of a trial."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from ..robots.events import STATE
from ..view.alarm_watch import AlarmWatch, TrialFacts
from ..view.body_watch import state_of, state_text
from ..view.diagnosis import ServerRecordings
from .runner import TrialRunner

PATIENCE = 5.0
"""s of this computer for which the log waits for the whole state: what is not known then is empty in it."""


class TrialWatch:
    """Writes how the robot is when a trial begins, or is resumed: one event. The alarms are events of the robot.

    What was so before the trial is in that event and has not happened in the trial.

    Args:
        runner: Not started yet.
        watch: Of its robot.
        recordings: `TrialRecordings`, which tells what of them has stopped.
        clock: s of this computer.
    """

    def __init__(
        self, runner: TrialRunner, watch: AlarmWatch, recordings: Any, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._runner, self._watch, self._recordings, self._clock = runner, watch, recordings, clock
        self._lock = threading.Lock()
        self._until: float | None = None  # the trial has begun, and its state is to be written by then
        self._written = False
        self._told: set[str] = set()  # codes of alarms that are in the log
        self._ends: list[Callable[[], None]] = []

    def begin(self) -> None:
        """Look from now on; the state is written behind the first event of the trial."""
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
        """Write the state once it is known, and later each alarm that was so at the begin and is known only then."""
        with self._lock:
            if self._until is None or not (self._written or self._watch.complete or self._clock() > self._until):
                return
            first, self._written = not self._written, True
            found = [alarm for alarm in self._watch.alarms if first or alarm.found]
            late = [alarm for alarm in found if alarm.code not in self._told]
            self._told.update(alarm.code for alarm in found)
        state = state_of(self._watch.body)
        if first:
            codes = [alarm.code for alarm in found]
            text = "; ".join([state_text(state), *(alarm.what for alarm in found)])
            self._runner.robot.events.add(STATE, text, trial=self._runner.id, **state, alarms=codes)
        elif late:
            text = "; ".join(alarm.what for alarm in late)
            self._runner.robot.events.add(STATE, text, trial=self._runner.id, alarms=[alarm.code for alarm in late])

    def _facts(self, recorded: Mapping[str, ServerRecordings], now: float) -> TrialFacts:
        runner = self._runner
        if runner.state.over:
            return TrialFacts()
        stopped = self._recordings.stopped(dict(runner.state.recordings), recorded, now)
        return TrialFacts(stopped, runner.log.trouble)
