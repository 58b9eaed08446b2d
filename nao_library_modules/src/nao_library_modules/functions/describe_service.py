"""The service that tells what the functions of a server are: from descriptions to messages."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

from nao_library_msgs.msg import ArgumentDescription, FunctionDescription
from nao_library_msgs.srv import DescribeFunctionsResponse

from .describe import Argument, Described, Description


class DescribeService:
    """Answers for one server. Clients come in threads of their own; the lock lets them in one after the other.

    ROS API:
        Service `NAME/describe` (nao_library_msgs/DescribeFunctions), NAME the name of the action.
    """

    def __init__(
        self, describe: Callable[[], Description], robot: Any, running: Callable[[], tuple[Sequence[str], int]]
    ) -> None:
        """Keep what it tells of; nothing is worked out before somebody asks.

        Args:
            describe: Makes the description; called once.
            robot: Proxies and connection; None: there is none.
            running: The functions of the goal that runs, and the index of the one that does.
        """
        self._description = lru_cache(maxsize=None)(describe)
        self._robot = robot
        self._running = running
        self._lock = threading.Lock()

    def answer(self, request: Any) -> Any:
        running, index = self._running()
        robot = self._robot
        with self._lock:
            description = self._description()
            response = DescribeFunctionsResponse(
                action=description.action,
                message=description.message,
                help=description.help,
                robot="" if robot is None else str(robot.address),
                connected=robot is not None and robot.connection.state == "connected",
                running=list(running),
                index=index,
            )
            if not request.without_functions:
                described = description.functions(request.functions, not request.without_arguments)
                response.functions = [function_message(function) for function in described]
                response.common = [argument_message(argument) for argument in description.common()]
                response.unknown = [name for name in request.functions if name not in description.table]
        return response


def function_message(described: Described) -> FunctionDescription:
    arguments = [argument_message(argument) for argument in described.arguments]
    return FunctionDescription(**{**vars(described), "arguments": arguments})


def argument_message(argument: Argument) -> ArgumentDescription:
    return ArgumentDescription(**{**vars(argument), "choices": list(argument.choices)})
