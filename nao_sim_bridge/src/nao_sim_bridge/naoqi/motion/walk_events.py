"""The event of ALMotion about moves that cannot begin, or end before time."""

from __future__ import annotations

from typing import Sequence

from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.walk.locomotion import Locomotion

FAILED = "ALMotion/MoveFailed"
NOT_STARTED, STOPPED = 0, 1


class MoveFailures:
    """Raises `ALMotion/MoveFailed` with [cause, 0 not started or 1 stopped on the way, place of an obstacle or None].

    Args:
        memory: Where events go.
    """

    def __init__(self, memory: MemoryStore) -> None:
        self._memory = memory
        memory.declare_event(FAILED, "ALMotion")

    def watch(self, locomotion: Locomotion) -> None:
        """Tell of the moves of this one; more than once is as good as once. Simulation thread only."""
        if self._tell not in locomotion.failures:
            locomotion.failures.append(self._tell)

    def _tell(self, cause: str, started: bool, obstacle: Sequence[float] | None) -> None:
        place = None if obstacle is None else list(obstacle)
        self._memory.raise_event(FAILED, [cause, STOPPED if started else NOT_STARTED, place])
