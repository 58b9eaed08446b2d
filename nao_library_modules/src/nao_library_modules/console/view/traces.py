"""Numbers of the robot over the last minute, for plots. A trace is read while a page plots it.

Names of traces:

    velocity:JOINT, effort:JOINT    rad/s, N m
    stiffness:JOINT                 0..1
    sonar:left, sonar:right         m
    foot:left, foot:right           N
    imu:roll, imu:pitch             rad
    gyro:x, gyro:y, gyro:z          rad/s
    acceleration:x, ...             m/s^2
    memory:KEY                      what the robot's memory has there, a number or a truth value

Angles of joints (`joint:JOINT`) are in every pose frame already: pages plot them from there.
"""

from __future__ import annotations

import math
import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Deque, Tuple

from naoqi.errors import NaoError

from ...base.suggestion import did_you_mean
from .memory_topics import FLOAT, MemoryTopics

SPAN = 60.0
"""s that are kept."""
CLOSEST = 0.045
"""s between two readings of a trace, at least."""
MOST_TRACES = 12
"""Traces of one page, at most."""
LONGEST_NAME = 200
JOINT_FIELDS = {"velocity": "velocity", "effort": "effort"}
SIDES, AXES, TILTS = ("left", "right"), ("x", "y", "z"), ("roll", "pitch")
TRACE_NAMES = {
    **{kind: () for kind in (*JOINT_FIELDS, "stiffness", "memory")},
    **{kind: SIDES for kind in ("sonar", "foot")},
    **{kind: AXES for kind in ("gyro", "acceleration")},
    "imu": TILTS,
}
"""Kind of a trace -> what may stand after its colon; empty: a joint, or a key."""
Reading = Tuple[float, float]
"""ROS time in s, and a value."""


def split_trace(name: Any) -> tuple[str, str]:
    """Kind of a trace and of what it is. Raises NaoError if there is no such trace."""
    kind, _, what = str(name)[: LONGEST_NAME + 1].partition(":")
    if len(str(name)) > LONGEST_NAME or not what:
        raise NaoError(f"{str(name)[:60]!r} is no trace: KIND:NAME, such as sonar:left")
    if kind not in TRACE_NAMES:
        raise NaoError(
            f"{kind!r} is no kind of trace{did_you_mean(kind, TRACE_NAMES)}; there are {', '.join(TRACE_NAMES)}"
        )
    if TRACE_NAMES[kind] and what not in TRACE_NAMES[kind]:
        raise NaoError(f"{kind}:{what}: there are {', '.join(f'{kind}:{name}' for name in TRACE_NAMES[kind])}")
    return kind, what


def listed_value(names: Sequence[str], values: Sequence[float], name: str) -> float:
    """The value of a name in two lists that belong together; not a number where it is missing."""
    try:
        return float(values[list(names).index(name)])
    except (ValueError, IndexError):
        return math.nan


class Trace:
    """Readings of one number. Readings come in threads of ROS; a lock guards them."""

    def __init__(self) -> None:
        self.problem = ""
        self.users = 0
        self.end: Callable[[], None] | None = None
        self._lock = threading.Lock()
        self._kept: Deque[Reading] = deque()
        self._fresh: list[Reading] = []

    def add(self, stamp: float, value: float) -> None:
        """One more reading; left out if it comes too soon after the last one. Time that went back begins anew."""
        with self._lock:
            if self._kept:
                since = stamp - self._kept[-1][0]
                if 0.0 <= since < CLOSEST:
                    return
                if since < 0.0:
                    self._kept.clear()
            self._kept.append((stamp, value))
            self._fresh.append((stamp, value))
            while self._kept[0][0] < stamp - SPAN:
                self._kept.popleft()

    def fresh(self) -> list[Reading]:
        """Readings since the last call."""
        with self._lock:
            fresh, self._fresh = self._fresh, []
        return fresh

    def kept(self) -> list[Reading]:
        with self._lock:
            return list(self._kept)


class Traces:
    """All traces of one robot that a page plots. `want` and `leave` come from one thread, and may take a while."""

    def __init__(self, robot: Any, memory: MemoryTopics) -> None:
        self._robot = robot
        self._memory = memory
        self._traces: dict[str, Trace] = {}

    def want(self, name: str) -> Trace:
        """A trace, which is read from now on; its `problem` says what is wrong with it."""
        trace = self._traces.get(name)
        if trace is None:
            trace = self._traces[name] = Trace()
        trace.users += 1
        if trace.end is None:
            try:
                trace.end, trace.problem = self._begin(name, trace), ""
            except NaoError as error:
                trace.problem = str(error)
        return trace

    def leave(self, name: str) -> None:
        trace = self._traces[name]
        trace.users -= 1
        if trace.users == 0:
            del self._traces[name]
            if trace.end is not None:
                trace.end()

    def fresh(self) -> dict[str, list[Reading]]:
        """New readings by trace; the event loop asks for them."""
        return {name: trace.fresh() for name, trace in list(self._traces.items())}

    def _begin(self, name: str, trace: Trace) -> Callable[[], None]:
        kind, what = split_trace(name)
        if kind == "memory":
            return self._memory.watch(what, FLOAT, lambda told: trace.add(told.header.stamp.to_sec(), told.data))
        topic, message, value = _source(kind, what)
        return self._robot.topic(topic, message, lambda told: trace.add(told.header.stamp.to_sec(), value(told)))


def _source(kind: str, what: str) -> tuple[str, type, Callable[[Any], float]]:
    """Topic of a trace, its type, and what gives the value of a message."""
    from sensor_msgs.msg import Imu, JointState, Range

    from nao_library_msgs.msg import Fsr

    if kind in JOINT_FIELDS:
        field = JOINT_FIELDS[kind]
        return "joint_states", JointState, lambda told: listed_value(told.name, getattr(told, field), what)
    if kind == "stiffness":
        topic = "nao_joint_states/joint_stiffness"
        return topic, JointState, lambda told: listed_value(told.name, told.effort, what)
    if kind == "sonar":
        return f"nao_robot/sonar/{what}", Range, lambda told: told.range
    if kind == "foot":
        return f"nao_robot/fsr/{what}", Fsr, lambda told: told.total
    if kind == "imu":
        return "imu", Imu, lambda told: _tilt(told.orientation)[TILTS.index(what)]
    field = "angular_velocity" if kind == "gyro" else "linear_acceleration"
    return "imu", Imu, lambda told: getattr(getattr(told, field), what)


def _tilt(turn: Any) -> tuple[float, float]:
    """Roll and pitch of a quaternion, rad."""
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    sine = min(max(2.0 * (w * y - z * x), -1.0), 1.0)
    return math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)), math.asin(sine)
