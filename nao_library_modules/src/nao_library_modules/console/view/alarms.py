"""Alarms: what the operator of a study has to notice, since when, and what to do.

Each alarm is a `Rule` in `RULES`; the limits and their reasons stand above it. `AlarmWatch` evaluates them once a
second while a page is open or a trial runs.
"""

from __future__ import annotations

import logging
import math
import shutil
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...studies.robot_events import ALARM
from .background import Takers
from .robot_state import SILENCE, BodyWatch, ServerRecordings

LOWEST_BATTERY, BATTERY_MARGIN = 20.0, 2.0
"""Percent: of the 60 to 90 minutes of a full battery 12 to 18 are left, enough to end a trial. The driver warns from 30
on, while nothing has to be done yet. So much more ends the alarm, for charges flicker."""
PATIENCE = 10.0
"""s for the first report of a driver."""
LOST = 3.0
"""Periods after which the reports count as ended."""
SLOWEST, SPEED_MARGIN, SLOW_FOR = 0.95, 0.02, 3.0
"""Share of the asked speed: speech, sound and waits of a trial take longer by as much as time is slower, and what is
recorded gets shorter. It has to last so many s: a picture that is drawn takes a moment."""
LEAST_DISK, DISK_MARGIN = 10**9, 10**8
"""Bytes: ten minutes of a rosbag with compressed pictures, so that the trial that runs can end."""


@dataclass(frozen=True)
class Facts:
    """The inputs of the rules at one time. None, or not a number: not known.

    Attributes:
        now: s of this computer, monotonic.
        watched: s since the watch began.
        connection: State, of nao_library_msgs/ConnectionState; empty before the first message.
        silence: s since the robot's last answer.
        report_age, report_period: Of the reports of the body, s.
        charge: Of the battery, percent; `charging`: whether it is being charged.
        hot: Joints that the driver calls hot, or too hot.
        limp: Whether all joints are limp; `should_stand`: its last posture but for lying and unknown ones was standing.
        speed: Simulated seconds per second: asked (infinite: as fast as possible), reached.
        stopped: Recording of the trial that has ended unasked -> reason.
        log: Why the log of the trial cannot be written; empty: it can.
        free: Bytes on the disk of the studies.
    """

    now: float
    watched: float = 0.0
    connection: str = ""
    silence: float | None = None
    report_age: float | None = None
    report_period: float = 1.0
    charge: float = math.nan
    charging: bool = False
    hot: tuple[str, ...] | None = None
    limp: bool | None = None
    should_stand: bool = False
    fallen: bool | None = None
    speed: tuple[float, float] | None = None
    stopped: Mapping[str, str] = field(default_factory=dict)
    log: str = ""
    free: int | None = None


@dataclass(frozen=True)
class Rule:
    """The condition and the texts of one alarm.

    Attributes:
        holds: Whether the condition holds, from the facts and whether the alarm is active; None: not known.
        what: What is wrong; the same text while the alarm lasts, so that a screen reader reads it once.
        action: What to do.
        lasting: s for which the condition has to hold.
    """

    code: str
    holds: Callable[[Facts, bool], bool | None]
    what: Callable[[Facts], str]
    action: str
    lasting: float = 0.0


@dataclass(frozen=True)
class Alarm:
    """An active alarm.

    Attributes:
        since: Time of this computer, s since 1970.
        found: The condition held at the first look: the alarm may be older.
    """

    code: str
    what: str
    action: str
    since: float
    found: bool


def _connection(facts: Facts, active: bool) -> bool | None:
    if facts.connection:
        return facts.connection in ("lost", "closed", "connecting") or (facts.silence or 0.0) > SILENCE
    return True if facts.watched > PATIENCE else None


def _connection_text(facts: Facts) -> str:
    if not facts.connection:
        return "No driver reports the robot"
    if facts.connection in ("connected", "silent"):
        return f"The robot has not answered for more than {SILENCE:g} s"
    return f"The connection to the robot is {facts.connection}"


def _slow(facts: Facts, active: bool) -> bool:
    asked, reached = facts.speed or (math.inf, 0.0)  # without a simulator, or while its time stands still
    return math.isfinite(asked) and reached < (SLOWEST + SPEED_MARGIN * active) * asked


