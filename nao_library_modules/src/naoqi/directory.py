"""Queries to the service directory of the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List

from .errors import NaoError, RobotUnreachable
from .limits import ANSWER_LIMIT, FIRST_MODULE_LIMIT, READY_LIMIT, START_LIMIT
from .session import Live
from .translate import is_unknown_service, unknown_module

if TYPE_CHECKING:
    from .robot_connection import Connection


def module_names(connection: Connection, live: Live) -> List[str]:
    """Names of all modules of the robot. Raises RobotUnreachable if it does not answer."""
    future = live.session.services(_async=True)
    if not connection.answered(future, ANSWER_LIMIT) or future.hasError():
        raise connection.unreachable()
    return [each["name"] for each in future.value()]


def find_module(connection: Connection, live: Live, name: str) -> Any:
    """The remote object of a module.

    Raises RobotUnreachable if the connection does not answer, UnknownModule if the robot has no module of that name,
    NaoError if the module exists but cannot be called.
    """
    end, delay = connection.answering_time() + READY_LIMIT, 0.005
    while True:
        future = live.session.service(name, _async=True)
        if not connection.answered(future, ANSWER_LIMIT):
            if live is not connection.live:
                raise connection.unreachable()
            reason = f"no answer to the question where module {name} is"
            raise RobotUnreachable(connection.host, connection.port, reason)
        if not future.hasError():
            return future.value()
        text = future.error().strip()
        if is_unknown_service(text):
            names = module_names(connection, live)
            # It may also have appeared between the two questions.
            starting = name in names or not any(each.startswith("AL") for each in names)
            limit = FIRST_MODULE_LIMIT if starting else START_LIMIT
            if connection.answering_time() < live.connected_at + limit and not live.broken.wait(delay):
                continue
            raise unknown_module(name, connection.host, connection.port, names)
        if live is not connection.live or not live.session.isConnected():
            raise connection.unreachable()
        # The module has just been registered, or is being unregistered.
        if connection.answering_time() >= end or live.broken.wait(delay):
            raise NaoError(f"NAOqi at {connection.address} gave no access to module {name}: {text}")
        delay *= 2.0
