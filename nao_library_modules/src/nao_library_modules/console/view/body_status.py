"""How the robot's body is: battery, heat and stiffness, from the diagnostics of its driver. Pure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ...nao.body_devices import CHARGING_BIT
from ...ros.body_reports import BATTERY_FLAGS

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
