"""Goals of one action side by side: those that share nothing do not disturb each other."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import START_PATIENCE

from ..base.cancellation import CancellationToken
from ..base.error_codes import with_code
from ..base.errors import Preempted
from ..base.limits import limit
from .action_server import let_the_client_note_the_goal
from .health import GoalCounter
from .startup_grace import StartupGrace

log = logging.getLogger(__name__)

NEWER_GOAL = "a newer goal needs {}"
CANCELED = "canceled"
MOST = int(limit("goals").highest)
FULL = f"{MOST} goals of this action are under way: no more are taken at once"


class Replaced(Preempted):  # a signal, like Preempted
    """A newer goal takes over what this one has: an executor that walks need not stop for it."""


@dataclass
class GoalOutcome:
    """How a goal ended, as its executor tells it."""

    result: Any  # result message
    preempted: bool = False  # whether it was ended before time
    error: str = ""  # why it failed, for goals whose result says more; empty if it did not


@dataclass(eq=False)
class _Member:
    """A goal under way."""

    handle: Any
    interrupt: CancellationToken = field(default_factory=CancellationToken)
    ended: threading.Event = field(default_factory=threading.Event)
    claims: frozenset[str] = frozenset()
    reason: str = CANCELED


class ConcurrentActionServer:
    """Carries out every goal in a thread of its own; one that claims what older ones have ends these first.

    A client of nao_robot that sends a goal for the same joints ends its goal before, as ever. Clients that move
    different joints do not know of each other.

    Threads: goals and cancels come under actionlib's lock, so they start a thread or set a flag and no more. The lock
    here guards the list of goals.
    """

    def __init__(
        self,
        claims: Callable[[Any], frozenset[str]],
        execute: Callable[..., GoalOutcome],
        with_feedback: bool = False,
        robot: Any = None,
    ) -> None:
        """Take no goals yet; an action server hands them over.

        Args:
            claims: What a goal needs for itself, the names of joints. Raises NaoError for a goal that will not do.
            execute: Carries out a goal until its interrupt comes: it gets both. Raises NaoError if it fails.
            with_feedback: Whether `execute` gets, as a third argument, what publishes a feedback message.
            robot: The robot that goals need: one that was never reached yet is waited for, for a while.
        """
        self._claims = claims
        self._execute = execute
        self._with_feedback = with_feedback
        self._startup_grace = None if robot is None else StartupGrace(robot, START_PATIENCE)
        self._lock = threading.Lock()
        self._members: list[_Member] = []
        self._closed = False
        self.counter = GoalCounter()

    def on_goal(self, handle: Any) -> None:
        """Take a goal, or abort it where too many are under way; called by actionlib."""
        member = _Member(handle)
        with self._lock:
            full = len(self._members) >= MOST
            if not full:
                self._members.append(member)
            if self._closed:
                member.interrupt.trigger()
        handle.set_accepted()
        run = self._refuse if full else self._run
        threading.Thread(target=run, args=(member,), name="goal", daemon=True).start()

    def on_cancel(self, handle: Any) -> None:
        """End a goal; called by actionlib."""
        with self._lock:
            members = [m for m in self._members if m.handle == handle]
        for member in members:
            member.interrupt.trigger()

    def interrupt_all(self, reason: Exception | None = None) -> None:
        """End all goals. `reason`: what their executors get; Preempted if none is given."""
        with self._lock:
            members = list(self._members)
        for member in members:
            member.interrupt.trigger(reason)

    def close(self, limit: float) -> None:
        """End all goals, those that come later too, and wait for it. `limit`: s, for all together."""
        with self._lock:
            self._closed = True
            members = list(self._members)
        self.interrupt_all()
        for member in members:
            member.ended.wait(limit / max(1, len(members)))

    def _refuse(self, member: _Member) -> None:
        """Abort a goal that is one too many; takes no longer than a client needs to note it."""
        let_the_client_note_the_goal(time.monotonic())
        self.counter.ended("aborted", FULL)
        member.handle.set_aborted(None, FULL)

    def _run(self, member: _Member) -> None:
        taken_up = time.monotonic()
        try:
            end, result, text = self._carry_out(member)
            let_the_client_note_the_goal(taken_up)
            handle = member.handle
            tell = {"succeeded": handle.set_succeeded, "preempted": handle.set_canceled, "aborted": handle.set_aborted}
            self.counter.ended(end, text)
            tell[end](result, text)
        finally:
            with self._lock:
                self._members.remove(member)
            member.ended.set()

    def _carry_out(self, member: _Member) -> tuple[str, Any, str]:
        """End state, result and text."""
        try:
            if self._startup_grace is not None:
                self._startup_grace.wait(member.interrupt, lambda _: None)
            member.interrupt.check()
            goal = member.handle.get_goal()
            self._make_room(member, self._claims(goal))
            member.interrupt.check()
            more = (member.handle.publish_feedback,) if self._with_feedback else ()
            outcome = self._execute(goal, member.interrupt, *more)
        except Preempted:
            return "preempted", None, member.reason
        except NaoError as error:
            return "aborted", None, with_code(error)
        except Exception as error:
            log.exception("a goal failed")
            return "aborted", None, f"unexpected error: {error!r}"
        if outcome.preempted:
            return "preempted", outcome.result, member.reason
        if outcome.error:
            return "aborted", outcome.result, outcome.error
        return "succeeded", outcome.result, ""

    def _make_room(self, member: _Member, claims: frozenset[str]) -> None:
        """End older goals on the same joints. Of two that come at once, the later one in the list wins."""
        with self._lock:
            member.claims = claims
            older = self._members[: self._members.index(member)]
            younger = self._members[self._members.index(member) + 1 :]
            overtaken = [m for m in younger if m.claims & claims]
            in_the_way = [m for m in older if m.claims & claims]
        for other in in_the_way:
            other.reason = NEWER_GOAL.format(", ".join(sorted(other.claims & claims)))
            other.interrupt.trigger(Replaced())
        if overtaken:  # its thread was slower than that of the goal after it
            member.reason = NEWER_GOAL.format(", ".join(sorted(overtaken[0].claims & claims)))
            raise Preempted()
        for other in in_the_way:
            other.ended.wait()
