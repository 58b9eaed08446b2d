"""What a goal does while it runs: one line that changes on a terminal, plain lines elsewhere. On standard error."""

from __future__ import annotations

import shutil
import sys
import threading
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import click

from .output import filled, plain, words

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
