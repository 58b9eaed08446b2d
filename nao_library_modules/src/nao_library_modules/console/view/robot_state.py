"""The state of a robot: battery, heat, stiffness, connection, posture, falls, recordings. Events are in `senses`.

Functions that take times get them as arguments, s of this computer.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from ...core.health import BATTERY_FLAGS, RECORDINGS, SILENT_FOR, STARTED
from ...core.nao_facts import CHARGING_BIT
from .background import Subscriptions, Takers
from .senses import CONNECTED, TEXT, Latched, MemoryTopics, Perception, felt

JOINT, BATTERY, HEAD = "nao_joint: ", "nao_power: Battery", "nao_cpu: Head Temperature"
CHARGING = BATTERY_FLAGS[CHARGING_BIT]
OK, WARN, ERROR, STALE = range(4)
"""Levels of diagnostic_msgs/DiagnosticStatus."""
LIMP, STIFF = 0.01, 0.99
"""Mean stiffness below and above which a robot is limp, or stiff."""
HOTTEST = 3


@dataclass(frozen=True)
class JointStatus:
    """One joint.

    Attributes:
        temperature: degC; not a number where it has no sensor.
        stiffness: 0..1; not a number where it is not known.
        level: Of its diagnostics.
    """

    temperature: float
    stiffness: float
    level: int


@dataclass(frozen=True)
class BodyStatus:
    """The body as last reported.

    Attributes:
        battery: Percent; not a number until it is told.
        battery_text: As the driver says it.
        charging: Whether the battery is charged.
        battery_level, head_level: Of the diagnostics.
        head: Of the processor, degC; not a number until it is told.
        stale: The robot cannot be reached: all this is old.
    """

    battery: float = math.nan
    battery_text: str = ""
    battery_level: int = OK
    charging: bool = False
    head: float = math.nan
    head_level: int = OK
    joints: Mapping[str, JointStatus] = field(default_factory=dict)
    stale: bool = False

    @property
    def stiffness(self) -> float:
        """Mean over the joints, 0..1; not a number while none is known."""
        known = [joint.stiffness for joint in self.joints.values() if math.isfinite(joint.stiffness)]
        return math.fsum(known) / len(known) if known else math.nan

    @property
    def limp(self) -> bool | None:
        """Whether no motor holds; None while that is not known."""
        return self.stiffness < LIMP if math.isfinite(self.stiffness) else None

    @property
    def hot(self) -> tuple[str, ...]:
        """Joints that are hot by the limits of the driver (its `~warning_threshold`), in the order of their names."""
        return tuple(sorted(name for name, joint in self.joints.items() if joint.level > OK))

    @property
    def stiffness_text(self) -> str:
        mean = self.stiffness
        if not math.isfinite(mean):
            return "unknown"
        word = "limp" if self.limp else "stiff" if mean > STIFF else "partly stiff"
        return f"{word} ({100 * mean:.0f} %)"

    @property
    def hottest(self) -> list[tuple[str, float]]:
        """The warmest motors, the warmest first: joint and degC."""
        known = [(name, joint.temperature) for name, joint in self.joints.items() if math.isfinite(joint.temperature)]
        return sorted(known, key=lambda pair: -pair[1])[:HOTTEST]

    @property
    def heat_level(self) -> int:
        return max([self.head_level, *(joint.level for joint in self.joints.values())])


def read_status(statuses: Iterable[Any], namespace: str, before: BodyStatus) -> BodyStatus:
    """The body after a message of /diagnostics, which may be of another robot or of other things.

    `statuses`: of the message. `namespace`: of the robot, "/" or "/nao1/". `before`: stays where the message says
    nothing.
    """
    prefix = "" if namespace == "/" else namespace
    own = {}
    for status in statuses:
        name = status.name[len(prefix) :] if status.name.startswith(prefix) else ""
        if name.startswith(JOINT) or name in (BATTERY, HEAD):
            own[name] = status
    if not own:
        return before
    joints = {
        name[len(JOINT) :]: JointStatus(_value(status, "Temperature"), _value(status, "Stiffness"), _level(status))
        for name, status in own.items()
        if name.startswith(JOINT)
    }
    battery, head = own.get(BATTERY), own.get(HEAD)
    return BodyStatus(
        before.battery if battery is None else _value(battery, "Percentage"),
        before.battery_text if battery is None else battery.message,
        before.battery_level if battery is None else _level(battery),
        before.charging if battery is None else _text(battery, CHARGING) == str(True),
        before.head if head is None else _value(head, "CPU Temperature"),
        before.head_level if head is None else _level(head),
        {**before.joints, **joints},
        any(status.level == STALE for status in own.values()),
    )


def _level(status: Any) -> int:
    """Old values are as they were: their level is not a heat."""
    level = int(status.level[0]) if isinstance(status.level, bytes) else int(status.level)
    return OK if level == STALE else level


def _value(status: Any, key: str) -> float:
    try:
        return float(_text(status, key))
    except ValueError:
        return math.nan


def _text(status: Any, key: str) -> str:
    """A value of a report; empty where it has none."""
    return next((pair.value for pair in status.values if pair.key == key), "")


SIMULATION, ASKED, REACHED = "nao_sim: Simulation", "speed asked", "speed reached"
"""Report of the simulator, and its values: simulated seconds per second of the computer."""


@dataclass(frozen=True)
class SimulatedSpeed:
    """Simulated seconds per second of the computer that runs the simulator."""

    asked: float  # infinite: as fast as possible
    reached: float
    heard: float  # time of the report


@dataclass(frozen=True)
class ServerRecordings:
    """The recordings of one server."""

    names: frozenset[str]
    heard: float  # time of the report
    started: str = ""  # when the server was started, as it says; another one: it was started again


class Diagnosis:
    """The newest reports.

    Attributes:
        answered: Time of the robot's last answer; None before the first report.
        speed: None without a simulator, and while its time stands still.
        recordings: Name of a server -> its recordings.
    """

    def __init__(self) -> None:
        self._answered: dict[str, float] = {}  # name of a report -> last answer, as the newest of that name has it
        self.speed: SimulatedSpeed | None = None
        self.recordings: Mapping[str, ServerRecordings] = {}

    @property
    def answered(self) -> float | None:
        return max(self._answered.values(), default=None)

    def take(self, statuses: Iterable[Any], address: str, now: float) -> None:
        """Take the reports of a message. `address`: of the robot, `ip:port`; empty: not known."""
        for status in statuses:
            values = {pair.key: pair.value for pair in status.values}
            if status.name == SIMULATION:
                asked, reached = _number(values.get(ASKED)), _number(values.get(REACHED))
                known = not (math.isnan(asked) or math.isnan(reached))
                self.speed = SimulatedSpeed(asked, reached, now) if known else None
            if not address or status.hardware_id != address:
                continue
            silent = _number(values.get(SILENT_FOR))
            if not math.isnan(silent) and values.get("state") in ("connected", "silent"):
                # One that has waited in vain takes back what it has reported before.
                self._answered = {**self._answered, status.name: now - silent}
            if RECORDINGS in values:
                server = status.name.rpartition(": ")[2].rpartition(" ")[0]
                running = ServerRecordings(frozenset(json.loads(values[RECORDINGS])), now, values.get(STARTED, ""))
                self.recordings = {**self.recordings, server: running}


def _number(text: Any) -> float:
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


STANDING, LYING, UNKNOWN = "Standing", "Lying", "Unknown"
"""Families of postures; those of a robot that lies begin with `LYING`."""


class Stance:
    """How a robot stands or lies.

    Attributes:
        family: Of its posture; empty while it is not known.
        fallen: It has fallen and has not stood or sat since.
        stood: The last family that was neither lying nor unknown was `STANDING`.
    """

    def __init__(self) -> None:
        self.family = ""
        self.fallen = self.stood = False
        self._had_fallen = False  # at some time; whether it has got up since is not known yet

    @property
    def lies(self) -> bool:
        return self.family.startswith(LYING)

    def fell(self, news: bool) -> None:
        """The robot's memory reports a fall. `news`: a new one; otherwise the value that an older one has left."""
        if news:
            self.fallen = True
        elif self.family in ("", UNKNOWN):
            self._had_fallen = True
        else:
            self.fallen = self.fallen or self.lies

    def forget_family(self) -> None:
        """The robot is lost; posture and last fall arrive in any order when it is reconnected."""
        self.family, self._had_fallen = "", False

    def take(self, family: str) -> None:
        """The family of its posture."""
        self.family = family
        if self.lies:
            self.fallen = self.fallen or self._had_fallen
        elif family != UNKNOWN:
            self.fallen, self.stood = False, family == STANDING
        else:
            return
        self._had_fallen = False


