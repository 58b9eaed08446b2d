"""`nao status`, `list` and `help`: what there is and how it does."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import click

from ...base.suggestion import did_you_mean
from .. import completion
from ..errors import StackMissing
from ..output import plain, say_json, say_lines, table
from ..settings import CliSettings, NaoCommand, settings_of
from ..stack import described_by_code, same_server

INDENT = "  "


@click.command(cls=NaoCommand, name="status")
@click.pass_context
def status_command(context: click.Context) -> None:
    """Robot, battery, posture, servers, goals that run, and what is wrong.

    The exit status is 3 if the robot cannot be reached.
    """
    from ..status import read_status, status_lines

    settings = settings_of(context)
    found = read_status(settings.stack)
    if settings.json:
        say_json(found)
    else:
        say_lines(status_lines(found))
    if not found["connected"]:
        raise StackMissing(f"the robot at {found['address']} cannot be reached")


@click.command(cls=NaoCommand, name="list")
@click.argument("server", default="", shell_complete=completion.servers)
@click.option("--all", "shared", is_flag=True, help="Also the functions that every server has.")
@click.pass_context
def list_command(context: click.Context, server: str, shared: bool) -> None:
    """The servers, or the functions of SERVER."""
    settings = settings_of(context)
    if not server:
        servers = described_servers(settings, brief=True)
        if settings.json:
            say_json([{"name": name, "help": told.help, "action": told.action} for name, told in servers])
        else:
            say_lines(table([(name, told.help) for name, told in servers]))
        return
    (_, told), *_ = described_servers(settings, server=server, names=not settings.json)
    functions = [function for function in told.functions if shared or not function.shared]
    if settings.json:
        say_json(functions)
    else:
        say_lines(table([(function.name, function.help) for function in functions]))


@click.command(cls=NaoCommand, name="help")
@click.argument("name", shell_complete=completion.all_functions)
@click.argument("function", default="")
@click.pass_context
def help_command(context: click.Context, name: str, function: str) -> None:
    """What the function NAME does and takes, in all servers; or the server NAME, or its FUNCTION.

    Without a running stack it tells what can be told from the code.
    """
    settings = settings_of(context)
    wanted = function or name
    found = _find(settings, wanted, name if function else "")
    if not found:
        _help_server(settings, name, function)
        return
    if all(described.shared for _, _, described in found):
        found = found[:1]  # every server has it
    if settings.json:
        say_json([{"server": server, **plain(described)} for server, _, described in found])
        return
    for number, (server, told, described) in enumerate(found):
        if number:
            click.echo()
        say_lines(function_lines(server, told, described))


def _find(settings: CliSettings, function: str, server: str) -> list[tuple[str, Any, Any]]:
    """Functions of a name: the server of each, what that says about itself, and the description."""
    found = []
    for name, told in described_servers(settings, server=server, names=True):
        for candidate in told.functions:
            if candidate.name.lower() == function.lower():
                found.append((name, candidate.name))
    told = {name: dict(described_servers(settings, name, functions=(exact,)))[name] for name, exact in found}
    return [(name, told[name], next(f for f in told[name].functions if f.name == exact)) for name, exact in found]


def described_servers(
    settings: CliSettings, server: str = "", functions: Sequence[str] = (), brief: bool = False, names: bool = False
) -> list[tuple[str, Any]]:
    """Servers with what they say about themselves, see `Stack.describe`; where none runs, what the code says.

    `server`: only this one; all without. Raises click.UsageError if there is no such server.
    """
    try:
        stack = settings.stack
        if server:
            name = stack.server(server)[len(stack.namespace) :]
            return [(name, stack.describe(name, functions, brief, names))]
        told_before, found = stack.silent, stack.described(functions, brief, names)
        if stack.silent != told_before:
            click.echo(f"does not answer: {', '.join(stack.silent)}", err=True)
        return found
    except StackMissing as missing:
        if settings.namespace is not None:
            raise
        if not settings.described_offline:
            click.echo(f"{missing.message}\nthis is what the code says:", err=True)
            settings.described_offline = True
        return described_by_code(server, functions, brief, names)


def _help_server(settings: CliSettings, name: str, function: str) -> None:
    """Help for a server; or what looks like a name that is not there.

    Raises click.UsageError if there is neither a function nor a server of that name.
    """
    servers = described_servers(settings, names=True)
    known = [name for name, _ in servers]
    functions = list(dict.fromkeys(f.name for _, told in servers for f in told.functions))
    wanted = function or name
    server = [(n, told) for n, told in servers if same_server(n, name)]
    if function or not server:
        hint = did_you_mean(wanted, [*functions, *known]) or ": `nao list` tells the servers"
        raise click.UsageError(f"there is no function {wanted!r}{hint}")
    (found, told), *_ = server
    if settings.json:
        (_, told), *_ = described_servers(settings, found)
        say_json({"server": found, "help": told.help, "functions": told.functions})
        return
    click.echo(f"{found}: {told.help}")
    rows = [(f.name, f.help) for f in told.functions if not f.shared]
    say_lines(table(rows, INDENT))
    click.echo(f"{INDENT}and those of the robot's memory: {', '.join(f.name for f in told.functions if f.shared)}")


def function_lines(server: str, told: Any, function: Any) -> Iterable[str]:
    """Help for one function."""
    yield f"{server} {function.name}: {function.help}"
    if function.answers != "nothing":
        yield f"{INDENT}answers: {function.answers}"
    for argument in [*function.arguments, *told.common]:
        unit = f" {argument.unit}" if argument.unit else ""
        yield f"{INDENT}{argument.name} ({argument.type}){unit}, {argument.default or '{}'}"
        yield f"{INDENT * 2}{argument.help}"
        if argument.allowed:
            yield f"{INDENT * 2}allowed: {argument.allowed}"
        if argument.choices and not all(word in argument.allowed for word in argument.choices):
            yield f"{INDENT * 2}here: {', '.join(argument.choices)}"
    yield f"{INDENT}nao call {server} {function.name}{''.join(f' {a.name}:=...' for a in function.arguments)}"
