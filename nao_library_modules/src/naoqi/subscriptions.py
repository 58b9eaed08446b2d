"""Event subscriptions made through ALMemory, so that they can be made again after a loss."""

from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING, Any, Collection, Dict, Set, Tuple

from .errors import NaoError, RobotUnreachable, UnknownModule
from .limits import ANSWER_LIMIT
from .remote import RemoteMethod, RemoteModule
from .worker import Worker

if TYPE_CHECKING:
    from .robot_connection import Connection, State

logger = logging.getLogger("naoqi")

MEMORY = "ALMemory"
ENDED_BY = {"unsubscribeToEvent": "subscribeToEvent", "unsubscribeToMicroEvent": "subscribeToMicroEvent"}
OBSERVED_METHODS = frozenset(ENDED_BY) | frozenset(ENDED_BY.values())

Key = Tuple[str, str, str]
"""Subscribing method, event, module."""


class EventSubscriptions:
    """What this process has subscribed to over one connection: a robot that comes back has forgotten it.

    Those of the modules of this process are renewed by the broker that serves the module, after it has
    registered it; all others as soon as the robot is back.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._memory = RemoteModule(MEMORY, connection, ANSWER_LIMIT)
        self._lock = threading.Lock()  # guards the table
        self._arguments: Dict[Key, Tuple[Any, ...]] = {}
        self._owned: Set[str] = set()
        self._worker = Worker(f"naoqi subscriptions {connection.address}")
        connection.add_listener(self._on_state)

    def __len__(self) -> int:
        return len(self._arguments)

    def concerns(self, module: str, method: str) -> bool:
        """Whether calls of this method are to be taken down."""
        return module == MEMORY and method in OBSERVED_METHODS

    def note(self, method: str, arguments: Tuple[Any, ...]) -> None:
        """Take down a call that succeeded.

        `method`: one of `OBSERVED_METHODS`. `arguments`: event, module, and for a subscription what else it had.
        """
        event, module = arguments[:2]
        with self._lock:
            if method in ENDED_BY:
                self._arguments.pop((ENDED_BY[method], event, module), None)
                return
            self._arguments[method, event, module] = arguments

    def own(self, module: str) -> None:
        """Leave the subscriptions of this module to the broker that serves it."""
        with self._lock:
            self._owned.add(module)

    def forget_module(self, module: str) -> None:
        """Drop the subscriptions of a module that is served no more."""
        with self._lock:
            self._arguments = {key: value for key, value in self._arguments.items() if key[2] != module}
            self._owned.discard(module)

    def renew(self, modules: Collection[str]) -> None:
        """Subscribe these modules again; what fails is logged, and tried again after the next loss."""
        with self._lock:
            entries = [item for item in self._arguments.items() if item[0][2] in modules]
        if not entries or not self._memory_is_there():
            return
        done = 0
        for (method, event, module), arguments in entries:
            try:
                RemoteMethod(self._memory, method)(*arguments)
                done += 1
            except NaoError as error:
                logger.error("event %s is not subscribed again for module %s: %s", event, module, error)
        if done:
            logger.warning("NAOqi at %s: %d event subscriptions made again", self._connection.address, done)

    def _on_state(self, state: State) -> None:
        if state == "closed":
            self._worker.close()
        elif state == "connected" and self._connection.generation > 1:
            with self._lock:
                foreign = {key[2] for key in self._arguments} - self._owned
            if foreign:
                self._worker.submit(lambda: self.renew(foreign))

    def _memory_is_there(self) -> bool:
        """Wait for ALMemory: a robot that boots can be reached long before it has all its modules.

        Returns False if the connection is lost before that; then the next one brings a new attempt.
        """
        delay = 0.1
        while True:
            live = self._connection.live
            try:
                self._memory.service()
                return True
            except UnknownModule:
                if live is None or live.broken.wait(delay):
                    return False
                delay = min(2.0 * delay, 2.0)
            except RobotUnreachable:
                return False