POSTURE, FAMILY, FALLEN = "PostureChanged", "PostureFamilyChanged", "robotHasFallen"
REPORT_PERIOD = 2.0
"""s between two reports of the body, as the driver has it without a setting."""
SILENCE = 2.0
"""s without an answer: servers report the connection once a second."""
LATE = 1.5
"""Periods after which the values of a report are old: one report may be late."""
LONGEST_PERIOD = 30.0
"""s: reports that are further apart had ended in between."""


class BodyWatch:
    """The state of one robot. Any thread. All topics here hold states: only a change is an event of the robot.

    ROS API (relative names):
        Subscribes, while acquired, `/diagnostics` (diagnostic_msgs/DiagnosticArray), `connection`
        (nao_library_msgs/ConnectionState), `foot_contact` (std_msgs/Bool), and keys of the robot's memory
        (`nao_memory/watch`): posture, posture family, last fall.

    Attributes:
        acquire: Subscribes until the returned function is called.
        status: The body; replaced at each report.
        connection: connecting, connected, silent, lost or closed; empty before the first message.
        address: Of the robot.
        problem: The last error of its connection.
        diagnosis: The reports that are not about the body.
        stance: How it stands or lies.
        report_period: s between the last two reports of the body.
    """

    def __init__(self, robot: Any, memory: MemoryTopics, clock: Callable[[], float] = time.monotonic) -> None:
        self._robot, self._memory, self._clock = robot, memory, clock
        self._subscriptions = Subscriptions(f"body of {robot.name}")
        self.acquire = Takers(self._begin, self._end).acquire
        self._contact, self._posture, self._fall = Latched(), Latched(), Latched(repeats=True, clock=clock)
        self._clear()

    @property
    def posture(self) -> str:
        """As the robot calls it; empty while it is not known."""
        return self._posture.value or ""

    @property
    def silence(self) -> float | None:
        """Seconds since the robot's last answer; None before the first report of it."""
        answered = self.diagnosis.answered
        return None if answered is None else max(0.0, self._clock() - answered)

    @property
    def report_age(self) -> float | None:
        """Seconds since the last report of the body; None before the first."""
        return None if self._reported is None else max(0.0, self._clock() - self._reported)

    @property
    def old(self) -> float | None:
        """Age of the values of the body, s, if newer ones are late or the robot was lost; else None."""
        if self._well_reported is None or self._reported is None:
            return None
        age = self._clock() - self._well_reported
        return age if self.status.stale or age > LATE * self.report_period else None

    @property
    def unheard(self) -> float | None:
        """Seconds since the robot's last answer if they are more than `SILENCE`; else None."""
        silence = self.silence
        return silence if silence is not None and silence > SILENCE else None

    @property
    def complete(self) -> bool:
        """Whether each state is known."""
        return bool(self.connection and self.posture and self.stance.family) and self._reported is not None

    def _begin(self) -> None:
        from diagnostic_msgs.msg import DiagnosticArray
        from std_msgs.msg import Bool

        from nao_library_msgs.msg import ConnectionState

        topic = self._robot.topic
        keys = ((POSTURE, self._on_posture), (FAMILY, self._on_family))
        self._subscriptions.begin(
            partial(topic, "/diagnostics", DiagnosticArray, self.take_diagnostics, queue_size=20),
            partial(topic, "connection", ConnectionState, self._on_connection),
            partial(topic, "foot_contact", Bool, self._on_contact),
            *(partial(self._memory.watch, key, TEXT, callback) for key, callback in keys),
            partial(self._memory.watch_last, FALLEN, self._fall, self._on_fall),
        )

    def _end(self) -> None:
        self._subscriptions.end()
        self._clear()

    def _clear(self) -> None:
        for each in (self._contact, self._posture, self._fall):
            each.clear()
        self.status, self.diagnosis, self.stance = BodyStatus(), Diagnosis(), Stance()
        self.connection = self.address = self.problem = ""
        self.report_period = REPORT_PERIOD
        self._reported: float | None = None
        self._well_reported: float | None = None  # while the driver reached the robot

    def _add_event(self, perception: Perception, stamp: float | None = None) -> None:
        self._robot.events.add(perception.kind, perception.text, stamp=stamp, **perception.values)

    # --- messages, in threads of ROS ------------------------------------------------------------------------------

    def take_diagnostics(self, message: Any) -> None:
        """A message of /diagnostics, of this robot or not."""
        now = self._clock()
        self.diagnosis.take(message.status, self.address, now)
        status = read_status(message.status, self._robot.namespace, self.status)
        if status is self.status:
            return
        if self._reported is not None:
            self.report_period = min(max(REPORT_PERIOD, now - self._reported), LONGEST_PERIOD)
        self.status, self._reported = status, now
        if not status.stale:
            self._well_reported = now

    def _on_connection(self, message: Any) -> None:
        self.connection, self.address, self.problem = message.state, message.address, message.last_error
        self._fall.recovery.connection_is(message.state)
        if message.state not in CONNECTED:
            self.stance.forget_family()

    def _on_contact(self, message: Any) -> None:
        if self._contact.take(message.data):
            self._add_event(
                felt("stands on the ground" if message.data else "has lost the ground", ground=message.data)
            )

    def _on_posture(self, message: Any) -> None:
        if self._posture.take(message.data):
            self._add_event(felt(f"posture {message.data}", posture=message.data), message.header.stamp.to_sec())

    def _on_family(self, message: Any) -> None:
        self.stance.take(message.data)

    def _on_fall(self, message: Any) -> None:
        news = self._fall.take(message.data, message)
        if message.data.lower() not in ("true", "1", "1.0"):
            return
        self.stance.fell(news)
        if news:
            self._add_event(felt("has fallen", fallen=True), message.header.stamp.to_sec())


