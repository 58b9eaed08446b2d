"""Keys of the robot's memory as topics of the driver's nao_memory; watched only while somebody wants them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError

from ...base.suggestion import did_you_mean
from .latched import Latched

FLOAT, TEXT = "float", "string"
NOTHING = "null"
"""JSON of a key without a value."""
RATE = 10.0
"""Hz, at most so many messages of a key."""


class MemoryTopics:
    """The memory of one robot. Any thread; `watch` and what it returns call services and may take a while."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._lock = threading.Lock()
        self._own: dict[str, int] = {}  # key -> how many watch it; of those that nobody else has watched

    def watch(self, key: str, kind: str, callback: Callable[[Any], None]) -> Callable[[], None]:
        """Have messages of a key: FloatStamped for FLOAT (whole numbers and truth values too), StringStamped for TEXT.

        Returns what ends it. Raises NaoError if there is no nao_memory, or no such key.
        """
        from nao_library_msgs.msg import FloatStamped, StringStamped
        from nao_library_msgs.srv import ListMemory, WatchMemory

        if any(sign in key for sign in "*?[") or not key:
            raise NaoError(f"{key!r} is no key: one key, without * and ?")
        before = self._robot.call("nao_memory/list", ListMemory, pattern=key)
        if not before.keys:
            known = self._robot.call("nao_memory/list", ListMemory, pattern="").keys
            raise NaoError(f"the robot's memory has no key {key!r}{did_you_mean(key, known)}")
        watched = bool(before.topics and before.topics[0])
        answer = self._robot.call("nao_memory/watch", WatchMemory, pattern=key, rate=RATE, type=kind)
        topic = next(iter(answer.topics), "")
        if not topic:
            raise NaoError(f"{key}: {answer.message or 'it has no topic'}")
        with self._lock:
            own = key in self._own or not watched
            if own:
                self._own[key] = self._own.get(key, 0) + 1
        end = self._robot.topic(topic, FloatStamped if kind == FLOAT else StringStamped, callback)

        def leave() -> None:
            end()
            if own:
                self._leave(key)

        return leave

    def watch_last(self, key: str, last: Latched, callback: Callable[[Any], None]) -> Callable[[], None]:
        """As `watch`, a key of texts that holds what happened last: whether it holds anything yet is asked before."""
        from nao_library_msgs.srv import GetMemory

        answer = self._robot.call("nao_memory/get", GetMemory, pattern=key)
        last.held = any(value != NOTHING for value in answer.values)
        return self.watch(key, TEXT, callback)

    def _leave(self, key: str) -> None:
        from nao_library_msgs.srv import UnwatchMemory

        with self._lock:
            self._own[key] -= 1
            if self._own[key]:
                return
            del self._own[key]
        try:
            self._robot.call("nao_memory/unwatch", UnwatchMemory, pattern=key)
        except NaoError:
            pass  # the driver has ended, and its watch with it
