"""Opening libqi sessions within a bounded time."""

from __future__ import annotations

import contextlib
import threading
import time
from typing import Any, Callable, Dict

import qi

from .calls import RUNNING
from .errors import RobotUnreachable
from .translate import connect_reason

QUIET_LIBQI = "qi.path.sdklayout=0"
"""libqi warns that it found no SDK around it; a program that only talks to a robot needs none."""


class Live:
    """One session from its making to its loss. A session cannot be used again, so each has its own.

    Attributes:
        session: The `qi.Session`.
        heartbeat: The remote method that is called as heartbeat; None until it is connected.
        broken: Set when libqi reports the end of the session, and when the program wants it.
        services: Remote objects found so far, by name.
        connected_at: Monotonic time of its connection, in s.
    """

    def __init__(self, on_break: Callable[[], None] = lambda: None) -> None:
        """Make a session that is not connected.

        Args:
            on_break: Called in a thread of libqi when the connection breaks; not when `close` ends it.
        """
        qi.logging.setFilters(QUIET_LIBQI)
        self.session = qi.Session()
        self.heartbeat: Any = None
        self.broken = threading.Event()
        self.services: Dict[str, Any] = {}
        self.connected_at = 0.0
        self._on_break = on_break
        self._link = self.session.disconnected.connect(self._break)

    def close(self) -> None:
        """End the session: calls under way fail, also when the robot is silent."""
        # A program that ends must not be called back by libqi any more; a session that was never connected, or
        # is broken already, has nothing to take back and says so.
        with contextlib.suppress(RuntimeError):
            self.session.disconnected.disconnect(self._link)
        self.session.close()

    def _break(self, _reason: str) -> None:
        self.broken.set()
        self._on_break()


def open_live(host: str, port: int, limit: float, announce: Callable[[Live], None]) -> Live:
    """Connect to the NAOqi at an address.

    Args:
        host: Name or address of the robot.
        port: TCP port of NAOqi.
        limit: The attempt is given up after this time, in s.
        announce: Called with the session before it connects: closing it breaks the attempt off, and so does
            a `RobotUnreachable` raised here.

    Raises:
        RobotUnreachable: If no NAOqi answers there.
    """
    deadline = time.monotonic() + limit
    live = Live()
    announce(live)
    try:
        connect_session(live.session, host, port, limit)
        future = live.session.service("ServiceDirectory", _async=True)
        directory = _value(future, host, port, deadline - time.monotonic())
        live.heartbeat = directory.machineId
        live.connected_at = time.monotonic()
        return live
    except RobotUnreachable:
        live.close()
        raise
    except (RuntimeError, AttributeError) as error:
        live.close()
        reason = f"what answers there is no NAOqi ({error})"
        raise RobotUnreachable(host, port, reason, "that this is the port of NAOqi") from error


def connect_session(session: Any, host: str, port: int, limit: float) -> None:
    """Connect a session.

    Raises:
        RobotUnreachable: If no NAOqi answers there within the limit (s).
    """
    _value(session.connect(f"tcp://{host}:{port}", _async=True), host, port, limit)


def answered(future: Any, limit: float) -> bool:
    """Wait for a future.

    Asked twice: a program that was itself stopped for a while finds the limit over and the answer waiting,
    and needs only a moment to read it.

    Returns:
        Whether it is finished; False when the limit (s) is over.
    """
    for part in (0.8, 0.2):
        if future.wait(max(0, int(1000.0 * part * limit))) != RUNNING:
            return True
    return False


def _value(future: Any, host: str, port: int, limit: float) -> Any:
    if not answered(future, limit):
        reason = f"no answer as NAOqi would give it within {limit:.1f} s"
        raise RobotUnreachable(host, port, reason, "that the robot is on, and that this is the port of NAOqi")
    if future.hasError():
        raise RobotUnreachable(host, port, *connect_reason(future.error()))
    return future.value()
