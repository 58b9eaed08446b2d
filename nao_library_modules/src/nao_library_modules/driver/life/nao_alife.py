"""The node nao_alife: autonomous life and its abilities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rospy
from std_msgs.msg import String
from std_srvs.srv import Empty, SetBool, SetBoolResponse, Trigger, TriggerResponse

from naoqi.errors import NaoError, UnknownModule
from naoqi.limits import MOVE_LIMIT

from ...core.health import Level, Report
from ...core.robot import ask
from ...core.robot_events import EventRelay
from ...ros.node_interface import NodeInterface
from ..base.driver_node import publish
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

    def __init__(self, robot: Any, publish: Callable[[str], None]) -> None:
        """Begin to listen to the state; the robot need not be connected yet.

        `publish` gets each state, in a thread of libqi or of this object; it must not wait.
        """
        self._robot = robot
        self._publish = publish
        self._state = ""
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), lambda _, state: self._note(state))
        self._listening = LazySubscription(robot, "state of autonomous life", self._begin, self._relay.close)
        self._listening.want(True)

    def set_state(self, state: str) -> None:
        """Change the state, and wait until it is reached."""
        ask(self._robot, LIFE, "setState", state, limit=MOVE_LIMIT)

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
            self._publish(self._state)

    def _ask(self, module: str, method: str, *arguments: Any) -> Any:
        return ask(self._robot, module, method, *arguments)


class NaoAlife:
    """Autonomous life of one robot. `life/enable` and the like are offered by nao_controller.

    ROS API:
        Services `~disabled`, `~solitary`, `~interactive`, `~safeguard` (std_srvs/Empty: go to that state);
        relative names `background_movement/set_enabled` (std_srvs/SetBool), `background_movement/is_enabled`
        (std_srvs/Trigger: its success is the answer), and the same for `listening_movement`, `speaking_movement`,
        `basic_awareness` and `autonomous_blinking`.
        Publishes `~state` (std_msgs/String, latched) at every change.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._state = node.publisher("~state", String, queue_size=1, latch=True)
        self._life = AutonomousLife(robot, lambda state: publish(self._state, String(data=state)))
        node.if_it_fails(self._life.close)
        for state in STATES:
            node.offer(f"~{state}", Empty, lambda _, state=state: self._life.set_state(state))
        for ability in ABILITIES:
            node.service(f"{ability.name}/set_enabled", SetBool, lambda r, a=ability: self._switch(a, r.data))
            node.service(f"{ability.name}/is_enabled", Trigger, lambda _, a=ability: self._ask(a))

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"autonomous life": self._life.report}

    def close(self) -> None:
        self._life.close()

    def _switch(self, ability: Ability, enabled: bool) -> SetBoolResponse:
        try:
            self._life.set_enabled(ability, enabled)
        except NaoError as error:
            rospy.logerr("%s: %s", ability.name, error)
            return SetBoolResponse(False, str(error))
        return SetBoolResponse(True, "")

    def _ask(self, ability: Ability) -> TriggerResponse:
        try:
            enabled = self._life.is_enabled(ability)
        except NaoError as error:
            rospy.logerr("%s: %s", ability.name, error)
            return TriggerResponse(False, str(error))
        return TriggerResponse(enabled, "enabled" if enabled else "disabled")
