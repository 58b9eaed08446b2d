"""The servers of all modules as their classes declare them: for documents, and for help where nothing runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from .chain import FunctionTable
from .describe import Description
from .describe_service import DescribeService
from .memory_functions import MemoryFunctions
from .offline_module import offline_module
from .server_types import ACTIONS, server_type


@dataclass(frozen=True)
class OfflineServer:
    """An action server as it would present itself."""

    name: str  # relative name of the action
    action: type  # its type
    kind: type  # class of the module behind it
    table: Mapping[str, Callable[..., Any]]  # NAOqi function name -> plain function of the class
    service: DescribeService  # what would answer NAME/describe


def offline_servers() -> list[OfflineServer]:
    """The servers of all modules in this package, by name."""
    return [_declared(name) for name in sorted(ACTIONS, key=str.lower)]


def _declared(name: str) -> OfflineServer:
    server = server_type(name)
    kind, action = server.module, server.action
    table = FunctionTable(kind.declared_functions(), MemoryFunctions.functions)
    module = lru_cache(maxsize=None)(lambda: offline_module(kind))
    choices = lambda function, field, _: module().argument_choices(function, field)  # noqa: E731
    service = DescribeService(lambda: Description(table, kind, action, choices), None, lambda: ((), 0))
    return OfflineServer(name, action, kind, table, service)
