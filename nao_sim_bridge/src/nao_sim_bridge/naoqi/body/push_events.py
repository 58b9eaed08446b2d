"""The events of ALMotion about pushes, and about balance that takes them up."""

from __future__ import annotations

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.fall_manager import FallState
from nao_sim_bridge.control.balance.push_detection import PushDetector
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore

PUSHED, SAFETY, RECOVERY = "ALMotion/RobotPushed", "ALMotion/Safety/RobotPushed", "ALMotion/Safety/PushRecovery"


class PushEvents:
    """Raises the events; called after every tick, in the simulation thread.

    Args:
        simulation: Of the robot that it looks at.
        memory: Where events go.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        self._simulation = simulation
        self._memory = memory
        self._detector = PushDetector(simulation.model.total_mass)
        for event in (PUSHED, SAFETY, RECOVERY):
            memory.declare_event(event, "ALMotion")

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the robot."""
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
        moves = robot.getting_up or robot.locomotion.active or robot.motion.tasks() or any(robot.joints.velocities)
        return robot.stability.on_feet and not (falling or moves)
