"""The event of ALFsr about the ground under the feet."""

from __future__ import annotations

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.naoqi.memory.live_keys import CONTACT_LOAD
from nao_sim_bridge.naoqi.memory.store import MemoryStore

CONTACT = "footContactChanged"
# Contact is won or lost when it has been so for this time, s: feet bounce.
STEADY_TIME = 0.1


class FootEvents:
    """Raises `footContactChanged`; called after every tick, in the simulation thread.

    Args:
        memory: Where events go.
    """

    def __init__(self, memory: MemoryStore) -> None:
        self._memory = memory
        self._touches: bool | None = None
        self._differs_since: float | None = None
        memory.declare_event(CONTACT, "ALFsr")

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the robot."""
        touches = max(snapshot.foot_loads) > CONTACT_LOAD
        if touches == self._touches:
            self._differs_since = None
            return
        if self._differs_since is None:
            self._differs_since = snapshot.time
        if self._touches is None or snapshot.time - self._differs_since >= STEADY_TIME:
            self._touches, self._differs_since = touches, None
            self._memory.raise_event(CONTACT, touches)
