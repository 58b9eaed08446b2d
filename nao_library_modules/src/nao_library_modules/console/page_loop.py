"""Pages in an event loop of their own: whatever holds them up, the loop in front of them goes on."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable
from typing import Any

THREAD = "pages"
"""Of the thread."""
LOOK_PERIOD = 0.25
"""s between two signs of life of the loop."""
SILENT = 1.5
"""s without one, after which the pages do not answer."""


class PageLoop:
    """ASGI application that runs another one in an event loop of its own thread.

    `app`: the other one.
    """

    def __init__(self, app: Any) -> None:
        self.app = app
        self._loop = asyncio.new_event_loop()
        self._lived = time.monotonic()
        self._loop.call_soon(self._live)
        threading.Thread(target=self._loop.run_forever, name=THREAD, daemon=True).start()

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Have one connection answered."""
        here = asyncio.get_running_loop()
        await _in_loop(self._loop, self.app, scope, _called_in(here, receive), _called_in(here, send))

    def answers(self) -> bool:
        """Whether the loop takes its turns. Any thread."""
        return time.monotonic() - self._lived < SILENT

    def _live(self) -> None:
        self._lived = time.monotonic()
        self._loop.call_later(LOOK_PERIOD, self._live)

    def close(self) -> None:
        """End the loop, behind the last connection."""
        self._loop.call_soon_threadsafe(self._loop.stop)


def _called_in(loop: asyncio.AbstractEventLoop, call: Callable[..., Awaitable[Any]]) -> Callable[..., Awaitable[Any]]:
    return lambda *arguments: _in_loop(loop, call, *arguments)


async def _in_loop(loop: asyncio.AbstractEventLoop, call: Callable[..., Any], *arguments: Any) -> Any:
    """Wait in this loop for what is done in another one; a cancel ends it there."""
    return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(call(*arguments), loop))
