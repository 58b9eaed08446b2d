"""The servers of all modules without a robot and without ROS: for documents, and for help where nothing runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .describe_service import DescribeService
from .offline_module import offline_module
from .server_types import ACTIONS, server_type


@dataclass(frozen=True)
class OfflineServer:
    """An action server as it would present itself.

    Attributes:
        name: Relative name of the action.
        action: Its type.
        module: The module behind it, which nothing runs.
        service: What would answer NAME/describe.
    """

    name: str
    action: type
    module: Any
    service: DescribeService


def offline_servers() -> list[OfflineServer]:
    """The servers of all modules in this package, by name."""
    servers = [server for name in ACTIONS for server in _served(server_type(name).module)]
    return sorted(servers, key=lambda server: server.name.lower())


def _served(kind: type) -> list[OfflineServer]:
    module, served = offline_module(kind)
    return [
        OfflineServer(name, action, module, DescribeService(module, action, lambda: ((), 0))) for name, action in served
    ]
