"""The events of ALMotion about chains that are kept limp: a motor is too hot or broken, or the battery is empty."""

from __future__ import annotations

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.diagnosis import LEGS, DiagnosisEffect
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import AWAKE

DEVICES, FEATURES = "ALMotion/Protection/DisabledDevicesChanged", "ALMotion/Protection/DisabledFeaturesChanged"


class DiagnosisEvents:
    """Runs the diagnosis effect and tells what it has changed; called after every tick, in the simulation thread.

    Args:
        simulation: Of the robot that it looks at.
        memory: Where events go.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        self._memory = memory
        self._effect = DiagnosisEffect(lambda: simulation.robot, self._rested)
        self._told: frozenset[str] = frozenset()
        for event in (DEVICES, FEATURES):
            memory.declare_event(event, "ALMotion")

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the robot."""
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

    def _rested(self) -> None:
        if self._memory.get(AWAKE):
            self._memory.raise_event(AWAKE, False)
