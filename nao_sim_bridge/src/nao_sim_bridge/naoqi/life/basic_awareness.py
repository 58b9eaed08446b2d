"""ALBasicAwareness of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import known, one_of, vector
from nao_sim_bridge.naoqi.life.awareness import (
    ENGAGEMENTS,
    HEAD,
    PARAMETERS,
    TRACKINGS,
    UNENGAGED,
    Awareness,
    Settings,
)
from nao_sim_bridge.naoqi.life.stimuli import check


class ALBasicAwareness:
    """ALBasicAwareness as the simulated robot offers it; a NAO has no tablet, and nothing that sees motion but eyes."""

    def __init__(self, awareness: Awareness, runner: RobotRunner) -> None:
        self._awareness = awareness
        self._runner = runner

    def setEnabled(self, enabled: bool) -> Task:
        return self._change("setEnabled", lambda: setattr(self._awareness, "enabled", bool(enabled)))

    def isEnabled(self) -> bool:
        return self._awareness.enabled

    def isAwarenessRunning(self) -> bool:
        return self._awareness.running

    def startAwareness(self) -> Task:
        return self.setEnabled(True)

    def stopAwareness(self) -> Task:
        return self.setEnabled(False)

    def pauseAwareness(self) -> Task:
        return self._change("pauseAwareness", lambda: setattr(self._awareness, "paused", True))

    def resumeAwareness(self) -> Task:
        return self._change("resumeAwareness", lambda: setattr(self._awareness, "paused", False))

    def isAwarenessPaused(self) -> bool:
        return self._awareness.paused

    def getEngagementMode(self) -> str:
        return self._awareness.engagement

    def setEngagementMode(self, mode: str) -> Task:
        one_of(mode, "modeName", ENGAGEMENTS)
        return self._change("setEngagementMode", lambda: setattr(self._awareness, "engagement", mode))

    def getTrackingMode(self) -> str:
        return self._awareness.tracking

    def setTrackingMode(self, mode: str) -> Task:
        one_of(mode, "modeName", TRACKINGS)
        return self._change("setTrackingMode", lambda: setattr(self._awareness, "tracking", mode))

    def isStimulusDetectionEnabled(self, stimulus: str) -> bool:
        return self._awareness.stimuli.enabled(stimulus)

    def setStimulusDetectionEnabled(self, stimulus: str, enabled: bool) -> Task:
        check(stimulus, bool(enabled))
        return self._change(
            "setStimulusDetectionEnabled", lambda: self._awareness.stimuli.enable(stimulus, bool(enabled))
        )

    def getParameter(self, name: str) -> float:
        return getattr(self._awareness.settings, known(name, "parameter", PARAMETERS))

    def setParameter(self, name: str, value: Any) -> None:
        self._awareness.set_parameter(name, value)

    def resetAllParameters(self) -> Task:
        """Modes and stimuli, too."""

        def reset() -> None:
            self._awareness.settings = Settings()
            self._awareness.engagement, self._awareness.tracking = UNENGAGED, HEAD
            self._awareness.stimuli.enable_all()

        return self._change("resetAllParameters", reset)

    def triggerStimulus(self, position: Any) -> Task:
        place = vector(position, "positionFrameWorld", 3, "[x, y, z] in FRAME_WORLD, m", -100.0, 100.0)
        return self._runner.execute(lambda: self._awareness.trigger(tuple(place)), "triggerStimulus")

    def engagePerson(self, person: int) -> Task:
        return self._runner.execute(lambda: self._awareness.engage(person), "engagePerson")

    def _change(self, call: str, change: Callable[[], Any]) -> Task:
        def run() -> None:
            change()
            self._awareness.update()

        return self._runner.execute(run, call)
