"""ALRedBallTracker and ALFaceTracker, the modules that ALTracker has replaced."""

from __future__ import annotations

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.model.frames import ROBOT
from nao_sim_bridge.naoqi.tracker.tracker import ALTracker
from nao_sim_bridge.tracking.follower import Mode


class OlderTracker:
    """One that follows one kind of target, by means of ALTracker; what follows another target is not its own."""

    def __init__(self, target: str, size: float, tracker: ALTracker) -> None:
        self._target = target
        self._size = size
        self._tracker = tracker
        self._mode = Mode.HEAD.value

    def startTracker(self) -> Task:
        self._tracker.registerTarget(self._target, self._size)
        self._tracker.setMode(self._mode)
        return self._tracker.track(self._target)

    def stopTracker(self) -> Task | None:
        return self._tracker.stopTracker() if self.isActive() else None

    def isActive(self) -> bool:
        return self._tracker.getActiveTarget() == self._target

    def isNewData(self) -> bool:
        return self.isActive() and self._tracker.isNewTargetDetected()

    def getPosition(self) -> list[float]:
        return self._tracker.getTargetPosition(ROBOT) if self.isActive() else []

    def setWholeBodyOn(self, whole_body: bool) -> Task | None:
        self._mode = (Mode.WHOLE_BODY if whole_body else Mode.HEAD).value
        return self._tracker.setMode(self._mode) if self.isActive() else None
