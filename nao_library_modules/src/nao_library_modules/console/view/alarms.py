"""Alarms: what the operator of a study has to notice, since when, and what to do. Pure.

Each alarm is a `Rule` in `RULES`; the limits and their reasons stand above it. Times are arguments.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from .body_watch import SILENCE

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
        _recorder(kind, f"Note the time. The {kind} lacks what comes from now on: abort the trial if you need it.")
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
