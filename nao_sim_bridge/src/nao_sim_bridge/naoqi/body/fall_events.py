"""The events of ALMotion about falls and about standing."""

from __future__ import annotations

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.fall_manager import FallState
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import AWAKE

FALLING, FALLEN, STANDS = "ALMotion/RobotIsFalling", "robotHasFallen", "ALMotion/RobotIsStand"


class FallEvents:
    """Raises the events when what they are about changes; called after every tick, in the simulation thread.

    Args:
        simulation: Of the robot that it looks at.
        memory: Where events go.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        self._simulation = simulation
        self._memory = memory
        self._state = FallState.RESTING
        self._stands: bool | None = None
        for event in (FALLING, FALLEN, STANDS):
            memory.declare_event(event, "ALMotion")

    def __call__(self, _: Snapshot) -> None:
        """Look at the robot."""
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
            if self._memory.get(AWAKE):  # its motors are limp
                self._memory.raise_event(AWAKE, False)
            self._memory.raise_event(FALLEN, True)
