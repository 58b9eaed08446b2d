"""Opening libqi sessions within a bounded time."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Dict

import qi

from .calls import RUNNING
from .errors import RobotUnreachable
from .translate import connect_reason

QUIET_LIBQI = "qi.path.sdklayout=0"
"""libqi warns that it found no SDK around it; a program that only talks to a robot needs none."""


@dataclass(eq=False)
class Live:
    """One session from its connection to its loss. A session cannot be used again, so each has its own.

    Attributes:
        session: The `qi.Session`.
        heartbeat: The remote method that is called as heartbeat.
        broken: Set when libqi reports the end of the session, and when the program closes it.
        services: Remote objects found so far, by name.
    """

    session: Any
    heartbeat: Any
    broken: threading.Event
    services: Dict[str, Any] = field(default_factory=dict)

    def close(self) -> None:
        """End the session: calls under way fail, also when the robot is silent."""
        close_quietly(self.session)


def new_session() -> Any:
    """A `qi.Session` that is not connected."""
    qi.logging.setFilters(QUIET_LIBQI)
    return qi.Session()


def open_live(host: str, port: int, limit: float, announce: Callable[[Any], None]) -> Live:
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
    broken = threading.Event()
    session = new_session()
    session.disconnected.connect(lambda _reason: broken.set())
    announce(session)
    try:
        connect_session(session, host, port, limit)
        future = session.service("ServiceDirectory", _async=True)
        directory = _value(future, host, port, deadline - time.monotonic())
        return Live(session, directory.machineId, broken)
    except RobotUnreachable:
        session.close()
        raise
    except (RuntimeError, AttributeError) as error:
        session.close()
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
