"""The node nao_behaviors: behaviors that are installed on the robot."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from nao_library_actions.msg import RunBehaviorAction, RunBehaviorResult
from nao_library_msgs.srv import GetInstalledBehaviors, GetInstalledBehaviorsResponse
from naoqi.errors import NaoError
from naoqi.limits import CLEAN_UP_LIMIT

from ...core.errors import BadGoal, Preempted, did_you_mean
from ...core.health import Report
from ...core.robot import ask, run_task
from ...core.waiting import CancellationToken
from ...ros.action_server import ConcurrentActionServer, GoalOutcome
from ...ros.node_interface import NodeInterface
from ..base.driver_node import interrupt_when_lost

log = logging.getLogger(__name__)

MODULE = "ALBehaviorManager"
ANIMATIONS = "animations/"
"""Beginning of the names of those that only move joints: others may wake the robot themselves."""
# So many behaviours are named in an error.
MOST_NAMED = 20


class Behaviors:
    """Lists and runs them. Any thread may call."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot

    def installed(self) -> list[str]:
        return [str(name) for name in self._ask("getInstalledBehaviors")]

    def run(self, name: str, interrupt: CancellationToken) -> None:
        """Run one, to its end or to the interrupt, which stops it.

        Raises NaoError if it is not installed, is an animation for a limp robot, is refused, or the robot is lost;
        Preempted, or whatever reason the interrupt has.
        """
        if not self._ask("isBehaviorInstalled", name):
            known = self.installed()
            problem = f"{name!r} is not installed{did_you_mean(name, known)}"
            some = ", ".join(sorted(known)[:MOST_NAMED]) or "none"
            more = f"... ({len(known)} in all)" if len(known) > MOST_NAMED else ""
            raise BadGoal("behavior", name, f"one of {some}{more}", problem=problem)
        if name.startswith(ANIMATIONS):
            self._require_stiffness()
        interrupt.check()
        call = self._robot.proxy(MODULE).call_async("runBehavior", name)
        try:
            run_task(call, interrupt, lambda: self._stop(name))
        except Preempted:
            # A call that could be cancelled has ended; what it started must not continue without it.
            if self._runs(name):
                self._stop(name)
            raise

    def _require_stiffness(self) -> None:
        """NAOqi plays animations on a limp robot, which then does not move and does not say so."""
        stiffnesses = ask(self._robot, "ALMotion", "getStiffnesses", "Body")
        if not any(stiffnesses):
            raise NaoError("the robot is limp and would not move: wakeUp first")

    def _runs(self, name: str) -> bool:
        try:
            return bool(self._ask("isBehaviorRunning", name))
        except NaoError as error:
            log.warning("%s may still run: %s", name, error)
            return False

    def _stop(self, name: str) -> None:
        try:
            ask(self._robot, MODULE, "stopBehavior", name, limit=CLEAN_UP_LIMIT)
        except NaoError as error:
            log.warning("%s may still run: %s", name, error)

    def _ask(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, MODULE, method, *arguments)


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
