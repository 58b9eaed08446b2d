"""ALAutonomousLife of the simulated robot: states and activities; `LifeModules` has its other parts."""

from __future__ import annotations

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import number, whole_number
from nao_sim_bridge.naoqi.life.life import ALIVE, STACK, STOP, Life
from nao_sim_bridge.naoqi.life.stimuli import Stimuli

NAME = "ALAutonomousLife"


class ALAutonomousLife:
    """ALAutonomousLife as the simulated robot offers it; it begins disabled, so that a robot does what it is told.

    No activity is launched by conditions: those that are installed have none.
    """

    def __init__(self, life: Life, installed: InstalledBehaviors, stimuli: Stimuli, runner: RobotRunner) -> None:
        self._life = life
        self._installed = installed
        self._stimuli = stimuli
        self._runner = runner

    # --- states ---------------------------------------------------------------------------------------------------

    def getState(self) -> str:
        return self._life.state

    def setState(self, state: str) -> Task:
        """Ends when the robot is in the state: it wakes up before it lives."""
        return self._runner.execute(lambda: self._life.set_state(state), "setState")

    def setAutonomousAbilityEnabled(self, ability: str, enabled: bool) -> Task:
        self._life.abilities.named(ability)  # an unknown one is refused at once
        return self._runner.execute(
            lambda: self._life.abilities.enable(ability, bool(enabled)), "setAutonomousAbilityEnabled"
        )

    # --- activities -----------------------------------------------------------------------------------------------

    def focusedActivity(self) -> str:
        return self._life.focused

    def switchFocus(self, activity: str = "", flag: int = STOP) -> Task:
        """Without an activity the focus is free."""
        whole_number(flag, "flags", STOP, STACK)
        if not activity:
            return self.stopFocus()
        behavior = self._installed.resolve(activity)
        return self._runner.execute(lambda: self._life.switch_focus(behavior, flag), "switchFocus")

    def stopFocus(self) -> Task:
        return self._runner.execute(self._life.stop_focus, "stopFocus")

    def stopAll(self) -> Task:
        return self._runner.execute(self._life.stop_all, "stopAll")

    def getActivityNature(self, activity: str) -> str:
        return self._installed.resolve(activity).nature

    def getActivityContextPermissionViolations(self, activity: str) -> str:
        """Activities here ask for no permissions; what may keep one from the focus is its nature and the state."""
        nature = self._installed.resolve(activity).nature
        if nature not in ALIVE:
            return f"nature: {nature}"
        return "" if self._life.state in ALIVE else f"state: {self._life.state}"

    def getAutonomousActivityStatistics(self) -> dict:
        """Of those with launch conditions: an installed behaviour has none."""
        return {}

    def preloadActivities(self) -> None:
        """Have all activities at hand: they are read when they are installed."""
        for behavior in self._installed.all.values():
            if behavior.nature in ALIVE:
                self._installed.resolve(behavior.name)

    def getRobotOffsetFromFloor(self) -> float:
        return self._stimuli.offset

    def setRobotOffsetFromFloor(self, offset: float) -> None:
        """Basic awareness looks for faces of people so much lower."""
        self._stimuli.offset = number(offset, "offset", 0.0, 10.0)
