"""The robot's memory and modules for commands that only look: without a goal, so that one that runs goes on."""

from __future__ import annotations

import fnmatch
import logging
from collections.abc import Sequence
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ..core.errors import did_you_mean
from .output import CommandFailed, StackMissing

MEMORY = "ALMemory"


class DirectRobot:
    """A connection to one robot, for a `with` block.

    `address`: IP and port. `limit`: s for the connection; None for the patience of the connection.
    """

    def __init__(self, address: tuple[str, int], limit: float | None = None) -> None:
        self._address = address
        self._limit = limit
        self._connection: Any = None
        self._proxies: dict[str, Any] = {}

    def __enter__(self) -> DirectRobot:
        logging.getLogger("naoqi").addHandler(logging.NullHandler())
        import naoqi

        try:
            self._connection = naoqi.connection(*self._address, connect_timeout=self._limit)
        except NaoError as error:
            raise StackMissing(str(error)) from None
        return self

    def __exit__(self, *_: object) -> None:
        self._proxies.clear()

    def has(self, module: str) -> bool:
        """Whether the robot has a module of this name."""
        import naoqi

        try:
            return module in naoqi.connection(*self._address).module_names()
        except NaoError as error:
            raise StackMissing(str(error)) from None

    def call(self, module: str, method: str, *arguments: Any) -> Any:
        """Call a method. Raises CommandFailed if the robot refuses."""
        try:
            return self._proxy(module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)
        except NaoError as error:
            raise CommandFailed(str(error)) from None

    def begin(self, module: str, method: str, *arguments: Any) -> Any:
        """Call a method without waiting; the answer is the `result(timeout)` of what it returns.

        Raises CommandFailed if the robot has no such method.
        """
        try:
            return _Begun(self._proxy(module).call_async(method, *arguments))
        except NaoError as error:
            raise CommandFailed(str(error)) from None

    def services(self) -> list[str]:
        """Names of all services of the robot and of programs. Raises CommandFailed if the robot does not answer."""
        try:
            return sorted(self._connection.module_names())
        except NaoError as error:
            raise CommandFailed(str(error)) from None

    def service(self, name: str) -> Any:
        """A service as libqi gives it. Raises CommandFailed if there is none."""
        try:
            return self._connection.service(name)
        except NaoError as error:
            raise CommandFailed(str(error)) from None

    def memory(self, method: str, *arguments: Any) -> Any:
        return self.call(MEMORY, method, *arguments)

    def value(self, key: str) -> Any:
        """Value of a key. Raises CommandFailed if there is none; the text has the keys that come close."""
        try:
            return self.memory("getData", key)
        except CommandFailed:
            known = self.memory_names()
            if key in known:
                raise
            raise CommandFailed(f"there is no key {key!r}{_instead(key, known)}") from None

    def memory_names(self) -> list[str]:
        """All keys and events."""
        return sorted({*self.memory("getDataListName"), *self.memory("getEventList")})

    def events(self) -> list[str]:
        return list(self.memory("getEventList"))

    def matching(self, patterns: Sequence[str]) -> list[str]:
        """Keys and events that patterns mean, in their order; a name without wildcards means itself.

        Raises CommandFailed if a pattern means none.
        """
        names: list[str] = []
        known: list[str] | None = None
        for pattern in patterns:
            if not _is_pattern(pattern):
                names.append(pattern)
                continue
            known = self.memory_names() if known is None else known
            found = [name for name in known if fnmatch.fnmatchcase(name, pattern)]
            if not found:
                raise CommandFailed(f"there is no key and no event {pattern}{did_you_mean(pattern, known)}")
            names += found
        return list(dict.fromkeys(names))

    def unknown(self, names: Sequence[str]) -> list[str]:
        """What is to be said of names that are neither an event nor a key so far; patterns are none of them."""
        known = self.memory_names()
        plain = [name for name in names if name not in known and not _is_pattern(name)]
        return [f"there is no event and no key {name} so far{did_you_mean(name, known)}" for name in plain]

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


class _Begun:
    """A call that is under way; Ctrl-C while it is waited for cancels it."""

    def __init__(self, call: Any) -> None:
        self._call = call

    def result(self, timeout: float | None = None) -> Any:
        try:
            return self._call.result(timeout=timeout)
        except NaoError as error:
            raise CommandFailed(str(error)) from None
        finally:
            if not self._call.done():
                self._call.cancel()


def _is_pattern(name: str) -> bool:
    return any(sign in name for sign in "*?[")


def _instead(key: str, known: Sequence[str]) -> str:
    """Text to append to "there is no key ...": keys that come close, and how to see those that it is a part of."""
    hint, parts = did_you_mean(key, known), [name for name in known if key in name]
    if not parts:
        return hint
    return f"{hint or ':'}{' or' if hint else ''} one of the {len(parts)} of nao get '*{key}*'?"