def _low(facts: Facts, active: bool) -> bool | None:
    if math.isnan(facts.charge):
        return None
    return not facts.charging and facts.charge < LOWEST_BATTERY + BATTERY_MARGIN * active


def _recorder(kind: str, action: str) -> Rule:
    return Rule(
        f"recorder_{kind}",
        lambda facts, _: kind in facts.stopped,
        lambda facts: f"The recording of the {kind} has stopped: {facts.stopped.get(kind, '')}",
        action,
    )


RULES: Sequence[Rule] = (
    Rule(
        "fallen",
        lambda facts, _: facts.fallen,
        lambda _: "The robot has fallen",
        "Pause the trial. Lift the robot at its torso and set it down crouching, then have it stand up.",
    ),
    Rule(
        "limp",
        lambda facts, _: None if facts.limp is None else facts.limp and facts.should_stand,
        lambda _: "The robot is limp and should stand",
        "Hold the robot. Set it down crouching, then have it stand up.",
    ),
    Rule(
        "connection",
        _connection,
        _connection_text,
        "Pause the trial. Check the robot's cable or Wi-Fi and its driver, which reconnects by itself.",
    ),
    Rule(
        "old_reports",
        lambda facts, _: None if facts.report_age is None else facts.report_age > LOST * facts.report_period,
        lambda _: "The driver no longer reports battery, heat and motors",
        "Do not rely on the values of the robot. Check that the driver runs, or start it again.",
    ),
    Rule(
        "battery",
        _low,
        lambda _: f"The battery is below {LOWEST_BATTERY:g} %",
        "Plug in the charger, after this trial at the latest.",
    ),
    Rule(
        "hot_joint",
        lambda facts, _: None if facts.hot is None else bool(facts.hot),
        lambda facts: f"Hot joints: {', '.join(facts.hot or ())}",
        "Have the robot rest after this step until they are cooler: a motor that gets too hot goes limp.",
    ),
    *(
        _recorder(kind, f"Note the time. The {kind} has a gap, or ends here: abort the trial if you need it.")
        for kind in ("bag", "video", "sound")
    ),
    Rule(
        "log",
        lambda facts, _: bool(facts.log),
        lambda _: "The log of the trial cannot be written",
        "Free disk space. The trial waits before its next step, and continues by itself.",
    ),
    Rule(
        "disk",
        lambda facts, active: None if facts.free is None else facts.free < LEAST_DISK + DISK_MARGIN * active,
        lambda _: f"The disk of the studies has less than {LEAST_DISK / 1e9:g} GB left",
        "Free disk space before the next trial, and record no video until then.",
    ),
    Rule(
        "slow_simulation",
        _slow,
        lambda _: "The simulation is slower than asked",
        "Close other programs, or ask for a lower speed: speech, sound and waits take longer than they should.",
        SLOW_FOR,
    ),
)
CODES = tuple(rule.code for rule in RULES)


class AlarmBook:
    """The active alarms. One thread calls `look`; any thread may read `alarms`, which is replaced as a whole."""

    def __init__(self) -> None:
        self.alarms: tuple[Alarm, ...] = ()
        self.looked = False  # at least once
        self._since: dict[str, tuple[float, float]] = {}  # of what holds: monotonic, and since 1970
        self._was_well: set[str] = set()

    def look(self, facts: Facts, wall: float) -> tuple[list[Alarm], list[Alarm]]:
        """Evaluate the rules; alarms that begin and alarms that end. `wall`: s since 1970.

        What holds at the first look is active and has not begun. An unknown condition changes nothing.
        """
        self.looked = True
        active = {alarm.code: alarm for alarm in self.alarms}
        begun, ended = [], []
        for rule in RULES:
            holds = rule.holds(facts, rule.code in active)
            if holds is None:
                continue
            if not holds:
                self._since.pop(rule.code, None)
                self._was_well.add(rule.code)
                if rule.code in active:
                    ended.append(active.pop(rule.code))
                continue
            began, since = self._since.setdefault(rule.code, (facts.now, wall))
            before = active.get(rule.code)
            if before is None and facts.now - began < rule.lasting:
                continue
            found = before.found if before else rule.code not in self._was_well and not rule.lasting
            alarm = active[rule.code] = Alarm(rule.code, rule.what(facts), rule.action, since, found)
            if before is None and not found:
                begun.append(alarm)
        self.alarms = tuple(active[code] for code in CODES if code in active)
        return begun, ended


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
