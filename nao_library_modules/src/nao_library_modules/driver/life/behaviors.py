"""Behaviours that are installed on the robot. No ROS."""

from __future__ import annotations

import logging
from typing import Any

from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...base.errors import BadGoal, Preempted
from ...base.suggestion import did_you_mean
from ...robot.robot import CLEAN_UP_LIMIT
from ...robot.robot_task import run_task

log = logging.getLogger(__name__)

MODULE = "ALBehaviorManager"
ANSWER_LIMIT = 5.0


class Behaviors:
    """Lists and runs them. Any thread may call."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot

    def installed(self) -> list[str]:
        return [str(name) for name in self._ask("getInstalledBehaviors")]

    def run(self, name: str, interrupt: CancellationToken) -> None:
        """Run one, to its end or to the interrupt, which stops it.

        Raises NaoError if it is not installed, the robot refuses or is lost; Preempted, or whatever reason the
        interrupt has.
        """
        if not self._ask("isBehaviorInstalled", name):
            known = self.installed()
            problem = f"{name!r} is not installed{did_you_mean(name, known)}"
            raise BadGoal("behavior", name, f"one of {', '.join(sorted(known)) or 'none'}", problem=problem)
        interrupt.check()
        call = self._robot.proxy(MODULE).call_async("runBehavior", name)
        try:
            run_task(call, interrupt, lambda: self._stop(name))
        except Preempted:
            # A call that could be cancelled has ended; what it started must not go on without it.
            if self._runs(name):
                self._stop(name)
            raise

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
