"""States and abilities of the robot's autonomous life. No ROS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import UnknownModule
from naoqi.limits import ANSWER_LIMIT, MOVE_LIMIT

from ...robot.event_relay import EventRelay
from ...ros.health import Level, Report
from ..base.lazy_subscription import LazySubscription

LIFE, MEMORY = "ALAutonomousLife", "ALMemory"
STATE = "AutonomousLife/State"
STATES = ("disabled", "solitary", "interactive", "safeguard")


@dataclass(frozen=True)
class Ability:
    """Something that a robot does by itself."""

    name: str  # of its services
    life: str  # name in ALAutonomousLife
    module: str  # that older robots have for it


ABILITIES = tuple(
    Ability(name, life, f"AL{life}")
    for name, life in (
        ("background_movement", "BackgroundMovement"),
        ("listening_movement", "ListeningMovement"),
        ("speaking_movement", "SpeakingMovement"),
        ("basic_awareness", "BasicAwareness"),
        ("autonomous_blinking", "AutonomousBlinking"),
    )
)


class AutonomousLife:
    """Autonomous life of one robot. Any thread may call. Methods raise NaoError if the robot refuses or lacks it."""

    def __init__(self, robot: Any, tell: Callable[[str], None]) -> None:
        """Begin to listen to the state; the robot need not be connected yet.

        `tell` gets each state, in a thread of libqi or of this object; it must not wait.
        """
        self._robot = robot
        self._tell = tell
        self._state = ""
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), lambda _, state: self._note(state))
        self._listening = LazySubscription(robot, "state of autonomous life", self._begin, self._relay.close)
        self._listening.want(True)

    def set_state(self, state: str) -> None:
        """Change the state, and wait until it is reached."""
        self._robot.proxy(LIFE).call_async("setState", state).result(timeout=MOVE_LIMIT)

    def set_enabled(self, ability: Ability, enabled: bool) -> None:
        try:
            self._ask(ability.module, "setEnabled", enabled)
        except UnknownModule:
            self._ask(LIFE, "setAutonomousAbilityEnabled", ability.life, enabled)

    def is_enabled(self, ability: Ability) -> bool:
        try:
            return bool(self._ask(ability.module, "isEnabled"))
        except UnknownModule:
            return bool(self._ask(LIFE, "getAutonomousAbilityEnabled", ability.life))

    def report(self) -> Report:
        """The state; a robot without autonomous life is no error, for there are such."""
        values = {"state": self._state, "last error": self._listening.problem}
        if self._listening.running:
            return Report(Level.OK, self._state or "unknown", values)
        return Report(Level.OK, f"unknown: {self._listening.problem or 'the robot is not connected'}", values)

    def close(self) -> None:
        self._listening.close()

    def _begin(self) -> None:
        self._relay.close()  # events of a connection that was lost
        self._relay.subscribe(STATE)
        try:
            self._note(self._ask(LIFE, "getState"))
        except UnknownModule:
            self._note("")

    def _note(self, state: Any) -> None:
        self._state = str(state or "")
        if self._state:
            self._tell(self._state)

    def _ask(self, module: str, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)
