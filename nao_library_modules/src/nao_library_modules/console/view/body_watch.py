"""The state of a robot, from its driver and its memory. Events are in `senses`."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from .background import Subscriptions, Takers
from .body_status import BodyStatus, read_status
from .diagnosis import Diagnosis
from .latched import CONNECTED, Latched
from .memory_topics import TEXT, MemoryTopics
from .sense_texts import Perception, felt
from .stance import Stance

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
