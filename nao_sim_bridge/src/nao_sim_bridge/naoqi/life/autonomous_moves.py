"""ALAutonomousMoves of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.naoqi.life.movements import STRATEGIES, BackgroundMovement, ListeningMovement

NAME = "ALAutonomousMoves"


class ALAutonomousMoves:
    """ALAutonomousMoves as the simulated robot offers it."""

    def __init__(self, background: BackgroundMovement, listening: ListeningMovement, runner: SimulationRunner) -> None:
        self._background = background
        self._listening = listening
        self._runner = runner

    def getBackgroundStrategy(self) -> str:
        return self._background.strategy

    def setBackgroundStrategy(self, strategy: str) -> Task:
        if strategy not in STRATEGIES:
            raise BadValue("strategy", strategy, " or ".join(STRATEGIES))

        def change() -> None:
            self._background.strategy = strategy
            self._background.update()

        return self._runner.execute(change, "setBackgroundStrategy")

    def getExpressiveListeningEnabled(self) -> bool:
        return self._listening.enabled

    def setExpressiveListeningEnabled(self, enable: bool) -> None:
        self._listening.enabled = bool(enable)

    def startSmallDisplacements(self) -> Task:
        """Since NAOqi 2.0 this is the breath."""
        return self._runner.execute(self._background.start, "startSmallDisplacements")

    def stopSmallDisplacements(self) -> Task:
        return self._runner.execute(self._background.stop, "stopSmallDisplacements")
