"""Checks a behaviour in this process, where no server for behaviours runs; those of its goals are asked if they do."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

import click

from .stack import Stack

if TYPE_CHECKING:
    from nao_library_msgs.srv import DescribeFunctionsResponse


def check_offline(stack: Stack, request: Any) -> Any:
    """What `NaoBehavior/list` would answer; behaviours of the user are those in the usual folder."""
    from nao_library_msgs.srv import ListBehaviorsResponse

    from ..base.paths import config_file
    from ..behaviors import BehaviorStore, read
    from ..behaviors.language.checking import preview_facts
    from ..behaviors.language.servers import FunctionTables
    from ..behaviors.run.running import info_message
    from ..behaviors.server import PARAMETERS, SHIPPED

    store = BehaviorStore(Path(PARAMETERS["behavior_dir"]).expanduser(), config_file(SHIPPED))
    name = PurePath(request.file).stem if request.text else request.name
    load = (lambda: read(request.text, name, request.file)) if request.text else (lambda: store.load(name))
    tables = FunctionTables(partial(_describe, stack), partial(_running, stack))
    facts = preview_facts(name, load, store.load, tables, request.parameters, stack.check)
    return ListBehaviorsResponse([info_message(facts, shipped=False)])


def _describe(stack: Stack, server: str, functions: Sequence[str] | None) -> DescribeFunctionsResponse:
    from ..behaviors.language.servers import NotDescribed

    try:
        return stack.describe(server, functions or (), brief=functions is None, names=not functions)
    except click.ClickException as error:
        raise NotDescribed(error.message) from None


def _running(stack: Stack) -> list[str]:
    try:
        return stack.servers()
    except click.ClickException:
        return []
