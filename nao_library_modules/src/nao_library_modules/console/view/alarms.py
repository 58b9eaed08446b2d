"""Alarms: what must not happen unseen while a study runs, and what to do then. Pure.

Each alarm is one `Rule` of `RULES`, with its limit and the reason for it. Nothing here knows ROS or a clock: who looks
gives the times.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

LOWEST_BATTERY, BATTERY_MARGIN = 20.0, 2.0
"""Percent: of the 60 to 90 minutes of a full battery 12 to 18 are left, enough to end a trial. The driver warns from 30
on, while nothing has to be done yet. So much more ends the alarm, for charges flicker."""
SILENCE = 2.0
"""s without an answer: servers tell of the robot once a second, and their clients see its end within 2."""
PATIENCE = 10.0
"""s that a driver has to tell of itself for the first time."""
LATE = 1.5
"""Periods of a report, after which what it told is old: one may come late."""
LOST = 3.0
"""Periods after which the reports count as ended."""
SLOWEST, SPEED_MARGIN, SLOW_FOR = 0.95, 0.02, 3.0
"""Share of the asked speed: speech, sound and waits of a trial take longer by as much as time is slower, and what is
recorded gets shorter. It has to last so many s: a picture that is drawn takes a moment."""
LEAST_DISK, DISK_MARGIN = 10**9, 10**8
"""Bytes: ten minutes of a rosbag with compressed pictures, so that the trial that runs can end."""


@dataclass(frozen=True)
class Facts:
    """What is known of a robot at one time. None, or not a number: not known.

    Attributes:
        now: s of this computer, monotonic.
        watched: s since somebody began to look.
        connection: State, of nao_library_msgs/ConnectionState; empty until it is told.
        silence: s since the robot's last answer.
        report_age, report_period: Of the reports of the body, s.
        charge: Percent; `charging`: whether it rises.
        hot: Joints that the driver calls hot, or too hot.
        limp: Whether no motor holds; `should_stand`: it stood, and has not been laid, seated or crouched since.
        speed: Simulated seconds per second: asked (infinite: as fast as possible), reached.
        stopped: Recording of the trial that has stopped by itself -> why.
        log: Why the log of the trial cannot be written.
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
    """When there is an alarm.

    Attributes:
        holds: Whether it is so, by the facts and whether the alarm goes on; None: nobody knows.
        what: For people; the same words as long as it is the same alarm.
        action: What to do.
        lasting: s for which it has to hold.
    """

    code: str
    holds: Callable[[Facts, bool], bool | None]
    what: Callable[[Facts], str]
    action: str
    lasting: float = 0.0


@dataclass(frozen=True)
class Alarm:
    """One that goes on.

    Attributes:
        since: Time of this computer, s since 1970.
        found: It was so when somebody began to look: it may have begun before.
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
        return "No driver tells of the robot"
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
        "Pause the trial. Look at the robot's cable or Wi-Fi, and at its driver, which connects again by itself.",
    ),
    Rule(
        "old_reports",
        lambda facts, _: None if facts.report_age is None else facts.report_age > LOST * facts.report_period,
        lambda _: "The driver tells nothing of battery, heat and motors any more",
        "Do not rely on what the pages show of the robot. Look whether the driver runs, and start it again.",
    ),
    Rule(
        "battery",
        _low,
        lambda _: f"The battery is below {LOWEST_BATTERY:g} %",
        "Plug in the charger, at the latest behind this trial.",
    ),
    Rule(
        "hot_joint",
        lambda facts, _: None if facts.hot is None else bool(facts.hot),
        lambda facts: f"Too warm: {', '.join(facts.hot or ())}",
        "Have the robot rest behind this step, until the joint is cooler: a motor that gets too hot goes limp.",
    ),
    *(
        _recorder(kind, f"Write down when. From now on the {kind} has nothing: abort the trial if it needs that.")
        for kind in ("bag", "video", "sound")
    ),
    Rule(
        "log",
        lambda facts, _: bool(facts.log),
        lambda _: "The log of the trial cannot be written",
        "Make room on the disk. The trial waits before its next step, and goes on by itself.",
    ),
    Rule(
        "disk",
        lambda facts, active: None if facts.free is None else facts.free < LEAST_DISK + DISK_MARGIN * active,
        lambda _: f"The disk of the studies has less than {LEAST_DISK / 1e9:g} GB left",
        "Make room on the disk before the next trial, and record no video until then.",
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
    """The alarms that go on. One thread looks; any thread may read `alarms`, which is replaced as a whole."""

    def __init__(self) -> None:
        self.alarms: tuple[Alarm, ...] = ()
        self.looked = False  # at least once
        self._since: dict[str, tuple[float, float]] = {}  # of what holds: monotonic, and since 1970
        self._was_well: set[str] = set()

    def look(self, facts: Facts, wall: float) -> tuple[list[Alarm], list[Alarm]]:
        """Alarms that have begun and that have ended by now. `wall`: s since 1970.

        One that was so at the first look has not begun; what is not known changes nothing.
        """
        self.looked = True
        going = {alarm.code: alarm for alarm in self.alarms}
        begun, ended = [], []
        for rule in RULES:
            holds = rule.holds(facts, rule.code in going)
            if holds is None:
                continue
            if not holds:
                self._since.pop(rule.code, None)
                self._was_well.add(rule.code)
                if rule.code in going:
                    ended.append(going.pop(rule.code))
                continue
            began, since = self._since.setdefault(rule.code, (facts.now, wall))
            before = going.get(rule.code)
            if before is None and facts.now - began < rule.lasting:
                continue
            found = before.found if before else rule.code not in self._was_well and not rule.lasting
            alarm = going[rule.code] = Alarm(rule.code, rule.what(facts), rule.action, since, found)
            if before is None and not found:
                begun.append(alarm)
        self.alarms = tuple(going[code] for code in CODES if code in going)
        return begun, ended
