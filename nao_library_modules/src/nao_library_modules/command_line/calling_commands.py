"""`nao call`: any functions of a server."""

from __future__ import annotations

import click

from .chain_text import build_message, read_chain
from .goals import carry_out, message_class
from .settings import NaoCommand, settings_of


def _complete_server(context: click.Context, _parameter: click.Parameter, start: str) -> list[str]:
    from .completion import servers

    return servers(context, start)


def _complete_chain(context: click.Context, parameter: click.Parameter, start: str) -> list[str]:
    from .completion import chain

    return chain(context, start, context.params.get("server") or "", context.params.get(parameter.name) or ())


@click.command(cls=NaoCommand, name="call", context_settings={"ignore_unknown_options": True})
@click.argument("server", shell_complete=_complete_server)
@click.argument("chain", nargs=-1, required=True, shell_complete=_complete_chain, metavar="FUNCTION [field:=value]...")
@click.pass_context
def call_command(context: click.Context, server: str, chain: tuple[str, ...]) -> None:
    """Call functions of SERVER as one goal.

    Several have a comma or --then between them. Lists are values with commas between them; `nao help FUNCTION` tells
    the fields.

    nao call NaoLights setIntensity lights:=Brain0,Brain1 i_values:=0.5 time:=2 , off lights:=Brain0
    """
    settings = settings_of(context)
    typed = read_chain(chain)
    kind = message_class(settings.stack.describe(server, brief=True).message)
    carry_out(settings, server, [build_message(function, kind) for function in typed])
