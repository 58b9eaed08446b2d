"""What commands print and leave: text for people, JSON for programs, progress of a goal, files; and how they fail.

The exit status tells how a command failed; a mistake in the command itself is click's UsageError: 2. Progress is one
line that changes on a terminal, and plain lines elsewhere, on standard error. A file never replaces another one, unless
that is asked for.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import sys
import threading
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import click

INTERRUPTED = 130


class CommandFailed(click.ClickException):
    """The robot could not do it, or a goal failed."""

    exit_code = 1


class StackMissing(click.ClickException):
    """There is nobody to ask: no master, no server, no robot."""

    exit_code = 3


class CommandInterrupted(click.ClickException):
    """Somebody pressed Ctrl-C; what ran is over."""

    exit_code = INTERRUPTED


# --- text and JSON ----------------------------------------------------------------------------------------------------

SAID, BEGUN = f"{__name__}.said", f"{__name__}.begun"
"""Places in `meta` of the context, which all commands of a run share: true when the JSON document is printed, and when
any JSON is, be it a document or a line."""
LEFT_OUT = frozenset({"memList", "results", "steps", "header", "onsets", "ends", "volume"})
"""Fields of results that answers or the progress tell better, or that say nothing to people."""


def plain(value: Any) -> Any:
    """A message as dicts, lists, numbers and texts; times in s."""
    to_sec = getattr(value, "to_sec", None)
    if to_sec is not None:
        return to_sec()
    slots = getattr(value, "__slots__", None)
    if slots is not None and hasattr(value, "_type"):
        return {name: plain(getattr(value, name)) for name in slots}
    if isinstance(value, Mapping):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, (bytes, bytearray)):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return value if isinstance(value, (bool, int, float, str)) or value is None else str(value)


def say_json(value: Any, compact: bool = False) -> None:
    """Print a value as JSON: a document over several lines, or one line of many."""
    context = click.get_current_context(silent=True)
    if context is not None:
        context.meta[BEGUN] = True
        if not compact:
            context.meta[SAID] = True
    click.echo(json.dumps(_finite(plain(value)), ensure_ascii=False, indent=None if compact else 2))


def _finite(value: Any) -> Any:
    """A plain value with None for the numbers that JSON does not have."""
    if isinstance(value, dict):
        return {name: _finite(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def words(value: Any) -> str:
    """A value for people, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        # Times of ROS are seconds since 1970: six digits of them would be days.
        return f"{value:.3f}" if 1e6 <= abs(value) < 1e15 else f"{value:.6g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {words(entry)}" for name, entry in value.items() if filled(entry))
    if isinstance(value, (list, tuple)):
        return ", ".join(map(words, value))
    return "" if value is None else str(value)


def filled(value: Any) -> bool:
    """Whether a field of a message has something to tell."""
    if isinstance(value, Mapping):
        return any(map(filled, value.values()))
    return not (value is None or value == "" or value == [] or value is False)


def say_result(result: Mapping[str, Any], end: str = "", failed: bool = False) -> None:
    """Print what a goal answered: each function's values, then the fields that the result has of its own.

    Args:
        end: What is told at the end, of a success here, of a failure in any case: an error in it is not told twice.
        failed: Of its own fields only the lists are told, what was made and found until then: the rest is state. Where
            no function was done, nothing was.
    """
    told = result.get("results", [])
    several = len(told) > 1
    for answer in told:
        error, text = answer.get("error", ""), "\n".join(answer["values"])
        if error:
            if error not in end:
                click.echo(f"{answer['function']}: {error}", err=True)
        elif several and text:
            click.echo(f"{answer['function']}: {', '.join(answer['values'])}")
        elif text:
            click.echo(text)
    for step in result.get("steps", []):
        values = [value for answer in step["results"] for value in answer["values"]]
        if values:
            click.echo(f"{step['path']} {step['what']}: {', '.join(values)}")
    own = {name: value for name, value in result.items() if name not in LEFT_OUT and filled(value)}
    if failed:
        done = any(not answer.get("error") for answer in told)
        own = {name: value for name, value in own.items() if isinstance(value, list) and done}
    say_lines(_own_lines(own))
    if end and not failed:
        click.echo(end)


def say_lines(lines: Iterable[str]) -> None:
    for line in lines:
        click.echo(line)


def _own_lines(fields: Mapping[str, Any]) -> Sequence[str]:
    """Fields of a result, lists of equal length beside each other."""
    lists = {n: v for n, v in fields.items() if isinstance(v, list) and not any(isinstance(e, Mapping) for e in v)}
    lengths = {len(value) for value in lists.values()}
    lines: list[str] = []
    if len(lists) > 1 and len(lengths) == 1:
        columns = [[words(entry) for entry in value] for value in lists.values()]
        lines += table(list(zip(*columns)))
    else:
        lines += [f"{name}: {words(value)}" for name, value in lists.items()]
    for name, value in fields.items():
        if name in lists:
            continue
        if isinstance(value, list):
            lines += [f"{name}: {words(entry)}" for entry in value]
        else:
            lines.append(f"{name}: {words(value)}")
    return lines


