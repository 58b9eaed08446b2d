"""`nao get`, `set`, `watch`: the robot's memory, past the servers, so that a goal that runs goes on."""

from __future__ import annotations

import queue
import threading
import time
from typing import Any

import click

from ...base.limits import limit
from .. import completion
from ..chain_text import Number
from ..errors import StackMissing
from ..output import plain, say_json, say_lines, table, words
from ..robot_link import DirectRobot
from ..settings import NaoCommand, SignedCommand, settings_of

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
    from ...functions.memory_functions import parse_assignment

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
        with _MemoryWatch(robot, [n for n in wanted if n in known], [n for n in wanted if n not in known], rate) as watch:
            _print_values(watch, settings, count)


def _print_values(watch: _MemoryWatch, settings: Any, count: int | None) -> None:
    deadline = None if settings.timeout is None else time.monotonic() + settings.timeout
    told = 0
    while count is None or told < count:
        left = None if deadline is None else deadline - time.monotonic()
        if left is not None and left <= 0.0:
            return
        try:
            name, value = watch.next(left)
        except queue.Empty:
            return
        told += 1
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
