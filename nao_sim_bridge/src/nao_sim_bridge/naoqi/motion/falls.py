"""Part of ALMotion: switches of fall manager and push recovery."""

from __future__ import annotations

from nao_sim_bridge.base.errors import NotAllowed
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.motion.part import MotionPart

# The owner's permission to do without the fall manager; off at the start.
DEACTIVATION = "ENABLE_DEACTIVATION_OF_FALL_MANAGER"


class Falls(MotionPart):
    """What keeps the robot on its feet, switched on and off; on after each start."""

    def getFallManagerEnabled(self) -> bool:
        return self._robot.stability.falls.enabled

    def setFallManagerEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            if not (enabled or self._robot.reflexes.switches[DEACTIVATION]):
                raise NotAllowed(f"the fall manager stays on; setMotionConfig([[{DEACTIVATION!r}, True]]) allows it")
            self._robot.stability.falls.enabled = enabled

        return self._runner.execute(switch, "setFallManagerEnabled")

    def getPushRecoveryEnabled(self) -> bool:
        return self._robot.stability.balance.enabled

    def setPushRecoveryEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.stability.balance.enabled = enabled

        return self._runner.execute(switch, "setPushRecoveryEnabled")
