"""Passwords that are looked at: beside the event loop, and such that strangers hold up nobody but each other."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor

from .sessions import Session, Sessions

WORKERS = 2
"""Passwords that are looked at side by side: each takes 16 MiB."""
MOST_WAITING = 5
"""Tries of one source that wait for their turn; more are refused at once."""


class Logins:
    """Takes the tries of each source one after the other, so that a source with many waits for itself. Event loop."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions
        self._threads = ThreadPoolExecutor(WORKERS, "login")
        self._turns: dict[str, asyncio.Lock] = {}
        self._waiting: dict[str, int] = {}

    async def by_password(self, name: str, password: str, address: str, device: str) -> Session | None:
        """A new session, or None; see `Sessions.by_password`."""
        source = self._sessions.source_of(name, address, device)
        if self._waiting.get(source, 0) >= MOST_WAITING:
            return None
        self._waiting[source] = self._waiting.get(source, 0) + 1
        try:
            async with self._turns.setdefault(source, asyncio.Lock()):
                return await asyncio.get_running_loop().run_in_executor(
                    self._threads, self._sessions.by_password, name, password, source
                )
        finally:
            self._waiting[source] -= 1
            if not self._waiting[source]:
                del self._waiting[source], self._turns[source]
