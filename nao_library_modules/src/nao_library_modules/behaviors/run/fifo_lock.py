"""Whose turn it is with a server: it runs one goal at a time, and a further one would end the first."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Tuple

from ...process_modules.language.flow import wait_until
from ...process_modules.language.fluents import Fluent
from ..language.model import PathParts

Ticket = Tuple[float, Tuple[int, ...], object]


class FifoLock:
    """A turn with each of several servers; who came first is first, at the same time by the order of the file."""

    def __init__(self, servers: Iterable[str]) -> None:
        # (ticket of who has the turn or None, tickets of who waits)
        self._queues = {server: Fluent(f"turn with {server}", (None, ())) for server in servers}

    @contextmanager
    def of(self, server: str, now: float, path: PathParts) -> Iterator[None]:
        """Have the turn with a server in a block; waits for it, in a plan. `now`: time of asking, s."""
        queue = self._queues[server]
        ticket = (now, tuple(number for _, number in path), object())

        def take(state: Any) -> Any:
            holder, waiting = state
            if holder is None and min(waiting, key=lambda each: each[:2]) is ticket:
                return ticket, tuple(each for each in waiting if each is not ticket)
            return state

        def leave(state: Any) -> Any:
            holder, waiting = state
            return None if holder is ticket else holder, tuple(each for each in waiting if each is not ticket)

        queue.update(lambda state: (state[0], (*state[1], ticket)))
        try:
            wait_until(lambda: queue.update(take)[0] is ticket, [queue])
            yield
        finally:
            queue.update(leave)
