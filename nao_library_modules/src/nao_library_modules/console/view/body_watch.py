"""The state of a robot, as its driver and its memory tell it, while somebody wants it: not what happens to it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from .alarms import LATE, SILENCE
from .background import Subscriptions, Takers
from .body_status import BodyStatus, read_status
from .diagnosis import Diagnosis
from .latched import REACHED, Latched
from .memory_topics import TEXT, MemoryTopics
from .sense_texts import Perception, felt
from .stance import Stance

POSTURE, FAMILY, FALLEN = "PostureChanged", "PostureFamilyChanged", "robotHasFallen"
REPORT_PERIOD = 2.0
"""s between two reports of the body, as the driver has it without a setting."""
LONGEST_PERIOD = 30.0
"""s: reports that are further apart had ended in between."""


class BodyWatch:
    """Of one robot. Any thread. All topics here are states: only a change of one is an event of the robot.

    ROS API (relative names):
        Subscribes, while somebody wants it, `/diagnostics` (diagnostic_msgs/DiagnosticArray), `connection`
        (nao_library_msgs/ConnectionState), `foot_contact` (std_msgs/Bool), and of the robot's memory
        (`nao_memory/watch`) its posture, the family of that, and whether it has fallen.

    Attributes:
        acquire: Follows the body until what it returns is called.
        status: The body; replaced at each report.
        connection: connecting, connected, silent, lost or closed; empty until it is told.
        address: Of the robot.
        problem: What went wrong last with its connection.
        diagnosis: What the reports tell beside the body.
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
        """As the robot calls it; empty until it is told."""
        return self._posture.value or ""

    @property
    def silence(self) -> float | None:
        """S since the robot's last answer; None until somebody tells of it."""
        answered = self.diagnosis.answered
        return None if answered is None else max(0.0, self._clock() - answered)

    @property
    def report_age(self) -> float | None:
        """S since the last report of the body; None before the first."""
        return None if self._reported is None else max(0.0, self._clock() - self._reported)

    @property
    def old(self) -> float | None:
        """S since the robot was there for a report of its body, where the next one is late or lacks it; else None."""
        if self._well_reported is None or self._reported is None:
            return None
        age = self._clock() - self._well_reported
        return age if self.status.stale or age > LATE * self.report_period else None

    @property
    def unheard(self) -> float | None:
        """S since the robot's last answer where that is too long ago; else None."""
        silence = self.silence
        return silence if silence is not None and silence > SILENCE else None

    @property
    def complete(self) -> bool:
        """Whether each state has been told."""
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
        self._well_reported: float | None = None  # by a driver that reached the robot

    def _tell(self, perception: Perception, stamp: float | None = None) -> None:
        self._robot.events.add(perception.kind, perception.text, stamp=stamp, **perception.values)

    # --- messages, in threads of ROS ------------------------------------------------------------------------------

    def take_diagnostics(self, told: Any) -> None:
        """A message of /diagnostics, of this robot or not."""
        now = self._clock()
        self.diagnosis.take(told.status, self.address, now)
        status = read_status(told.status, self._robot.namespace, self.status)
        if status is self.status:
            return
        if self._reported is not None:
            self.report_period = min(max(REPORT_PERIOD, now - self._reported), LONGEST_PERIOD)
        self.status, self._reported = status, now
        if not status.stale:
            self._well_reported = now

    def _on_connection(self, told: Any) -> None:
        self.connection, self.address, self.problem = told.state, told.address, told.last_error
        self._fall.recovery.connection_is(told.state)
        if told.state not in REACHED:
            self.stance.forget_family()

    def _on_contact(self, told: Any) -> None:
        if self._contact.take(told.data):
            self._tell(felt("stands on the ground" if told.data else "has lost the ground", ground=told.data))

    def _on_posture(self, told: Any) -> None:
        if self._posture.take(told.data):
            self._tell(felt(f"posture {told.data}", posture=told.data), told.header.stamp.to_sec())

    def _on_family(self, told: Any) -> None:
        self.stance.take(told.data)

    def _on_fall(self, told: Any) -> None:
        news = self._fall.take(told.data, told)
        if told.data.lower() not in ("true", "1", "1.0"):
            return
        self.stance.fell(news)
        if news:
            self._tell(felt("has fallen", fallen=True), told.header.stamp.to_sec())


def state_of(body: BodyWatch) -> dict[str, Any]:
    """How a robot is, as a log has it; None: not known."""
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
    """A state of `state_of`, for people."""
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
