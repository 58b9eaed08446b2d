"""Descriptions of the servers where none runs, as far as the code tells."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import click

from ..base.suggestion import of_those


def described_by_code(
    server: str = "", brief: bool = False, names: bool = False, functions: Sequence[str] = ()
) -> list[tuple[str, Any]]:
    """Servers with their descriptions, as their service would give them.

    Raises click.UsageError if there is no such server.

    Args:
        server: Only this one; all without.
        brief: True: without functions.
        names: True: only names and help of the functions.
        functions: Only these; all without.
    """
    from nao_library_msgs.srv import DescribeFunctionsRequest

    from .stack import same_server

    servers = _servers()
    chosen = [found for found in servers if not server or same_server(found.name, server)]
    if not chosen:
        known = [found.name for found in servers]
        raise click.UsageError(f"there is no server {server!r}{of_those(server, known)}")
    request = DescribeFunctionsRequest(list(functions), names, brief)
    return [(found.name, found.service.answer(request)) for found in chosen]


@lru_cache(maxsize=None)
def _servers() -> list[Any]:
    from ..functions.describe_offline import offline_servers

    return offline_servers()
