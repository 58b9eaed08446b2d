"""The events of ALRobotPosture: what the robot's posture has become, looked at about once a second."""

from __future__ import annotations

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.naoqi.memory.store import MemoryStore

POSTURE, FAMILY = "PostureChanged", "PostureFamilyChanged"
MODULE = "ALRobotPosture"
# Simulated time between two looks, s.
PERIOD = 1.0


class PostureEvents:
    """Raises `PostureChanged` and `PostureFamilyChanged`; called after every tick, in the simulation thread.

    Args:
        model: The robot.
        memory: Where events go.
    """

    def __init__(self, model: RobotModel, memory: MemoryStore) -> None:
        self._model = model
        self._memory = memory
        self._due = 0.0
        self._known: dict[str, str] = {}
        for event in (POSTURE, FAMILY):
            memory.declare_event(event, MODULE)

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the robot when it is time to."""
        if snapshot.time < self._due:
            return
        self._due = snapshot.time + PERIOD
        seen = recognise(self._model, snapshot)
        for event, name in ((POSTURE, seen.posture), (FAMILY, seen.family)):
            if self._known.get(event) != name:
                self._known[event] = name
                self._memory.raise_event(event, name)
