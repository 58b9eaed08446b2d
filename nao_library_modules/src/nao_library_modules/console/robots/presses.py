"""What users press, and what of it has failed, until they have looked."""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Tuple

from .runs import GoalEnd, Run, end_of

PATIENCE = 2.0
"""s for which a press waits for a server that has gone: others wait behind it."""
MOST = 50
"""Failed presses that are kept of a user; the oldest goes for a new one."""
FAILED = "failed"
"""Kind of the event that a press has failed."""
LONGEST_REASON = 2000
MOST_IDS = 1000
"""Ids of presses that are known; the oldest goes for a new one."""


@dataclass(frozen=True)
class Press:
    """A button that a user presses.

    Attributes:
        label: What stands on the button.
        by: The user.
        page: Path of the page that it is on.
        robot: Namespace of the robot that it is for.
        group: Title of the button's group, on the wizard's page.
        via: click or key.
        streams: Events of the robots that are told of it: that of the page, and that of the button.
    """

    label: str
    by: str
    page: str = ""
    robot: str = "/"
    group: str = ""
    via: str = "click"
    streams: Tuple[Any, ...] = ()

    @property
    def place(self) -> tuple[str, str, str]:
        """Robot, group and label: which button it is."""
        return self.robot, self.group, self.label

    def log(self, kind: str, text: str, **data: Any) -> None:
        """Add an event to the logs of its robots."""
        about = {"group": self.group, "button": self.label, "via": self.via, "page": self.page, "of": self.robot}
        for events in dict.fromkeys(self.streams):
            events.add(kind, text, self.by, **{**about, **data})


@dataclass(frozen=True)
class FailedPress:
    """A press whose goal has not succeeded. `when`: s since 1970, of the last of `count` that failed alike."""

    id: int
    press: Press
    end: GoalEnd
    reason: str
    when: float
    count: int = 1

    @property
    def text(self) -> str:
        """For people: when, which button, how it ended and why."""
        clock = time.strftime("%H:%M:%S", time.localtime(self.when))
        what = ", ".join(filter(None, (self.press.group, self.press.label, self.press.robot.strip("/"))))
        times = f" ({self.count} times)" if self.count > 1 else ""
        return f"{clock}  {what or 'A press'}: {self.end.word}{times}" + (f": {self.reason}" if self.reason else "")


class Presses:
    """The presses of all pages that have failed and that their users have not looked at. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._numbers = itertools.count(1)
        self._failed: dict[str, dict[int, FailedPress]] = {}  # by user, the newest last
        self._listeners: dict[object, Callable[[], None]] = {}
        self._ids: dict[str, None] = {}  # the newest last

    def is_new(self, press_id: str) -> bool:
        """Whether nothing was heard yet of a press: it may arrive, and be told as not sent, in any order.

        `press_id`: of the page that it is on; empty: it has none, and is new.
        """
        if not press_id:
            return True
        with self._lock:
            if press_id in self._ids:
                return False
            self._ids[press_id] = None
            if len(self._ids) > MOST_IDS:
                del self._ids[next(iter(self._ids))]
            return True

    def follow(self, press: Press, run: Run) -> None:
        """Report how the goal of a press ends."""
        run.on_end(lambda over: self.report(press, end_of(over.state), over.text, goal=over.id))

    def report(self, press: Press, end: GoalEnd, reason: str = "", keep: bool = True, **data: Any) -> None:
        """Log that a press has not succeeded, and keep it unless its user has looked. `data`: further fields to log."""
        if not end.failed:
            return
        reason = reason[:LONGEST_REASON]
        text = f"{press.label}: {end.word}" + (f": {reason}" if reason else "")
        press.log(FAILED, text, state=end.state, reason=reason, **data)
        if not keep:
            return
        with self._lock:
            failed = self._failed.setdefault(press.by, {})
            alike = (press.place, press.page, end, reason)
            for kept in list(failed.values()):
                if (kept.press.place, kept.press.page, kept.end, kept.reason) == alike:
                    del failed[kept.id]
                    failed[kept.id] = replace(kept, when=time.time(), count=kept.count + 1)
                    break
            else:
                number = next(self._numbers)
                failed[number] = FailedPress(number, press, end, reason, time.time())
                if len(failed) > MOST:
                    del failed[next(iter(failed))]
        self._tell()

    def unseen(self, user: str) -> list[FailedPress]:
        """Failed presses that a user has not looked at, the newest first."""
        with self._lock:
            return list(reversed(self._failed.get(user, {}).values()))

    def seen(self, user: str, number: int | None = None) -> None:
        """A user has looked at a failed press, or at all of them."""
        with self._lock:
            failed = self._failed.get(user, {})
            failed.clear() if number is None else failed.pop(number, None)
        self._tell()

    def ends(self, user: str) -> Mapping[tuple[str, str, str], GoalEnd]:
        """Places of buttons -> how the newest press of a user has failed."""
        with self._lock:
            return {kept.press.place: kept.end for kept in self._failed.get(user, {}).values()}

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Have changes told, in the thread that makes them; what comes back ends that."""
        key = object()
        with self._lock:
            self._listeners[key] = callback
        return lambda: self._forget(key)

    def _forget(self, key: object) -> None:
        with self._lock:
            self._listeners.pop(key, None)

    def _tell(self) -> None:
        with self._lock:
            listeners = list(self._listeners.values())
        for listener in listeners:
            listener()
