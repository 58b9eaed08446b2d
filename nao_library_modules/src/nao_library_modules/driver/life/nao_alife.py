"""The node nao_alife: states and abilities of autonomous life."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from std_msgs.msg import String
from std_srvs.srv import Empty, SetBool, SetBoolResponse, Trigger, TriggerResponse

from naoqi.errors import NaoError

from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ..base.node import publish
from .autonomous_life import ABILITIES, STATES, Ability, AutonomousLife


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
