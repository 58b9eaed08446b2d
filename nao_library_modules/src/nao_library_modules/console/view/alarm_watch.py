"""The alarms of one robot, evaluated twice a second while a page is open or a trial runs."""

from __future__ import annotations

import logging
import shutil
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..robots.events import ALARM
from .alarms import Alarm, AlarmBook, Facts
from .background import Takers
from .body_watch import BodyWatch
from .diagnosis import ServerRecordings

log = logging.getLogger(__name__)

PERIOD = 0.5
"""s of this computer between two evaluations."""
REPORT_PERIOD = 1.0
"""s between two reports of the simulator."""
BEGAN, ENDED = "began", "ended"
"""What events of an alarm have as `what`."""


@dataclass(frozen=True)
class TrialFacts:
    """What a trial adds to the facts of its robot."""

    stopped: Mapping[str, str] = field(default_factory=dict)  # recording that has ended unasked -> reason
    log: str = ""  # why its log cannot be written; empty: it can


TrialSource = Callable[[Mapping[str, ServerRecordings], float], TrialFacts]
"""Gets the recordings of the servers, and the time by the clock of the watch."""


class AlarmWatch:
    """Any thread. Each begin and end of an alarm is an event of the robot, of kind `ALARM`.

    Args:
        robot: The `RobotClient`.
        body: Its state.
        folder: Of the studies.

    Attributes:
        acquire: Watches until the returned function is called.
    """

    def __init__(self, robot: Any, body: BodyWatch, folder: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self.robot, self.body = robot, body
        self._folder, self._clock = folder, clock
        self.acquire = Takers(self._begin, self._end).acquire
        self._lock = threading.Lock()
        self._trials: dict[object, tuple[TrialSource, Callable[[], None]]] = {}
        self._book, self._began = AlarmBook(), 0.0
        self._over = threading.Event()
        self._leave: Callable[[], None] = lambda: None

    @property
    def alarms(self) -> tuple[Alarm, ...]:
        """The active ones."""
        return self._book.alarms

    @property
    def complete(self) -> bool:
        """Whether each state of the robot is known, and the alarms."""
        return self._book.looked and self.body.complete

    def follow(self, source: TrialSource, listener: Callable[[], None]) -> Callable[[], None]:
        """Watch a trial as well, until the returned function is called. `listener`: called after each look."""
        key = object()
        with self._lock:
            self._trials[key] = (source, listener)

        def end() -> None:
            with self._lock:
                self._trials.pop(key, None)

        return end

    def look(self) -> None:
        """Evaluate the alarms once, in the thread of the watch."""
        with self._lock:
            trials = list(self._trials.values())
        begun, ended = self._book.look(self._facts([source for source, _ in trials]), time.time())
        for alarm in begun:
            self._add_event(alarm, BEGAN, alarm.what)
        for alarm in ended:
            self._add_event(alarm, ENDED, f"ended: {alarm.what}")
        for _, listener in trials:
            listener()

    def _add_event(self, alarm: Alarm, what: str, text: str) -> None:
        self.robot.events.add(ALARM, text, what=what, code=alarm.code, since=round(alarm.since, 3))

    def _facts(self, sources: list[TrialSource]) -> Facts:
        body, now = self.body, self._clock()
        status, stance, diagnosis = body.status, body.stance, body.diagnosis
        trials = [source(diagnosis.recordings, now) for source in sources]
        reported = body.report_age is not None
        speed = diagnosis.speed
        return Facts(
            now=now,
            watched=now - self._began,
            connection=body.connection,
            silence=body.silence,
            report_age=body.report_age,
            report_period=body.report_period,
            charge=status.battery,
            charging=status.charging,
            hot=status.hot if reported else None,
            limp=status.limp,
            should_stand=stance.stood and not stance.lies,
            fallen=stance.fallen if stance.family or stance.fallen else None,
            speed=None if speed is None or now - speed.heard > 3.0 * REPORT_PERIOD else (speed.asked, speed.reached),
            stopped={kind: why for trial in trials for kind, why in trial.stopped.items()},
            log=next((trial.log for trial in trials if trial.log), ""),
            free=free_bytes(self._folder),
        )

    def _begin(self) -> None:
        self._book, self._began, self._over = AlarmBook(), self._clock(), threading.Event()
        self._leave = self.body.acquire()
        threading.Thread(target=self._run, args=(self._over,), name=f"alarms of {self.robot.name}", daemon=True).start()

    def _end(self) -> None:
        self._over.set()
        self._leave()
        self._book = AlarmBook()

    def _run(self, over: threading.Event) -> None:
        while not over.wait(PERIOD):
            try:
                self.look()
            except Exception:  # the next look may succeed
                log.exception("the alarms of %s could not be evaluated", self.robot.name)


def free_bytes(folder: Path) -> int | None:
    """Free bytes on the disk of a folder that may not exist yet; None if not known."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    try:
        return shutil.disk_usage(folder).free
    except OSError:
        return None
