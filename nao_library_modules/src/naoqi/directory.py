"""Questions to the directory of the robot's modules."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, List

from .errors import NaoError, RobotUnreachable
from .session import Live, answered
from .translate import is_unknown_service, unknown_module

if TYPE_CHECKING:
    from .robot_connection import Connection

READY_LIMIT = 1.0
"""So long a module that is known may take until it can be called, in s."""
START_LIMIT = 0.5
"""So long after the connection a module may appear, in s: a robot that starts registers one after the other."""


def module_names(connection: Connection, live: Live) -> List[str]:
    """Names of all modules the robot has.

    Raises:
        RobotUnreachable: If it does not say.
    """
    future = live.session.services(_async=True)
    if not answered(future, connection.timing.connect_limit) or future.hasError():
        raise connection.unreachable()
    return [each["name"] for each in future.value()]


def find_module(connection: Connection, live: Live, name: str) -> Any:
    """The remote object of a module.

    Raises:
        RobotUnreachable: If the connection does not let us ask.
        UnknownModule: If the robot has no module of that name.
        NaoError: If it has one that cannot be called.
    """
    end, delay = time.monotonic() + READY_LIMIT, 0.005
    while True:
        future = live.session.service(name, _async=True)
        if not answered(future, connection.timing.connect_limit):
            reason = f"no answer to the question where module {name} is"
            raise RobotUnreachable(connection.host, connection.port, reason)
        if not future.hasError():
            return future.value()
        text = future.error().strip()
        if is_unknown_service(text):
            if time.monotonic() < live.connected_at + START_LIMIT and not live.broken.wait(delay):
                continue
            raise unknown_module(name, connection.host, connection.port, module_names(connection, live))
        if live is not connection.live or not live.session.isConnected():
            raise connection.unreachable()
        # A module that has only just arrived, or that leaves right now.
        if time.monotonic() >= end or live.broken.wait(delay):
            raise NaoError(f"NAOqi at {connection.address} gave no access to module {name}: {text}")
        delay *= 2.0
