"""`nao call`: any functions of a server."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import click

from .. import completion
from ..chain_text import NEXT, TypedFunction, build_message, read_chain
from ..errors import CommandFailed
from ..goals import carry_out, message_class
from ..output import say_json
from ..settings import CliSettings, SignedCommand, settings_of
from ..stack import described_by_code


class _CallCommand(SignedCommand):
    words = NEXT

    def instead_of(self, option: str, known: Sequence[str]) -> list[str]:
        """As every command has it; what is no option may be meant for a field."""
        return super().instead_of(option, known) or [f"{option.lstrip('-')}:=VALUE"]


@click.command(cls=_CallCommand, name="call")
@click.argument("server", shell_complete=completion.servers)
@click.argument("chain", nargs=-1, required=True, shell_complete=completion.chain, metavar="FUNCTION [field:=value]...")
@click.option("--dry-run", is_flag=True, help="Only have the server check it: nothing is done, what runs goes on.")
@click.pass_context
def call_command(context: click.Context, server: str, chain: tuple[str, ...], dry_run: bool) -> None:
    """Call functions of SERVER as one goal.

    Several have a comma or --then between them. Lists are values with commas between them; `nao help FUNCTION` tells
    the fields.

    nao call NaoLights setIntensity lights:=Brain0,Brain1 i_values:=0.5 time:=2 , off lights:=Brain0
    """
    settings = settings_of(context)
    typed = read_chain(chain)
    told = settings.stack.describe(server, functions=[function.name for function in typed])
    _require_not_elsewhere(settings, server, told.unknown)
    kind = message_class(told.message)
    common = [argument.name for argument in told.common]
    taken = {each.name: [*(argument.name for argument in each.arguments), *common] for each in told.functions}
    functions = [build_message(function, kind, taken.get(function.name, ())) for function in typed]
    _tell_of_unread(typed, taken)
    if dry_run:
        _tell_dry_run(settings, server, functions)
    else:
        carry_out(settings, server, functions)


def _tell_dry_run(settings: CliSettings, server: str, functions: Sequence[Any]) -> None:
    """Print what a server says of a goal.

    Raises CommandFailed if it could not be carried out, or the server does not say.
    """
    from ...functions.check_service import NotValidated

    goal = message_class(f"{settings.stack.describe(server, brief=True).action}Goal")
    try:
        check = settings.stack.check(server, [goal(list(functions))])
    except NotValidated as error:
        raise CommandFailed(f"{server} did not check the goal: {error}") from None
    if settings.json:
        told = {"problems": check.problems, "unchecked": check.unchecked}
        say_json({name: [vars(each) for each in problems] for name, problems in told.items()})
    for problem in check.problems:
        click.echo(str(problem), err=True)
    if check.problems:
        raise CommandFailed("it cannot be done")
    if not settings.json:
        for each in check.unchecked:
            click.echo(f"not known: {each}")
        click.echo("nothing wrong was found" if check.unchecked else "it can be done")


def _tell_of_unread(typed: Sequence[TypedFunction], taken: Mapping[str, Sequence[str]]) -> None:
    """Warn of fields that a function does not read: what was meant by them is not done."""
    for function in typed:
        reads = taken.get(function.name, function.fields)
        unread = [field for field in function.fields if field not in reads]
        if unread:
            click.echo(f"{function.name} does not read {', '.join(unread)}; it reads {', '.join(reads)}", err=True)


def _require_not_elsewhere(settings: CliSettings, server: str, unknown: Sequence[str]) -> None:
    """See that no function that a server does not know is one of another; of what nobody knows, the server tells.

    Raises click.UsageError if it is; the text names the servers that have it.
    """
    for name in unknown:
        others = [other for other, told in described_by_code(functions=[name], names=True) if not told.unknown]
        if others:
            own = settings.stack.server(server).rpartition("/")[2]
            have = "has" if len(others) == 1 else "have"
            raise click.UsageError(f"{own} has no function {name}; {', '.join(others)} {have}")
