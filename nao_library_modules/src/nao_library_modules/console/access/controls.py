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
        self._listeners: dict[object, Callable[[], None]] = {}

    def enter(self, session: Session, robot: str) -> Callable[[], None]:
        """A page was opened; what comes back is to be called when it is gone."""
        key = object()
        with self._lock:
            self._pages[key] = (session, robot)
        self._tell()
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
            changed = self._holders.get(robot) is not session
            self._holders[robot] = session
        if changed:
            self._tell()
        return True

    def release(self, robot: str, session: Session) -> None:
        with self._lock:
            if self._holders.get(robot) is session:
                del self._holders[robot]
        self._tell()

    def may_move(self, robot: str, session: Session) -> bool:
        """Whether somebody may move a robot now: who holds its controls, or an operator where nobody does."""
        holder = self.holder(robot)
        if holder is None:
            return self.take(robot, session)
        return holder is session

    def refusal(self, robot: str, session: Session) -> str:
        """Why somebody may not move a robot."""
        if not session.operator:
            return "observers look on; only operators move the robot"
        holder = self.holder(robot)
        return f"{holder.name if holder else 'nobody'} holds the controls of {robot}: take them over first"

    def subscribe(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Have changes told; what comes back ends that."""
        key = object()
        with self._lock:
            self._listeners[key] = listener
        return lambda: self._forget(key)

    def _leave(self, key: object) -> None:
        with self._lock:
            session, robot = self._pages.pop(key, (None, ""))
            there = any(page == (session, robot) for page in self._pages.values())
            if not there and self._holders.get(robot) is session:
                del self._holders[robot]
        self._tell()

    def _forget(self, key: object) -> None:
        with self._lock:
            self._listeners.pop(key, None)

    def _tell(self) -> None:
        with self._lock:
            listeners = list(self._listeners.values())
        for listener in listeners:
            listener()
