"""What an extractor saw last: its event, raised with each picture in which something is, and emptied afterwards."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.naoqi.memory.store import MemoryStore


class Sight:
    """The event of one extractor. Used by its watching only, so in one thread at a time.

    Args:
        tell_end: Also tell subscribers when nothing is seen any more, with an empty list; else that is only written,
            for those who read the key.
    """

    def __init__(self, memory: MemoryStore, event: str, tell_end: bool) -> None:
        self._memory = memory
        self._event = event
        self._tell_end = tell_end
        self._something = False
        memory.put_quietly(event, [])

    def show(self, value: list[Any]) -> None:
        self._something = True
        self._memory.raise_event(self._event, value)

    def nothing(self) -> None:
        if self._something and self._tell_end:
            self._memory.raise_event(self._event, [])
        elif self._something:
            self._memory.put_quietly(self._event, [])
        self._something = False
