"""The node nao_behaviors: behaviours that are installed on the robot, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nao_library_actions.msg import RunBehaviorAction, RunBehaviorResult
from nao_library_msgs.srv import GetInstalledBehaviors, GetInstalledBehaviorsResponse

from ...base.cancellation import CancellationToken
from ...ros.concurrent_action_server import ConcurrentActionServer, GoalOutcome
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ..base.node import interrupt_when_lost
from .behaviors import Behaviors

ROBOT = frozenset({"the robot"})
"""What a behaviour has for itself: all of it."""
SHUTDOWN_LIMIT = 2.0


class NaoBehaviors:
    """Behaviours of one robot, one at a time: a newer goal ends the one before.

    ROS API (relative names):
        Service `get_installed_behaviors` (nao_library_msgs/GetInstalledBehaviors).
        Action `run_behavior` (nao_library_actions/RunBehavior): ends with the behaviour; cancelling it stops the
        behaviour.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._behaviors = Behaviors(robot)
        self._server = ConcurrentActionServer(lambda _: ROBOT, self._run, robot=robot)
        node.action("run_behavior", RunBehaviorAction, self._server)
        node.offer("get_installed_behaviors", GetInstalledBehaviors, self._installed)
        # After the service: a part that cannot offer it leaves no listener.
        self._stop_watching = interrupt_when_lost(robot, node, self._server)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"goals run_behavior": self._server.counter.report}

    def close(self) -> None:
        self._stop_watching()
        self._server.close(SHUTDOWN_LIMIT)

    def _installed(self, _request: Any) -> GetInstalledBehaviorsResponse:
        return GetInstalledBehaviorsResponse(self._behaviors.installed())

    def _run(self, goal: Any, interrupt: CancellationToken) -> GoalOutcome:
        self._behaviors.run(goal.behavior, interrupt)
        return GoalOutcome(RunBehaviorResult())
