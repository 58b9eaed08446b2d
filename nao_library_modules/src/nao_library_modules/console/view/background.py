"""What waits for the ROS master is done in threads of its own: never in the event loop, which carries the stop as well.

Such a thread may wait for as long as the master is away; it is a daemon, so that it holds up no end of the program.
"""

from __future__ import annotations

import asyncio
import logging
import threading
from typing import Any, Callable

from naoqi.errors import NaoError

log = logging.getLogger(__name__)

End = Callable[[], None]


async def in_background(task: Callable[..., Any], *arguments: Any) -> Any:
    """What a function returns, or raises, that is called in a thread of its own."""
    loop = asyncio.get_running_loop()
    future: asyncio.Future[Any] = loop.create_future()

    def finish(result: Any, error: BaseException | None) -> None:
        if future.done():
            return  # whoever waited has gone
        if error is None:
            future.set_result(result)
        else:
            future.set_exception(error)

    def run() -> None:
        result, error = None, None
        try:
            result = task(*arguments)
        except Exception as raised:
            error = raised
        try:
            loop.call_soon_threadsafe(finish, result, error)
        except RuntimeError:
            pass  # the loop has ended

    threading.Thread(target=run, name=getattr(task, "__name__", "task"), daemon=True).start()
    return await future


class Subscriptions:
    """Several, which begin one after the other in the background, and end there. Any thread."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._lock = threading.Lock()
        self._ends: list[End] | None = None

    def begin(self, *starts: Callable[[], End]) -> None:
        """Begin what has not begun; each start returns what ends it, or raises NaoError, which is logged."""
        ends: list[End] = []
        with self._lock:
            self._ends = ends

        def run() -> None:
            for start in starts:
                with self._lock:
                    if ends is not self._ends:
                        return
                try:
                    end = start()
                except NaoError as error:
                    log.info("%s: %s", self._name, error)
                    continue
                with self._lock:
                    late = ends is not self._ends
                    if not late:
                        ends.append(end)
                if late:  # nobody wants it any more
                    end()

        threading.Thread(target=run, name=f"{self._name} begin", daemon=True).start()

    def end(self) -> None:
        """End what has begun."""
        with self._lock:
            ends, self._ends = self._ends or [], None
        threading.Thread(target=lambda: [end() for end in ends], name=f"{self._name} end", daemon=True).start()
