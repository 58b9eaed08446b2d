"""`nao run`, `nao behaviors` and `nao check`: stored behaviours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from ...base.suggestion import did_you_mean
from .. import completion
from ..errors import CommandFailed, StackMissing
from ..goals import carry_out, function_message
from ..output import plain, say_json, say_lines, table
from ..settings import CliSettings, NaoCommand, settings_of

SERVER = "NaoBehavior"
SUFFIX = ".yaml"


def _the_stored(settings: CliSettings, name: str) -> dict[str, Any]:
    """The stored behaviour of a name, as plain values. Raises CommandFailed if there is none."""
    found = settings.stack.behaviors(name)
    if not found:
        known = [behavior["name"] for behavior in settings.stack.behaviors()]
        hint = _file_of(name) or did_you_mean(name, known)
        raise CommandFailed(f"there is no behaviour {name!r}{hint}; there are {', '.join(known)}")
    return found[0]


def _file_of(name: str) -> str:
    """A hint to the file that is beside the user and called like a behaviour; nothing where there is none."""
    return f": did you mean the file {name + SUFFIX}?" if Path(name + SUFFIX).is_file() else ""


@click.command(cls=NaoCommand, name="run")
@click.argument("name", metavar="NAME|FILE", shell_complete=completion.behaviors)
@click.argument("parameters", nargs=-1, shell_complete=completion.parameters, metavar="[PARAMETER=VALUE]...")
@click.pass_context
def run_command(context: click.Context, name: str, parameters: tuple[str, ...]) -> None:
    """Run a behaviour, stored as NAME or in a FILE (.yaml). `nao behaviors NAME` tells its parameters.

    All of it is checked before anything moves, as `nao check` does.
    """
    assigned(parameters)  # one that is none is a mistake in the command, whatever the server says
    settings = settings_of(context)
    of_file = name.endswith(SUFFIX)
    if not of_file and _file_of(name):
        _the_stored(settings, name)
    which = {"text": text_of(name), "file": name} if of_file else {"str_param": name}
    message = function_message(settings, SERVER, function="runBehavior", parameters=list(parameters), **which)
    end = carry_out(settings, SERVER, [message], quiet=True)
    if not settings.json:
        from ...behaviors.language.errors import place

        # A behaviour goes on after steps that may fail; progress has told of the others.
        for step in end.result.get("steps", []):
            if step["error"]:
                told = f"{step['path']} {step['what']} {step['state']}: {step['error']}"
                click.echo(place(step["file"], step["line"]) + told, err=True)


@click.command(cls=NaoCommand, name="behaviors")
@click.argument("name", default="", shell_complete=completion.behaviors)
@click.pass_context
def behaviors_command(context: click.Context, name: str) -> None:
    """The stored behaviours; of one, all there is to know: its parameters, what it does, what it needs."""
    settings = settings_of(context)
    found = [_the_stored(settings, name)] if name else settings.stack.behaviors()
    if settings.json:
        say_json(found)
    elif name:
        say_lines(_lines_of(found[0], {}))
    else:
        say_lines(table([(each["name"], each["problem"] or each["help"].partition(". ")[0]) for each in found]))


@click.command(cls=NaoCommand, name="check")
@click.argument("what", metavar="NAME|FILE", shell_complete=completion.behaviors)
@click.argument("parameters", nargs=-1, metavar="[PARAMETER=VALUE]...")
@click.pass_context
def check_command(context: click.Context, what: str, parameters: tuple[str, ...]) -> None:
    """Whether a behaviour can be run, stored as NAME or in a FILE (.yaml), and what it would do.

    The servers check their goals, and carry none of them out; what runs goes on. Servers that are not there are told,
    and their goals compared with what every NAO has.
    """
    from nao_library_msgs.srv import ListBehaviorsRequest

    values = assigned(parameters)
    settings = settings_of(context)
    of_file = what.endswith(SUFFIX)
    which = {"text": text_of(what), "file": what} if of_file else {"name": what}
    request = ListBehaviorsRequest(parameters=list(parameters), validate=True, **which)
    try:
        # The servers of its goals are asked in turn, and have their time each.
        answer = settings.stack.list_behaviors(request, patient=True)
    except StackMissing:
        from ..offline_check import check_offline

        answer = check_offline(settings.stack, request)
    found = plain(answer)["behaviors"]
    checked = found[0] if found else _the_stored(settings, what)
    problems = problems_of(checked)
    if settings.json:
        say_json({**checked, "problems": problems})
    elif not problems:
        say_lines(_lines_of(checked, values))
    for problem in problems:
        click.echo(problem, err=True)
    if problems:
        raise CommandFailed(f"{what} cannot be run{'' if of_file else _file_of(what)}")
    if not settings.json:
        _tell_unvalidated(checked["unvalidated"])


def problems_of(checked: Mapping[str, Any]) -> list[str]:
    """What is wrong with a behaviour that was checked, a line each."""
    from ...behaviors.language.errors import Problem

    problems = [str(Problem(**problem)) for problem in checked["problems"]]
    return problems or list(filter(None, [checked["problem"]]))


def _tell_unvalidated(servers: Sequence[str]) -> None:
    if not servers:
        click.echo("it can be run")
        return
    click.echo("  not checked by their servers, only compared with what every NAO has")
    of_reason: dict[str, list[str]] = {}
    for server in servers:
        name, _, reason = server.partition(": ")
        of_reason.setdefault(reason, []).append(name)
    for reason, names in of_reason.items():
        click.echo(f"    {', '.join(names)}: {reason}")
    click.echo("nothing wrong was found")


def text_of(file: str) -> str:
    """What a file has. Raises click.UsageError if it cannot be read."""
    try:
        return Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        raise click.UsageError(f"{file} cannot be read: {reason}") from None


def assigned(parameters: Sequence[str]) -> dict[str, str]:
    """Name -> value of `PARAMETER=VALUE`. Raises click.UsageError if one is no assignment."""
    values = {}
    for parameter in parameters:
        name, equals, value = parameter.partition("=")
        if not equals:
            raise click.UsageError(f"{parameter!r} is no PARAMETER=VALUE")
        values[name.strip()] = value
    return values


def _lines_of(behavior: dict[str, Any], values: Mapping[str, str]) -> Iterator[str]:
    """All there is to know about a behaviour. `values`: of parameters, where not their defaults."""
    yield f"{behavior['name']}: {behavior['problem'] or behavior['help']}"
    rows = []
    for parameter in behavior["parameters"]:
        unit = f" {parameter['unit']}" if parameter["unit"] else ""
        choices = f"; one of {', '.join(parameter['choices'])}" if parameter["choices"] else ""
        value = values.get(parameter["name"], parameter["default"])
        rows.append((f"{parameter['name']}={value}{unit}", parameter["help"] + choices))
    yield from table(rows, indent="  ")
    told = {
        "tags": ", ".join(behavior["tags"]),
        "servers": ", ".join(behavior["servers"]),
        "boxes": ", ".join(behavior["boxes"]),
        "waits": f"{behavior['waits']:g} s, besides what its goals take" if behavior["waits"] else "",
    }
    yield from table([(name, text) for name, text in told.items() if text], indent="  ")
    if behavior["steps"]:
        yield "  steps"
    yield from (f"    {step}" for step in behavior["steps"])
    if behavior["unchecked"]:
        yield "  not known until they run, as it depends on the robot then; or wrong, and skipped as on_error says"
    yield from (f"    {function}" for function in behavior["unchecked"])
