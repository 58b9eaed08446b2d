"""The check of commands in files of the console, for the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..errors import StackMissing
from ..settings import CliSettings

if TYPE_CHECKING:
    from ...studies.command_check import CommandCheck


def command_check(settings: CliSettings) -> CommandCheck:
    """What checks commands against the servers that run, or, where none does, against the code."""
    from nao_library_msgs.srv import ListBehaviorsRequest

    from ...studies.command_check import CommandCheck
    from ...studies.commands import NotThere

    stack = settings.stack

    def running() -> list[str]:
        try:
            return stack.servers()
        except click.ClickException:
            return []

    def ask(**fields: Any) -> Any:
        try:
            return stack.list_behaviors(ListBehaviorsRequest(**fields), patient=True)
        except StackMissing as error:
            raise NotThere(error.message) from None

    return CommandCheck(stack.describe, running, ask)
