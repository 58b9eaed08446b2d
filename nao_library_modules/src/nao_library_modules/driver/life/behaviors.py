"""Behaviours that are installed on the robot. No ROS."""

from __future__ import annotations

import logging
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, CLEAN_UP_LIMIT

from ...base.cancellation import CancellationToken
from ...base.errors import BadGoal, Preempted
from ...base.suggestion import did_you_mean
from ...robot.robot_task import run_task

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
            # A call that could be cancelled has ended; what it started must not go on without it.
            if self._runs(name):
                self._stop(name)
            raise

    def _require_stiffness(self) -> None:
        """NAOqi plays animations on a limp robot, which then does not move and does not say so."""
        stiffnesses = self._robot.proxy("ALMotion").call_async("getStiffnesses", "Body").result(timeout=ANSWER_LIMIT)
        if not any(stiffnesses):
            raise NaoError("the robot is limp and would not move: wakeUp first")

    def _runs(self, name: str) -> bool:
        try:
            return bool(self._ask("isBehaviorRunning", name))
        except NaoError as error:
            log.warning("%s may go on: %s", name, error)
            return False

    def _stop(self, name: str) -> None:
        try:
            self._robot.proxy(MODULE).call_async("stopBehavior", name).result(timeout=CLEAN_UP_LIMIT)
        except NaoError as error:
            log.warning("%s may go on: %s", name, error)

    def _ask(self, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(MODULE).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)
