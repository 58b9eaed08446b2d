"""`nao naoqi`: what services of the robot and of programs have, past the servers; as qicli."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

import click

from naoqi.translate import readable_call, readable_type

from ...base.answers import value_of_json
from ...base.limits import limit
from ...base.suggestion import did_you_mean
from ..address import address_of, url_option
from ..errors import CommandFailed
from ..output import plain, say_json, say_lines, words
from ..robot_link import DirectRobot
from ..settings import CliSettings, NaoGroup, SignedCommand, settings_of

OWN = 100
"""Members below this number are those that every object of libqi has."""
KINDS = ("methods", "signals", "properties")


@click.group(cls=NaoGroup, name="naoqi")
def naoqi_command() -> None:
    """Services of the robot and of programs, past the servers: what they have, call it, watch it.

    A MEMBER is SERVICE.NAME, such as ALMotion.getAngles.
    """


@naoqi_command.command("info")
@click.argument("names", nargs=-1, metavar="[SERVICE|MEMBER]...")
@url_option
@click.pass_context
def info(context: click.Context, names: tuple[str, ...], url: str | None) -> None:
    """The services, or the methods, signals and properties of one, or one of these."""
    settings = settings_of(context)
    with _robot(settings, url) as robot:
        told = {name: _members(robot, name) for name in names} if names else robot.services()
    if settings.json:
        say_json(told)
    elif isinstance(told, list):
        say_lines(told)
    else:
        for name, members in told.items():
            click.echo(name)
            for kind, lines in members.items():
                say_lines([f"  {kind}:", *(f"    {line}" for line in lines)])


@naoqi_command.command("call", cls=SignedCommand)
@click.argument("member", metavar="MEMBER")
@click.argument("arguments", nargs=-1, metavar="[ARGUMENT]...")
@url_option
@click.pass_context
def call(context: click.Context, member: str, arguments: tuple[str, ...], url: str | None) -> None:
    """Call a method with ARGUMENTs, JSON or plain text, and print its answer; of a property, print or set it."""
    settings = settings_of(context)
    with _robot(settings, url) as robot:
        answer = _answer(robot, *_member(member), _values(arguments), settings.timeout)
    if settings.json:
        say_json({"answer": answer})
    elif answer is not None:
        click.echo(words(plain(answer)))


@naoqi_command.command("post", cls=SignedCommand)
@click.argument("member", metavar="MEMBER")
@click.argument("arguments", nargs=-1, metavar="[ARGUMENT]...")
@url_option
@click.pass_context
def post(context: click.Context, member: str, arguments: tuple[str, ...], url: str | None) -> None:
    """Call a method without waiting for its end, or raise a signal."""
    settings = settings_of(context)
    service, name = _member(member)
    with _robot(settings, url) as robot:
        remote = robot.service(service)
        if name in _named(remote, "properties"):
            raise CommandFailed(f"{member} is a property, which nao naoqi call {member} VALUE sets")
        if name in _named(remote, "signals"):
            getattr(remote, name)(*_values(arguments))
        elif "pCall" not in _named(remote, "methods"):
            raise CommandFailed(
                f"{service} cannot post calls, it has no pCall: nao naoqi call {member} calls and waits"
            )
        else:
            posted = robot.call(service, "pCall", name, *_values(arguments))
            if settings.json:
                say_json({"task": posted})


@naoqi_command.command("watch")
@click.argument("members", nargs=-1, required=True, metavar="MEMBER...")
@click.option("--count", type=click.IntRange(*map(int, limit("news")[:2])), metavar="N", help="End after so many.")
@url_option
@click.pass_context
def watch(context: click.Context, members: tuple[str, ...], count: int | None, url: str | None) -> None:
    """What signals and properties tell, as it comes. Ends with Ctrl-C, after --count or --timeout."""
    settings = settings_of(context)
    came: queue.Queue[tuple[str, tuple[Any, ...]]] = queue.Queue()
    with _robot(settings, url) as robot:
        links = [_watched(robot, member, came.put) for member in members]
        try:
            _print_news(came, settings, count)
        finally:
            for signal, link in links:
                with suppress(RuntimeError):
                    signal.disconnect(link)


def _robot(settings: CliSettings, url: str | None) -> DirectRobot:
    return DirectRobot(address_of(settings, url))


def _member(text: str) -> tuple[str, str]:
    service, dot, name = text.rpartition(".")
    if not (service and dot and name):
        raise click.UsageError(f"MEMBER is {text!r}, allowed is SERVICE.NAME, such as ALMotion.getAngles")
    return service, name


def _values(arguments: Sequence[str]) -> list[Any]:
    values = []
    for text in arguments:
        try:
            values.append(value_of_json(text))
        except ValueError:
            values.append(text)
    return values


def _answer(robot: DirectRobot, service: str, name: str, values: Sequence[Any], timeout: float | None) -> Any:
    """What a method answers, or the value of a property, which the first of `values` becomes if there are any."""
    remote = robot.service(service)
    if name not in _named(remote, "properties"):
        return robot.begin(service, name, *values).result(timeout)
    value = getattr(remote, name)
    return value.setValue(values[0]) if values else value.value()


def _named(remote: Any, kind: str) -> set[str]:
    return {entry["name"] for entry in remote.metaObject()[kind].values()}


def _members(robot: DirectRobot, name: str) -> Mapping[str, list[str]]:
    """Lines about the members of a service, or about one of them, by kind."""
    services = robot.services()
    service, _, wanted = (name, "", "") if name in services else name.rpartition(".")
    if service not in services:
        raise CommandFailed(f"there is no service {name}{did_you_mean(name, services)}")
    about = robot.service(service).metaObject()
    found = {kind: _lines(kind, about, wanted) for kind in KINDS}
    if wanted and not any(found.values()):
        names = [entry["name"] for kind in KINDS for entry in about[kind].values()]
        raise CommandFailed(f"{service} has no {wanted}{did_you_mean(wanted, names)}")
    return {kind: lines for kind, lines in found.items() if lines}


def _lines(kind: str, about: Mapping[str, Any], wanted: str) -> list[str]:
    entries = {uid: e for uid, e in about[kind].items() if kind != "signals" or uid not in about["properties"]}
    shown = [e for uid, e in sorted(entries.items()) if (e["name"] == wanted if wanted else uid >= OWN)]
    if kind == "properties":
        return [f"{e['name']}: {readable_type(e['signature'])}" for e in shown]
    if kind == "signals":
        return [readable_call(e["name"], e["signature"]) for e in shown]
    return [
        f"{readable_call(e['name'], e['parametersSignature'])} -> {readable_type(e['returnSignature'])}"
        + (f": {e['description']}" if wanted and e["description"] not in ("", "None") else "")
        for e in shown
    ]


def _watched(robot: DirectRobot, member: str, told: Callable[[Any], None]) -> tuple[Any, int]:
    service, name = _member(member)
    remote = robot.service(service)
    known = _named(remote, "signals") | _named(remote, "properties")
    if name not in known:
        raise CommandFailed(f"{service} has no signal and no property {name}{did_you_mean(name, sorted(known))}")
    signal = getattr(remote, name)
    return signal, signal.connect(lambda *values: told((member, values)))


def _print_news(came: queue.Queue[Any], settings: CliSettings, count: int | None) -> None:
    deadline = None if settings.timeout is None else time.monotonic() + settings.timeout
    told = 0
    while count is None or told < count:
        try:
            member, values = came.get(timeout=None if deadline is None else max(0.0, deadline - time.monotonic()))
        except queue.Empty:
            return
        told += 1
        if settings.json:
            say_json({"time": time.time(), "name": member, "values": values}, compact=True)
        else:
            click.echo(f"{member}: {', '.join(words(plain(value)) for value in values)}")
