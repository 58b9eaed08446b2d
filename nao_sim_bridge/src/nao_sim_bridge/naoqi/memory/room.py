"""How much of a robot's memory clients may fill: bytes, and keys and subscriptions. What the robot writes is free."""

from __future__ import annotations

import sys
from typing import Any, Deque, Hashable, Tuple

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

OVERHEAD = 1000
"""Bytes of a key or a subscription beside its texts."""

History = Deque[Tuple[Any, float, int]]
"""Values with the time of each in s, and the bytes of those that clients wrote; 0 for the robot's own."""


class MemoryRoom:
    """Counts what clients have in a memory. Not thread-safe: the memory has a lock."""

    def __init__(self) -> None:
        self._sizes = load_sizes().memory
        self._bytes = 0
        self._held: dict[Hashable, int] = {}

    def hold(self, holder: Hashable, *texts: Any) -> None:
        """Count a key, a subscription or what else a client makes, with its texts; again with others of the same one.

        A NaoqiError when there are too many.
        """
        size, former = OVERHEAD + size_of(texts), self._held.get(holder)
        if former is None and len(self._held) >= self._sizes.keys:
            raise NaoqiError(f"clients have {len(self._held)} keys and subscriptions: {self._sizes.keys} at most")
        self._require(size - (former or 0))
        self._bytes += size - (former or 0)
        self._held[holder] = size

    def release(self, holder: Hashable) -> None:
        """Count it no more."""
        self._bytes -= self._held.pop(holder, 0)

    def make(self, history: History, size: int) -> None:
        """Make room for a value of a client: where there is none, the oldest values of the same key go.

        A NaoqiError when there would not be enough.
        """
        self._require(size - sum(entry[2] for entry in history))
        while self._bytes + size > self._sizes.bytes:
            self._bytes -= history.popleft()[2]

    def add(self, history: History, value: Any, time: float, size: int) -> None:
        """Put a value into the history of its key, which drops the oldest one when it is full."""
        if len(history) == history.maxlen:
            self._bytes -= history[0][2]
        history.append((value, time, size))
        self._bytes += size

    def forget(self, history: History) -> None:
        self._bytes -= sum(entry[2] for entry in history)

    def _require(self, more: int) -> None:
        if self._bytes + more > self._sizes.bytes:
            raise NaoqiError(
                f"clients have {self._bytes} bytes in the memory, and this is {more} more: {self._sizes.bytes} at most"
            )


def size_of(value: Any) -> int:
    """Bytes of a value with all that is in it; what is in it twice counts twice."""
    size, waiting = 0, [value]
    while waiting:
        one = waiting.pop()
        size += sys.getsizeof(one)
        if isinstance(one, dict):
            waiting += one.keys()
            waiting += one.values()
        elif isinstance(one, (list, tuple)):
            waiting += one
    return size
