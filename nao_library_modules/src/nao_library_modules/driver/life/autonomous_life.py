"""States and abilities of the robot's autonomous life. No ROS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import UnknownModule

from ...robot.event_relay import EventRelay
from ...ros.health import Level, Report
from ..base.lazy_subscription import LazySubscription

LIFE, MEMORY = "ALAutonomousLife", "ALMemory"
STATE = "AutonomousLife/State"
STATES = ("disabled", "solitary", "interactive", "safeguard")
CHANGE_LIMIT = 60.0
"""s that a change of state may take: the robot may get up for it."""
ANSWER_LIMIT = 5.0
CLOSE_LIMIT = 2.0


@dataclass(frozen=True)
class Ability:
    """Something that a robot does by itself.

    Attributes:
        name: Name of its services.
        life: What ALAutonomousLife calls it.
        module: The module that older robots have for it.
    """

    name: str
    life: str
    module: str


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
    """Any thread may call."""

    def __init__(self, robot: Any, tell: Callable[[str], None]) -> None:
        """Begin to listen to the state; the robot need not be there yet.

        Args:
            robot: Its proxies and connection, see `nao_library_modules.robot`.
            tell: Gets each state, in a thread of libqi or of this object; must not wait.
        """
        self._robot = robot
        self._tell = tell
        self._state = ""
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), lambda _, state: self._note(state))
        self._listening = LazySubscription(robot, "state of autonomous life", self._begin, self._relay.close)
        self._listening.want(True)

    def set_state(self, state: str) -> None:
        """Go to a state, and wait until it is there.

        Raises:
            NaoError: If the robot refuses or has no autonomous life.
        """
        self._robot.proxy(LIFE).call_async("setState", state).result(timeout=CHANGE_LIMIT)

    def set_enabled(self, ability: Ability, enabled: bool) -> None:
        """Switch an ability on or off.

        Raises:
            NaoError: If the robot refuses or does not have it.
        """
        try:
            self._ask(ability.module, "setEnabled", enabled)
        except UnknownModule:
            self._ask(LIFE, "setAutonomousAbilityEnabled", ability.life, enabled)

    def is_enabled(self, ability: Ability) -> bool:
        """Whether an ability is switched on.

        Raises:
            NaoError: If the robot does not have it.
        """
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
        """Listen no more."""
        self._listening.close(CLOSE_LIMIT)

    def _begin(self) -> None:
        for event in self._relay.names:  # those of a connection that was lost
            self._relay.unsubscribe(event)
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
