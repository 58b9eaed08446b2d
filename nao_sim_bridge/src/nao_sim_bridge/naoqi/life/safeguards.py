"""What sends autonomous life to safeguard, and the chest button that switches it. Events come in any thread."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, Callable

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.naoqi.life.life import ALIVE, DISABLED, SOLITARY, Life
from nao_sim_bridge.naoqi.memory.store import MemoryStore

PUSHED, FELL, DIAGNOSIS, TEMPERATURE = SAFEGUARDS = (
    "RobotPushed",
    "RobotFell",
    "CriticalDiagnosis",
    "CriticalTemperature",
)
FALLEN, PUSH_EVENT, DOUBLE_CLICK = "robotHasFallen", "ALMotion/RobotPushed", "ALChestButton/DoubleClickOccurred"
DIAGNOSED = {DIAGNOSIS: "PassiveDiagnosisErrorChanged", TEMPERATURE: "TemperatureDiagnosisErrorChanged"}
# How bad a diagnosis is: from here on it is critical.
CRITICAL = 2


class Safeguards:
    """Part of ALAutonomousLife: watches over a life."""

    def __init__(self, life: Life, runner: RobotRunner, memory: MemoryStore, rest: Callable[[], Task]) -> None:
        self._enabled = dict.fromkeys(SAFEGUARDS, True)
        self._life = life
        self._runner = runner
        self._rest = rest
        memory.listen(FALLEN, lambda value: self._do(self._fallen) if value else None)
        memory.listen(PUSH_EVENT, lambda _: self._do(self._pushed))
        memory.listen(DOUBLE_CLICK, lambda _: self._do(self._toggle))
        for name, event in DIAGNOSED.items():
            memory.listen(event, lambda value, what=name: self._do(lambda: self._diagnosed(what, value)))

    def isSafeguardEnabled(self, name: str) -> bool:
        return self._enabled[known(name, "safeguard", self._enabled)]

    def setSafeguardEnabled(self, name: str, enabled: bool) -> None:
        self._enabled[known(name, "safeguard", self._enabled)] = bool(enabled)

    def _do(self, command: Callable[[], Any]) -> None:
        with suppress(SimulationStopped):
            self._runner.execute(command, "life")

    def _fallen(self) -> None:
        if self._enabled[FELL]:
            self._life.alarm("the robot has fallen", self._life.stand_up)

    def _pushed(self) -> None:
        """Activities end; the robot lives on when it stands again."""
        if self._enabled[PUSHED] and self._life.state in ALIVE:
            self._life.alarm("the robot was pushed", self._life.stand_up)

    def _diagnosed(self, what: str, value: Any) -> None:
        critical = bool(value) and value[0] >= CRITICAL
        if critical and self._enabled[what]:
            self._life.alarm(f"{what}: {', '.join(map(str, value[1]))}")
        elif not critical:
            self._life.all_clear()

    def _toggle(self) -> None:
        """Two clicks on the chest button: a robot that lives goes to rest, one that does not begins to live."""
        if not self._life.upright:
            return  # it has fallen on the button
        if self._life.state == DISABLED:
            self._life.set_state(SOLITARY)
        else:
            self._life.set_state(DISABLED)
            self._rest()
