"""The robot's memory and modules for commands that only look: without a goal, so that one that runs goes on."""

from __future__ import annotations

import fnmatch
import logging
from collections.abc import Sequence
from typing import Any

from naoqi.errors import NaoError

from .errors import CommandFailed, StackMissing

LIMIT = 5.0
"""s that the robot has for an answer."""
MEMORY = "ALMemory"
WILD = "*?["


class RobotLink:
    """A connection to one robot, for a `with` block.

    Args:
        address: IP and port.
        limit: s for the connection and for each answer.
    """

    def __init__(self, address: tuple[str, int], limit: float = LIMIT) -> None:
        self._address = address
        self._limit = limit
        self._proxies: dict[str, Any] = {}

    def __enter__(self) -> RobotLink:
        logging.getLogger("naoqi").addHandler(logging.NullHandler())
        import naoqi

        try:
            naoqi.connection(*self._address, connect_timeout=self._limit)
        except NaoError as error:
            raise StackMissing(str(error)) from None
        return self

    def __exit__(self, *_: object) -> None:
        self._proxies.clear()

    def call(self, module: str, method: str, *arguments: Any) -> Any:
        """Call a method.

        Raises:
            CommandFailed: The robot refuses.
        """
        try:
            return self._proxy(module).call_async(method, *arguments).result(timeout=self._limit)
        except NaoError as error:
            raise CommandFailed(str(error)) from None

    def memory(self, method: str, *arguments: Any) -> Any:
        """Call a method of the memory."""
        return self.call(MEMORY, method, *arguments)

    def memory_names(self) -> list[str]:
        """All keys and events."""
        return sorted({*self.memory("getDataListName"), *self.memory("getEventList")})

    def events(self) -> list[str]:
        """All events."""
        return list(self.memory("getEventList"))

    def matching(self, patterns: Sequence[str]) -> list[str]:
        """Keys and events that patterns mean, in their order; a name without wildcards means itself.

        Raises:
            CommandFailed: A pattern means none.
        """
        names: list[str] = []
        known: list[str] | None = None
        for pattern in patterns:
            if not any(sign in pattern for sign in WILD):
                names.append(pattern)
                continue
            known = self.memory_names() if known is None else known
            found = [name for name in known if fnmatch.fnmatchcase(name, pattern)]
            if not found:
                raise CommandFailed(f"there is no key and no event {pattern}")
            names += found
        return list(dict.fromkeys(names))

    def subscriber(self, event: str) -> Any:
        """Subscriber of an event, as the memory gives it."""
        try:
            return self._proxy(MEMORY).subscriber(event)
        except NaoError as error:
            raise CommandFailed(str(error)) from None

    def _proxy(self, module: str) -> Any:
        import naoqi

        if module not in self._proxies:
            self._proxies[module] = naoqi.ALProxy(module, *self._address, lazy=True)
        return self._proxies[module]
