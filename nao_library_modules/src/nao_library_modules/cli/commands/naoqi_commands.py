"""`nao get`, `set`, `watch` and `naoqi`: the robot's memory and services, past the servers; a running goal goes on."""

from __future__ import annotations

import itertools
import queue
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import click

from naoqi.translate import readable_call, readable_type

from ...core.errors import did_you_mean
from ...core.fields import limit
from ...core.memory_functions import value_of_json
from .. import completion
from ..chain_text import Number
from ..cli_settings import CliSettings, NaoCommand, NaoGroup, SignedCommand, address_of, settings_of, url_option
from ..direct_robot import DirectRobot
from ..output import CommandFailed, StackMissing, plain, say_json, say_lines, table, words

RATE = 10.0
"""Looks a second at values that are no events, and messages a second of one key at most, unless something else is
asked for."""


@click.command(cls=NaoCommand, name="get")
@click.argument("keys", nargs=-1, required=True, shell_complete=completion.keys, metavar="KEY...")
@click.pass_context
def get_command(context: click.Context, keys: tuple[str, ...]) -> None:
    """Values of KEYs; wildcards mean all that fit: 'Device/SubDeviceList/*/Temperature/Sensor/Value'."""
    settings = settings_of(context)
    with DirectRobot(settings.stack.robot_address()) as robot:
        names = robot.matching(keys)
        if len(names) == 1:
            values = [robot.value(names[0])]
        else:
            values = list(robot.memory("getListData", names))
    if settings.json:
        say_json(dict(zip(names, values)))
    elif len(names) == 1:
        click.echo(words(plain(values[0])))
    else:
        say_lines(table([(name, words(plain(value))) for name, value in zip(names, values)]))


@click.command(cls=SignedCommand, name="set")
@click.argument("key", shell_complete=completion.keys)
@click.argument("value")
@click.option("--event", is_flag=True, help="Raise it as an event: whoever subscribed to it is told.")
@click.pass_context
def set_command(context: click.Context, key: str, value: str, event: bool) -> None:
    """Write VALUE, JSON or plain text, into KEY."""
    from ...core.memory_functions import parse_assignment

    settings = settings_of(context)
    _, content = parse_assignment(f"key={value}")
    with DirectRobot(settings.stack.robot_address()) as robot:
        robot.memory("raiseEvent" if event else "insertData", key, content)
    if settings.json:
        say_json({key: content})


@click.command(cls=NaoCommand, name="watch")
@click.argument("names", nargs=-1, required=True, shell_complete=completion.keys, metavar="NAME...")
@click.option("--count", type=click.IntRange(*map(int, limit("news")[:2])), metavar="N", help="End after so many.")
@click.option(
    "--rate",
    type=Number("sampling rate"),
    default=RATE,
    show_default=True,
    metavar="HZ",
    help="Looks a second at keys that are no events.",
)
@click.pass_context
def watch_command(context: click.Context, names: tuple[str, ...], count: int | None, rate: float) -> None:
    """Events and values named NAME as they come; wildcards mean all that fit: '*Touched'.

    Events are told each time, values when they change. Ends with Ctrl-C, after --count or --timeout.
    """
    settings = settings_of(context)
    with DirectRobot(settings.stack.robot_address()) as robot:
        wanted = robot.matching(names)
        known = frozenset(robot.events())
        for text in robot.unknown(names):  # they may come, or be misspelt
            click.echo(text, err=True)
        with _MemoryWatch(
            robot, [n for n in wanted if n in known], [n for n in wanted if n not in known], rate
        ) as watch:
            _print_values(watch, settings, count)


def _coming(
    take: Callable[[float | None], tuple[str, Any]], settings: CliSettings, count: int | None
) -> Iterator[tuple[str, Any]]:
    """What comes until the command's time is up, `count` times at most.

    `take`: waits so many s for the next one, None: for ever; raises queue.Empty if none came.
    """
    deadline = None if settings.timeout is None else time.monotonic() + settings.timeout
    for _ in itertools.count() if count is None else range(count):
        left = None if deadline is None else deadline - time.monotonic()
        if left is not None and left <= 0.0:
            return
        try:
            come = take(left)
        except queue.Empty:
            return
        yield come


def _print_values(watch: _MemoryWatch, settings: Any, count: int | None) -> None:
    for name, value in _coming(watch.next, settings, count):
        if settings.json:
            say_json({"time": time.time(), "name": name, "value": value}, compact=True)
        else:
            click.echo(f"{name}: {words(plain(value))}")


class _MemoryWatch:
    """Subscriptions to events, and a thread that looks at the other values, for a `with` block."""

    def __init__(self, robot: Any, events: list[str], keys: list[str], rate: float) -> None:
        self._robot = robot
        self._events = events
        self._keys = keys
        self._period = 1.0 / rate
        self._came: queue.Queue[Any] = queue.Queue()
        self._ended = threading.Event()
        self._links: list[tuple[Any, Any]] = []

    def next(self, limit: float | None) -> tuple[str, Any]:
        """The next name and value.

        `limit`: s to wait for it; None for ever. Raises queue.Empty if none came in time, click.ClickException if the
        robot went away.
        """
        came = self._came.get(timeout=limit)
        if isinstance(came, Exception):
            raise came
        return came

    def __enter__(self) -> _MemoryWatch:
        for event in self._events:
            subscriber = self._robot.subscriber(event)
            link = subscriber.signal.connect(lambda value=None, *_, name=event: self._came.put((name, value)))
            self._links.append((subscriber, link))
        threading.Thread(target=self._look, name="watch", daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        for subscriber, link in self._links:
            try:
                subscriber.signal.disconnect(link)
            except Exception:  # noqa: S110  a robot that is gone has forgotten it anyway
                pass

    def _look(self) -> None:
        last: dict[str, Any] = {}
        while not self._ended.is_set():
            try:
                # Without keys as well: it tells whether the robot is still there.
                values = self._robot.memory("getListData", self._keys) if self._keys else self._robot.memory("ping")
            except click.ClickException as error:
                self._came.put(StackMissing(error.message))
                return
            for name, value in zip(self._keys, values if self._keys else ()):
                if name not in last or last[name] != value:
                    last[name] = value
                    self._came.put((name, value))
            self._ended.wait(self._period if self._keys else 1.0)


# --- nao naoqi --------------------------------------------------------------------------------------------------------

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
    for member, values in _coming(lambda limit: came.get(timeout=limit), settings, count):
        if settings.json:
            say_json({"time": time.time(), "name": member, "values": values}, compact=True)
        else:
            click.echo(f"{member}: {', '.join(words(plain(value)) for value in values)}")
