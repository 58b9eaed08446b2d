"""A goal from a shell: sent, watched, stopped by Ctrl-C, and what came of it as plain values."""

from __future__ import annotations

import logging
import signal
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import click

from naoqi.limits import GOAL_END_LIMIT

from ..core.server_types import DESCRIBE, installed_message
from .cli_settings import CliSettings
from .output import NO_NAMES, CommandFailed, CommandInterrupted, Progress, StackMissing, plain, say_json, say_result

LOOK_PERIOD = 1.0
"""s between two looks whether the server is still there."""


@dataclass(frozen=True)
class GoalEnd:
    """How a goal ended."""

    server: str  # relative name of the action
    state: str  # succeeded, aborted, preempted, ..
    text: str
    result: dict[str, Any]  # its fields as plain values
    elapsed: float  # s of this computer

    @property
    def succeeded(self) -> bool:
        return self.state == "succeeded"


def run_functions(settings: CliSettings, server: str, functions: Sequence[Any]) -> GoalEnd:
    """Send function messages as one goal and wait for its end.

    Raises:
        CommandFailed: It failed or took too long.
        CommandInterrupted: Somebody pressed Ctrl-C; the goal is over then.
        StackMissing: The server is not there or went away.
    """
    run = GoalRun(settings, server)
    try:
        end = run.run(functions)
    except CommandInterrupted:
        if settings.json and run.last is not None:
            show(settings, run.last)
        raise
    if not end.succeeded:
        fail(settings, end)
    return end


def carry_out(settings: CliSettings, server: str, functions: Sequence[Any], quiet: bool = False) -> GoalEnd:
    """Run functions and print what came of it. `quiet`: print only what the server remarks."""
    end = run_functions(settings, server, functions)
    if settings.json or not quiet:
        show(settings, end)
    elif end.text:
        click.echo(end.text, err=True)
    return end


def show(settings: CliSettings, end: GoalEnd) -> None:
    """Print what came of a goal."""
    if settings.json:
        say_json(vars(end))
    else:
        say_result(end.result, end.text, failed=not end.succeeded)


def fail(settings: CliSettings, end: GoalEnd) -> None:
    """Tell that a goal did not succeed, with what was done until then.

    Raises StackMissing: the robot is not there; CommandFailed: otherwise.
    """
    show(settings, end)
    if end.state == "aborted" and not settings.stack.connected(end.server):
        raise StackMissing(end.text)
    raise CommandFailed(end.text or f"the goal ended {end.state}")


class GoalRun:
    """One goal of one server, from a node that lives as long as the program.

    Args:
        called: As `Progress` takes it.

    Attributes:
        last: How it ended, also if it was interrupted; None before.
    """

    def __init__(self, settings: CliSettings, server: str, called: Mapping[str, str] = NO_NAMES) -> None:
        self._settings = settings
        self._called = called
        self._name = settings.stack.server(server)
        self._relative = self._name[len(settings.stack.namespace) :]
        kind = settings.stack.describe(server, brief=True).action
        self._action, self._goal = message_class(f"{kind}Action"), message_class(f"{kind}Goal")
        from ..ros.goal_client import GoalTracker

        self._watch = GoalTracker()
        self.last: GoalEnd | None = None

    def run(self, functions: Sequence[Any]) -> GoalEnd:
        """Send a goal of these functions and wait for its end, whatever it is."""
        import actionlib

        from ..ros.goal_client import SERVER_LIMIT

        start_node()
        began = time.monotonic()
        client = actionlib.ActionClient(self._name, self._action)
        found = threading.Event()
        threading.Thread(target=lambda: client.wait_for_server() and found.set(), daemon=True).start()
        if not found.wait(SERVER_LIMIT):
            raise StackMissing(f"the server {self._name} does not answer")
        handle: Any = None
        with Progress(self._called) as progress:
            try:
                with interrupt_held():  # a goal that is sent and of which nobody knows could not be cancelled
                    handle = client.send_goal(
                        self._goal(list(functions)), self._watch.look, lambda _, message: progress.feedback(message)
                    )
                self._wait(began)
            except _TooLong:
                if self._cancel(handle):
                    self.last = self._end(handle, began)
                    if self._settings.json:
                        show(self._settings, self.last)
                    raise CommandFailed(f"not done within {self._settings.timeout:g} s: cancelled") from None
            except KeyboardInterrupt:
                if handle is None:
                    raise CommandInterrupted("stopped before anything was sent") from None
                cancelled = self._cancel(handle, progress)
                self.last = self._end(handle, began)
                became = "stopped" if cancelled else f"the goal was over before: {self.last.state}"
                raise CommandInterrupted(self.last.text or became) from None
        self.last = self._end(handle, began)
        return self.last

    def _wait(self, began: float) -> None:
        while True:
            left = LOOK_PERIOD
            if self._settings.timeout is not None:
                left = min(left, began + self._settings.timeout - time.monotonic())
            if self._watch.over.wait(max(left, 0.0)):
                return
            if left <= 0.0:
                raise _TooLong
            if not self._settings.stack.graph.alive(self._name + DESCRIBE):
                raise StackMissing(f"the server {self._name} went away while the goal ran")

    def _cancel(self, handle: Any, progress: Progress | None = None) -> bool:
        """Cancel the goal, tell of that, and wait for its end; whether it was not over before."""
        with interrupt_held():  # who presses Ctrl-C now ends the wait, and not the cancel
            cancelled = self._watch.cancel(handle)
            if cancelled and progress is not None:
                progress.note("stopping")
        if not self._watch.over.wait(GOAL_END_LIMIT):
            raise CommandFailed(f"the goal was cancelled {GOAL_END_LIMIT:g} s ago and does not end")
        return cancelled

    def _end(self, handle: Any, began: float) -> GoalEnd:
        from actionlib_msgs.msg import GoalStatus

        state = GoalStatus.to_string(handle.get_terminal_state()).lower()
        result = handle.get_result()
        fields = {} if result is None else plain(result)
        elapsed = round(time.monotonic() - began, 3)
        return GoalEnd(self._relative, state, handle.get_goal_status_text() or "", fields, elapsed)


@contextmanager
def interrupt_held() -> Iterator[None]:
    """Keep Ctrl-C back: it counts when the block is over."""
    if threading.current_thread() is not threading.main_thread():
        yield  # signals go to the main thread
        return
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if came:
        raise KeyboardInterrupt


class _TooLong(Exception):  # a signal within this file
    """The time is up."""


def start_node() -> None:
    """Make this program a node, without a place in the log of the robot and without handling of Ctrl-C."""
    import rospy

    logging.getLogger("rosout").setLevel(logging.ERROR)
    if not rospy.core.is_initialized():
        try:
            rospy.init_node("nao", argv=["nao"], anonymous=True, disable_rosout=True, disable_signals=True)
        except rospy.ROSException as error:
            raise StackMissing(f"this program cannot become a node: {error}") from None


def function_message(settings: CliSettings, server: str, **fields: Any) -> Any:
    """A function message of a server. `fields`: its fields; those that are None keep their defaults."""
    kind = message_class(settings.stack.describe(server, brief=True).message)
    return kind(**{name: value for name, value in fields.items() if value is not None})


def message_class(kind: str) -> Any:
    found = installed_message(kind)
    if found is None:
        raise click.ClickException(
            f"the message {kind} is not known here: build its package, and source that workspace before you call nao"
        )
    return found
