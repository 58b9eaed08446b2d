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
LONGEST_WORK = 30.0
"""s for which others wait for a piece of work, and a page for what comes of it."""
LONGEST_PAUSE = 2.0
"""s after a piece of work."""
MOST_WORK = 40
"""Pieces of work that wait for their turn."""
RETRY = 2.0
"""s of this computer until what could not begin is tried again."""


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


class Lane:
    """Work that takes the processor, in threads, one piece at a time: many pages keep half a thread busy. Event loop.

    After each piece it pauses for as long as that took, so that Stop gets the interpreter.
    """

    def __init__(self) -> None:
        self._turn = asyncio.Lock()
        self._waiting = 0
        self._pauses_until = 0.0  # by the clock of the loop

    async def do(self, task: Callable[..., Any], *arguments: Any) -> Any:
        """What a function returns, or raises, when its turn has come. Raises NaoError where it takes LONGEST_WORK.

        Also where MOST_WORK wait already.
        """
        if self._waiting >= MOST_WORK:
            raise NaoError("the console has too much to do for pages: try again in a while")
        return await asyncio.shield(self._do(task, arguments))  # goes on, also where whoever waits has gone

    async def _do(self, task: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        self._waiting += 1
        try:
            async with self._turn:
                clock = asyncio.get_running_loop().time
                await asyncio.sleep(self._pauses_until - clock())
                began = clock()
                try:
                    return await asyncio.wait_for(in_background(task, *arguments), LONGEST_WORK)
                finally:
                    self._pauses_until = clock() + min(clock() - began, LONGEST_PAUSE)
        except asyncio.TimeoutError:
            raise NaoError(f"it takes longer than {LONGEST_WORK:g} s, and was given up") from None
        finally:
            self._waiting -= 1


class Takers:
    """Counts who wants something: it begins for the first, and ends behind the last. Any thread."""

    def __init__(self, begin: Callable[[], None], end: Callable[[], None]) -> None:
        self._begin, self._end = begin, end
        self._lock = threading.Lock()
        self._count = 0

    def acquire(self) -> End:
        """One more wants it, until what comes back is called, which may be called twice."""
        with self._lock:
            self._count += 1
            if self._count == 1:
                self._begin()
        given = threading.Lock()  # a lock that is taken once
        return lambda: self._release() if given.acquire(blocking=False) else None

    def _release(self) -> None:
        with self._lock:
            self._count -= 1
            if not self._count:
                self._end()


class Subscriptions:
    """Several, which begin one after the other in the background, and end there. Any thread."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._changed = threading.Condition()
        self._ends: list[End] | None = None

    def begin(self, *starts: Callable[[], End]) -> None:
        """Begin what has not begun; each start returns what ends it, or raises NaoError, and is tried again then."""
        ends: list[End] = []
        with self._changed:
            self._ends = ends

        def run() -> None:
            left = list(starts)
            while left:
                left = [start for start in left if not self._started(start, ends)]
                with self._changed:  # a driver that is not up yet comes later
                    if not left or self._changed.wait_for(lambda: ends is not self._ends, RETRY):
                        return

        threading.Thread(target=run, name=f"{self._name} begin", daemon=True).start()

    def _started(self, start: Callable[[], End], ends: list[End]) -> bool:
        """Whether it has begun, or nobody wants it any more."""
        with self._changed:
            if ends is not self._ends:
                return True
        try:
            end = start()
        except NaoError as error:
            log.debug("%s: %s", self._name, error)
            return False
        except Exception:
            log.exception("%s could not begin", self._name)
            return True
        with self._changed:
            wanted = ends is self._ends
            if wanted:
                ends.append(end)
        if not wanted:
            end()
        return True

    def end(self) -> None:
        """End what has begun."""
        with self._changed:
            ends, self._ends = self._ends or [], None
            self._changed.notify_all()
        threading.Thread(target=lambda: [end() for end in ends], name=f"{self._name} end", daemon=True).start()
