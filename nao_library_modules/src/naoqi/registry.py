"""The connections of this process: one for each address, shared by all who ask for it."""

from __future__ import annotations

import atexit
import gc
import sys
import threading
from types import FunctionType
from typing import Dict, Optional, Tuple

from .errors import BadArguments, RobotUnreachable
from .limits import DEFAULT_TIMING, IDLE_LIMIT, Timing
from .native_threads import wait_until_idle
from .robot_connection import Connection
from .state import State

DEFAULT_PORT = 9559


class Registry:
    """Connections by address."""

    def __init__(self) -> None:
        self._lock = threading.Lock()  # guards both tables
        self._connections: Dict[Tuple[str, int], Connection] = {}
        self._wanted: Dict[Connection, int] = {}
        # From the import on: what a program registers afterwards is called before, and reaches the robot.
        atexit.register(self._end)

    def get(self, host: str, port: int, wait: bool, limit: Optional[float], timing: Optional[Timing]) -> Connection:
        """The connection to an address; see `connection`."""
        with self._lock:
            found: Optional[Connection] = self._connections.get((host, port))
            if found is None or found.state is State.CLOSED:
                self._wanted.pop(found, None)
                found = self._connections[host, port] = Connection(host, port, timing or DEFAULT_TIMING)
            elif timing is not None:
                found.timing = timing
            self._wanted[found] = self._wanted.get(found, 0) + 1
        if wait:
            try:
                found.connect(found.timing.patience if limit is None else limit)
            except RobotUnreachable:
                self._give_up(found)
                raise
        return found

    def close_all(self) -> None:
        """Close every connection."""
        with self._lock:
            connections = list(self._connections.values())
            self._connections.clear()
            self._wanted.clear()
        for each in connections:
            each.close()

    def _end(self) -> None:
        """Close every connection at the end of the program: libqi's threads must not meet one that is taken down."""
        if self._connections:
            _end_objects_of_the_program()
        self.close_all()
        wait_until_idle(IDLE_LIMIT)

    def _give_up(self, connection: Connection) -> None:
        """Close a connection that was never made and that nobody else waits for."""
        with self._lock:
            self._wanted[connection] = self._wanted.get(connection, 1) - 1
            unwanted = self._wanted[connection] <= 0 and connection.generation == 0
            if unwanted:
                del self._wanted[connection]
                self._connections.pop((connection.host, connection.port), None)
        if unwanted:
            connection.close()


def _end_objects_of_the_program() -> None:
    """Let go of the objects that the program keeps in its own module, as Python is about to do.

    What their `__del__` sends reaches the robot: Python calls it when the connections have closed.
    """
    main = vars(sys.modules["__main__"])
    for name in [name for name, value in main.items() if _is_of_the_program(type(value))]:
        main[name] = None
    gc.collect()


def _is_of_the_program(kind: type) -> bool:
    return kind.__module__ == "__main__" or isinstance(getattr(kind, "__del__", None), FunctionType)


_registry = Registry()


def connection(
    ip: str,
    port: int = DEFAULT_PORT,
    *,
    wait: bool = True,
    connect_timeout: Optional[float] = None,
    timing: Optional[Timing] = None,
) -> Connection:
    """The connection to the NAOqi at an address, opened by the first who asks.

    Raises BadArguments if this is no address, RobotUnreachable if the robot is not there (only with `wait`).

    Args:
        ip: Name or IPv4 address of the robot.
        port: TCP port of NAOqi.
        wait: Whether to wait until it stands. Without, it is opened in the background, again and again until
            the robot is there; calls made before then fail at once.
        connect_timeout: Limit of the wait, in s; None: the patience of the connection.
        timing: How patient the connection is, for all who share it; the last that was given counts.
    """
    reason = ""
    if not isinstance(ip, str) or not ip.strip():
        reason = "the first must be the name or IPv4 address of the robot"
    elif isinstance(port, bool) or not isinstance(port, int) or not 0 < port < 65536:
        reason = "the port must be a number from 1 to 65535"
    if reason:
        raise BadArguments("naoqi", "connection", (ip, port), reason=reason)
    return _registry.get(ip.strip(), port, wait, connect_timeout, timing)


def close_all() -> None:
    """Close every connection of this process, as happens by itself at its end."""
    _registry.close_all()