def state_of(body: BodyWatch) -> dict[str, Any]:
    """The state of a robot, as JSON values; None: not known."""
    status, stance = body.status, body.stance
    return {
        "connection": body.connection or None,
        "posture": body.posture or None,
        "family": stance.family or None,
        "fallen": stance.fallen if stance.family else None,
        "limp": status.limp,
        "stiffness": _known(status.stiffness, 3),
        "battery": _known(status.battery, 1),
        "charging": status.charging if math.isfinite(status.battery) else None,
        "hottest": _known(status.hottest[0][1], 1) if status.hottest else None,
        "hot": list(status.hot),
    }


def state_text(state: dict[str, Any]) -> str:
    """A state of `state_of` as text."""
    stiffness = "" if state["stiffness"] is None else f"stiffness {100 * state['stiffness']:.0f} %"
    parts = [
        state["connection"] or "connection unknown",
        f"posture {state['posture'] or 'unknown'}",
        "fallen" if state["fallen"] else "",
        "limp" if state["limp"] else stiffness,
        "battery unknown" if state["battery"] is None else f"battery {state['battery']:g} %",
        f"hot: {', '.join(state['hot'])}" if state["hot"] else "",
    ]
    return ", ".join(filter(None, parts))


def _known(value: float, digits: int) -> float | None:
    return round(value, digits) if math.isfinite(value) else None
