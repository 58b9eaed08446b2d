"""ALDiagnosis of the simulated robot and its events."""

from __future__ import annotations

from typing import Iterable, Sequence

from nao_sim_bridge.body.faults import CRITICAL, NEGLIGIBLE, Faults, severity
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.sequences import STIFFEN_TIME
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALDiagnosis"
ACTIVE, PASSIVE = "ActiveDiagnosisErrorChanged", "PassiveDiagnosisErrorChanged"
BOTH, READY, FINISHED = (
    f"{NAME}/{event}" for event in ("DiagnosisErrorChanged", "RobotIsReady", "ActiveDiagnosisFinished")
)
# The active diagnosis looks for the current of the motors this long after they were told to be stiff, s.
TRY_TIME = STIFFEN_TIME + 0.1
NOTHING = (NEGLIGIBLE, ())


class ALDiagnosis:
    """ALDiagnosis as the simulated robot offers it.

    Called after every tick: it runs the active diagnosis when the robot wakes up or rests, and tells results. These are
    pairs of the severity of the worst failure and the names of all devices that have failed: motors that gave no torque
    when they were tried last (active), sensors that do not answer (passive), and both together.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        self._enabled = True
        self._active = self._passive = self._both = NOTHING
        self._simulation = simulation
        self._memory = memory
        self._seen: tuple = (None, None)
        self._try_at: tuple[float, str] | None = None
        for event in (ACTIVE, PASSIVE, BOTH, READY, FINISHED):
            memory.declare_event(event, NAME)
        memory.listen("ALMotion/Stiffness/wakeUpStarted", lambda _: self._begin("wakeUp", TRY_TIME))
        memory.listen("ALMotion/Stiffness/restStarted", lambda _: self._begin("rest", 0.0))

    def getActiveDiagnosis(self) -> list:
        return severity_value(*self._active)

    def getPassiveDiagnosis(self) -> list:
        return severity_value(*self._passive)

    def getDiagnosisStatus(self) -> list:
        return severity_value(*self._both)

    def isNotificationEnabled(self) -> bool:
        return self._enabled

    def setEnableNotification(self, enable: bool) -> None:
        self._enabled = enable

    def __call__(self, snapshot: Snapshot) -> None:
        """Try motors that are due, and look whether anything failed or was repaired."""
        faults = self._simulation.robot.faults
        if self._try_at is not None and snapshot.time >= self._try_at[0]:
            self._try(faults, self._try_at[1])
        if faults.found is self._seen[0] and faults.sensors is self._seen[1]:
            return
        first = self._seen[0] is None
        self._seen = (faults.found, faults.sensors)
        names = [joint.name for joint in self._simulation.model.joints]
        motors = [names[index] for index in sorted(faults.found)]
        sensors = [name for name in faults.known if name in faults.sensors]
        self._tell(_result(motors), _result(sensors), _result([*motors, *sensors]))
        if first:
            self._memory.raise_event(READY, self._both[0] < CRITICAL)

    def _begin(self, occasion: str, delay: float) -> None:
        """Called in the simulation thread, in which the robot wakes up and rests."""
        self._try_at = (self._simulation.time + delay, occasion)

    def _try(self, faults: Faults, occasion: str) -> None:
        self._try_at = None
        faults.try_motors(self._simulation.robot.joints.stiffnesses)
        if self._enabled:
            self._memory.raise_event(FINISHED, occasion)

    def _tell(self, *now: tuple) -> None:
        before = (self._active, self._passive, self._both)
        self._active, self._passive, self._both = now
        for event, old, new in zip((ACTIVE, PASSIVE, BOTH), before, now):
            if new != old and self._enabled:
                self._memory.raise_event(event, severity_value(*new))


def severity_value(severity: int, names: Sequence[str]) -> list:
    """[severity, [names]]: how bad something is, and what has it, as answers and events of NAOqi tell it."""
    return [severity, list(names)]


def _result(devices: Iterable[str]) -> tuple[int, tuple[str, ...]]:
    failed = tuple(devices)
    return max(map(severity, failed), default=NEGLIGIBLE), failed
