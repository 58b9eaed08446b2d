"""`nao run`, `nao behaviors` and `nao check`: stored behaviours."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from ..suggestion import did_you_mean
from .errors import CommandFailed
from .goals import carry_out, function_message, run_functions
from .output import plain, say_json, table
from .settings import NaoCommand, Settings, settings_of

SERVER = "NaoBehavior"
SERVICE = "NaoBehavior/list"
SUFFIX = ".yaml"


def _complete_name(context: click.Context, _parameter: click.Parameter, start: str) -> list[str]:
    from .completion import behaviors

    return behaviors(context, start)


def _complete_parameter(context: click.Context, _parameter: click.Parameter, start: str) -> list[str]:
    from .completion import parameters

    return parameters(context, start, context.params.get("name") or "")


def stored(settings: Settings, name: str = "") -> list[dict[str, Any]]:
    """The stored behaviours, or the one of a name, as plain values."""
    from nao_library_msgs.srv import ListBehaviors, ListBehaviorsRequest

    stack = settings.stack
    answer = stack.graph.call(stack.service(SERVICE), ListBehaviors, ListBehaviorsRequest(name=name))
    return plain(answer)["behaviors"]


def _the_stored(settings: Settings, name: str) -> dict[str, Any]:
    """The stored behaviour of a name, as plain values.

    Raises:
        CommandFailed: There is none.
    """
    found = stored(settings, name)
    if not found:
        known = [behavior["name"] for behavior in stored(settings)]
        raise CommandFailed(f"there is no behaviour {name!r}{did_you_mean(name, known)}; there are {', '.join(known)}")
    return found[0]


@click.command(cls=NaoCommand, name="run")
@click.argument("name", shell_complete=_complete_name)
@click.argument("parameters", nargs=-1, shell_complete=_complete_parameter, metavar="[PARAMETER=VALUE]...")
@click.pass_context
def run_command(context: click.Context, name: str, parameters: tuple[str, ...]) -> None:
    """Run the behaviour NAME. `nao behaviors NAME` tells its parameters."""
    _require_assignments(parameters)
    settings = settings_of(context)
    message = function_message(settings, SERVER, function="runBehavior", str_param=name, parameters=list(parameters))
    end = carry_out(settings, SERVER, [message], quiet=True)
    if not settings.json:
        # A behaviour goes on after steps that may fail; progress has told of the others.
        for step in end.result.get("steps", []):
            if step["error"]:
                click.echo(f"{step['path']} {step['what']} {step['state']}: {step['error']}", err=True)


@click.command(cls=NaoCommand, name="behaviors")
@click.argument("name", default="", shell_complete=_complete_name)
@click.pass_context
def behaviors_command(context: click.Context, name: str) -> None:
    """The stored behaviours; of one, all there is to know: its parameters, what it does, what it needs."""
    settings = settings_of(context)
    found = [_the_stored(settings, name)] if name else stored(settings)
    if settings.json:
        say_json(found)
        return
    if name:
        for behavior in found:
            _tell(behavior)
        return
    rows = [(behavior["name"], behavior["problem"] or behavior["help"].partition(". ")[0]) for behavior in found]
    for line in table(rows):
        click.echo(line)


@click.command(cls=NaoCommand, name="check")
@click.argument("what", metavar="NAME|FILE", shell_complete=_complete_name)
@click.argument("parameters", nargs=-1, metavar="[PARAMETER=VALUE]...")
@click.pass_context
def check_command(context: click.Context, what: str, parameters: tuple[str, ...]) -> None:
    """Whether a behaviour can be run, stored as NAME or in a FILE (.yaml), and what it would do.

    With a FILE or a PARAMETER the server does it as a goal, and a behaviour that runs is ended. A NAME by itself ends
    nothing.
    """
    _require_assignments(parameters)
    settings = settings_of(context)
    if what.endswith(SUFFIX):
        checked, problems = _checked_by_goal(settings, parameters, text=_text_of(what))
        checked["name"] = Path(what).stem
    elif parameters:
        checked, problems = _checked_by_goal(settings, parameters, str_param=what)
    else:
        checked = _the_stored(settings, what)
        problems = [checked["problem"]] if checked["problem"] else []
    if settings.json:
        say_json({**checked, "problems": problems})
    elif not problems:
        _tell(checked)
    if problems:
        raise CommandFailed(f"{what} cannot be run: {'; '.join(problems)}")
    if not settings.json:
        click.echo("it can be run")


def _text_of(file: str) -> str:
    try:
        return Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        raise click.UsageError(f"{file} cannot be read: {reason}") from None


def _checked_by_goal(settings: Settings, parameters: Sequence[str], **what: str) -> tuple[dict[str, Any], list[str]]:
    """What the server tells of a behaviour, and what is wrong with it."""
    message = function_message(settings, SERVER, function="checkBehavior", parameters=list(parameters), **what)
    end = run_functions(settings, SERVER, [message])
    (checked,), problems = end.result["behaviors"], end.result["memList"]
    return checked, problems


def _require_assignments(parameters: Sequence[str]) -> None:
    for parameter in parameters:
        if "=" not in parameter:
            raise click.UsageError(f"{parameter!r} is no PARAMETER=VALUE")


def _tell(behavior: dict[str, Any]) -> None:
    click.echo(f"{behavior['name']}: {behavior['problem'] or behavior['help']}")
    _tell_parameters(behavior)
    told = {
        "tags": ", ".join(behavior["tags"]),
        "servers": ", ".join(behavior["servers"]),
        "boxes": ", ".join(behavior["boxes"]),
        "waits": f"{behavior['waits']:g} s, besides what its goals take" if behavior["waits"] else "",
    }
    for line in table([(name, text) for name, text in told.items() if text], indent="  "):
        click.echo(line)
    if behavior["steps"]:
        click.echo("  steps")
    for step in behavior["steps"]:
        click.echo(f"    {step}")
    if behavior["unchecked"]:
        click.echo("  only the robot knows whether these can be done; their servers check them when the step begins")
    for function in behavior["unchecked"]:
        click.echo(f"    {function}")


def _tell_parameters(behavior: dict[str, Any]) -> None:
    rows = []
    for parameter in behavior["parameters"]:
        unit = f" {parameter['unit']}" if parameter["unit"] else ""
        choices = f"; one of {', '.join(parameter['choices'])}" if parameter["choices"] else ""
        rows.append((f"{parameter['name']}={parameter['default']}{unit}", parameter["help"] + choices))
    for line in table(rows, indent="  "):
        click.echo(line)
