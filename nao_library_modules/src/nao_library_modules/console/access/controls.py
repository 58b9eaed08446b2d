"""Who is there, and which operator holds the controls of which robot."""

from __future__ import annotations

import threading
from collections.abc import Callable

from .sessions import Session


class Controls:
    """Of all robots. Any thread.

    One operator at a time holds the controls of a robot: the first who does something, until another takes them or the
    last page of the holder is gone.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pages: dict[object, tuple[Session, str]] = {}
        self._holders: dict[str, Session] = {}

    def enter(self, session: Session, robot: str) -> Callable[[], None]:
        """A page was opened; what comes back is to be called when it is gone."""
        key = object()
        with self._lock:
            self._pages[key] = (session, robot)
        return lambda: self._leave(key)

    def visitors(self, robot: str) -> list[Session]:
        """Who has a page of a robot open, each once."""
        with self._lock:
            return list(dict.fromkeys(session for session, where in self._pages.values() if where == robot))

    def holder(self, robot: str) -> Session | None:
        with self._lock:
            return self._holders.get(robot)

    def take(self, robot: str, session: Session) -> bool:
        """Hold the controls from now on, whoever did before; whether that is allowed."""
        if not session.operator:
            return False
        with self._lock:
            self._holders[robot] = session
        return True

    def release(self, robot: str, session: Session) -> None:
        with self._lock:
            if self._holders.get(robot) is session:
                del self._holders[robot]

    def may_move(self, robot: str, session: Session) -> bool:
        """Whether somebody may move a robot now: who holds its controls, or an operator where nobody does."""
        if not session.operator:
            return False
        with self._lock:
            return self._holders.setdefault(robot, session) is session

    def refusal(self, robot: str, session: Session) -> str:
        """Why somebody may not move a robot."""
        if not session.operator:
            return "observers look on; only operators move the robot"
        holder = self.holder(robot)
        return f"{holder.name if holder else 'nobody'} holds the controls of {robot}: take them over first"

    def forget(self, session: Session) -> None:
        """Somebody has logged out."""
        with self._lock:
            self._holders = {robot: holder for robot, holder in self._holders.items() if holder is not session}

    def _leave(self, key: object) -> None:
        with self._lock:
            self._pages.pop(key, None)
            there = {session for session, _ in self._pages.values()}
            self._holders = {robot: holder for robot, holder in self._holders.items() if holder in there}