def table(rows: Sequence[Sequence[str]], indent: str = "") -> list[str]:
    """Rows with their columns beneath each other; the last column is as wide as it is."""
    if not rows:
        return []
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]) - 1)]
    return [
        (indent + "  ".join([*(cell.ljust(width) for cell, width in zip(row, widths)), row[-1]])).rstrip()
        for row in rows
    ]


# --- progress ---------------------------------------------------------------------------------------------------------

WHEEL = "|/-\\"
PERIOD = 0.15
"""s between two turns of the wheel."""
STEP = ("path", "what", "state", "text")
"""Fields that tell of a step of a behaviour."""
NO_NAMES: Mapping[str, str] = MappingProxyType({})
TOLD_ELSEWHERE = frozenset({"index", "function", "count", "stamp"})


def progress_text(fields: Mapping[str, Any], called: Mapping[str, str] = NO_NAMES, more: bool = True) -> str:
    """Feedback of a server for people.

    `fields`: its plain values. `called`: as `Progress` takes it. `more`: with the details.
    """
    if fields.get("waiting"):
        return f"waits for {fields['waiting']}"
    if fields.get("what"):  # a step of a behaviour
        return " ".join(fields[name] for name in STEP if fields.get(name))
    function = fields.get("function", "")
    text = f"{fields.get('index', 0) + 1}/{fields.get('count', 1)} {called.get(function, function)}"
    told = {n: v for n, v in fields.items() if n not in TOLD_ELSEWHERE and filled(v) and v != 0} if more else {}
    return f"{text}: {words(told)}" if told else text


class Progress:
    """Shown from the beginning of a `with` block to its end.

    Feedback comes from a thread of ROS, the wheel turns in one of its own; the lock guards what they print. `called`:
    function -> what it is called here, where its name says nothing to people.
    """

    def __init__(self, called: Mapping[str, str] = NO_NAMES) -> None:
        self._called = called
        self._live = sys.stderr.isatty()
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._text = ""
        self._turns = 0
        self._thread: threading.Thread | None = None

    def feedback(self, message: Any) -> None:
        text = progress_text(plain(message), self._called, more=self._live)
        with self._lock:
            if text == self._text:
                return
            self._text = text
            if self._live:
                self._draw()
            else:
                click.echo(text, err=True)

    def note(self, text: str) -> None:
        """Show a line that stays."""
        with self._lock:
            self._wipe()
            click.echo(text, err=True)

    def __enter__(self) -> Progress:
        if self._live:
            self._thread = threading.Thread(target=self._turn, name="progress", daemon=True)
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        if self._thread is not None:
            self._thread.join()
        with self._lock:
            self._wipe()

    def _turn(self) -> None:
        while not self._ended.wait(PERIOD):
            with self._lock:
                self._turns += 1
                self._draw()

    def _draw(self) -> None:
        line = f"{WHEEL[self._turns % len(WHEEL)]} {self._text}"
        width = shutil.get_terminal_size().columns
        sys.stderr.write(f"\r\x1b[K{line[: width - 1]}")
        sys.stderr.flush()

    def _wipe(self) -> None:
        if self._live:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


# --- files ------------------------------------------------------------------------------------------------------------

overwrite_option = click.option("--overwrite", is_flag=True, help="Replace a file of that name.")


def wanted_file(file: str, overwrite: bool, kinds: Sequence[str] = ()) -> Path | None:
    """Where a file is to go, absolute, or the folder for it; None if that was left to the server.

    Asked for before anything is done: a recording that finds no place is lost. Raises click.UsageError if it ends in
    something else; CommandFailed if there is one already, or no folder for it. `overwrite`: whether it may be there
    already. `kinds`: what its name may end in, without the dot; empty where the server decides.
    """
    from ..core.files import NoPlaceForFile, require_new

    if not file:
        return None
    if Path(file).expanduser().is_dir():
        return Path(file).expanduser().absolute()
    if file.endswith(os.sep):
        raise CommandFailed(f"there is no folder {file}")
    if kinds and Path(file).suffix.lower().lstrip(".") not in kinds:
        raise click.UsageError(f"{file}: the name of the file ends in {' or '.join(f'.{kind}' for kind in kinds)}")
    try:
        return require_new(file, overwrite)
    except NoPlaceForFile as error:
        raise CommandFailed(str(error)) from None


def names_file(target: Path | None) -> bool:
    """Whether what `wanted_file` answers is a file, not a folder in which it has the name that the server gives it."""
    return target is not None and not target.is_dir()


def passing_name() -> str:
    """Name, without its end, that a file has at a server until it is brought: no other one has it, nor had it."""
    return f"nao-{os.getpid()}-{time.time_ns() // 1000}"


def bring(path: str, target: Path | None, overwrite: bool = False) -> str:
    """Move a file that a server has written to where it is wanted; where that is, as a text.

    `target`: as `wanted_file` answers it. `overwrite`: whether it replaces a file that is there by now; else it gets a
    number. Raises CommandFailed if it is on another computer, or cannot be moved.
    """
    from ..core.files import FileTrouble, move_whole

    if target is None:
        return path
    if not os.path.exists(path):
        raise CommandFailed(f"the file is on the computer of the server: {path}")
    if target.is_dir():
        target = target / Path(path).name
    try:
        return str(move_whole(Path(path), target, overwrite))
    except FileTrouble as error:
        raise CommandFailed(f"{error}; the file is {path}") from None
