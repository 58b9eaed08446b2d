"""The events of ALMotion about falls, pushes, and chains that are kept limp."""

from __future__ import annotations

from typing import Sequence

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.fall_manager import FallState
from nao_sim_bridge.control.balance.push_detection import PushDetector
from nao_sim_bridge.core.diagnosis import LEGS, DiagnosisEffect
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import set_awake

FALLING, FALLEN, STANDS = "ALMotion/RobotIsFalling", "robotHasFallen", "ALMotion/RobotIsStand"
DEVICES, FEATURES = "ALMotion/Protection/DisabledDevicesChanged", "ALMotion/Protection/DisabledFeaturesChanged"
PUSHED, SAFETY, RECOVERY = "ALMotion/RobotPushed", "ALMotion/Safety/RobotPushed", "ALMotion/Safety/PushRecovery"


class _MotionEvents:
    """Raises events when what they are about changes; called after every tick, in the simulation thread."""

    def __init__(self, simulation: Simulation, memory: MemoryStore, events: Sequence[str]) -> None:
        self._simulation = simulation
        self._memory = memory
        for event in events:
            memory.declare_event(event, "ALMotion")


class FallEvents(_MotionEvents):
    """The events about falls and about standing."""

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        super().__init__(simulation, memory, (FALLING, FALLEN, STANDS))
        self._state = FallState.RESTING
        self._stands: bool | None = None

    def __call__(self, _: Snapshot) -> None:
        stability = self._simulation.robot.stability
        before, self._state = self._state, stability.falls.state
        if self._state is not before:
            self._tell(before)
        if stability.on_feet != self._stands:
            self._stands = stability.on_feet
            self._memory.raise_event(STANDS, self._stands)

    def _tell(self, before: FallState) -> None:
        if self._state is FallState.FALLING:
            self._memory.raise_event(FALLING, True)
        elif self._state is FallState.FALLEN and before is FallState.FALLING:
            set_awake(self._memory, False)  # its motors are limp
            self._memory.raise_event(FALLEN, True)


class DiagnosisEvents(_MotionEvents):
    """Runs the diagnosis effect and tells what it has changed: a motor is too hot or broken, or the battery empty."""

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        super().__init__(simulation, memory, (DEVICES, FEATURES))
        self._effect = DiagnosisEffect(lambda: simulation.robot, lambda: set_awake(memory, False))
        self._told: frozenset[str] = frozenset()

    def __call__(self, snapshot: Snapshot) -> None:
        self._effect(snapshot)
        disabled = self._effect.disabled
        if disabled != self._told:
            changed = sorted(disabled ^ self._told)
            self._told = disabled
            self._memory.raise_event(DEVICES, [["Body" if n == LEGS else n, n in disabled] for n in changed])
            features = [[f"{name}Stiffness", name in disabled] for name in changed]
            if LEGS in changed:
                features.append(["Move", LEGS in disabled])
            self._memory.raise_event(FEATURES, features)


class PushEvents(_MotionEvents):
    """The events about pushes, and about balance that takes them up."""

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        super().__init__(simulation, memory, (PUSHED, SAFETY, RECOVERY))
        self._detector = PushDetector(simulation.model.total_mass)

    def __call__(self, snapshot: Snapshot) -> None:
        push = self._detector.look(snapshot, self._stands_still)
        if push is None:
            return
        self._memory.raise_event(PUSHED, [push.angle, push.energy])
        self._memory.raise_event(SAFETY, [push.angle])
        if self._simulation.robot.stability.balance.acting:
            self._memory.raise_event(RECOVERY, [push.angle])

    def _stands_still(self) -> bool:
        robot = self._simulation.robot
        falling = robot.stability.falls.state is FallState.FALLING
        moves = robot.getting_up or robot.walking or robot.motion.tasks() or any(robot.joints.velocities)
        return robot.stability.on_feet and not (falling or moves)
