"""All robots of a master."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

from ...base.suggestion import of_those
from .errors import NotThere
from .events import namespace_of
from .master import MasterLook
from .robot import RobotClient

log = logging.getLogger(__name__)

PERIOD = 2.0
"""s of this computer between two looks for new servers while somebody watches."""


class Robots:
    """The robots that the master knows, each made when it is asked for first. Any thread."""

    def __init__(self) -> None:
        self.master = MasterLook()
        self._lock = threading.Lock()
        self._robots: dict[str, RobotClient] = {}
        self._watchers: dict[object, Callable[[], None]] = {}
        self._changed = threading.Condition()

    def names(self) -> list[str]:
        """Names of the robots: their namespaces without slashes, or "/"."""
        return [namespace.strip("/") or "/" for namespace in self.master.namespaces()]

    def robot(self, name: str = "") -> RobotClient:
        """A robot by its name; empty: the first. Raises NotThere if it has never been seen."""
        known = self.known(name) if name else None
        if known is not None:
            return known
        names = self.names()
        wanted = name.strip("/") or ("/" if name or "/" in names or not names else names[0])
        namespace = namespace_of(wanted)
        with self._lock:
            if namespace in self._robots:
                return self._robots[namespace]
            if name and wanted not in names:
                raise NotThere(f"there is no robot {name!r}{of_those(wanted, names)}")
            return self._robots.setdefault(namespace, RobotClient(namespace, self.master))

    def known(self, name: str) -> RobotClient | None:
        """A robot that was asked for before; the master is not asked, as a stop must not wait for it."""
        with self._lock:
            return self._robots.get(namespace_of(name))

    def watch(self, robot: RobotClient) -> Callable[[], None]:
        """Follow what a robot does and which servers it has, until what comes back is called."""
        key, end = object(), robot.watch()
        with self._changed:
            first = not self._watchers
            self._watchers[key] = robot.refresh
        if first:
            threading.Thread(target=self._look, name="look at the master", daemon=True).start()
        return lambda: self._leave(key, end)

    def _leave(self, key: object, end: Callable[[], None]) -> None:
        with self._changed:
            if self._watchers.pop(key, None) is None:
                return
            self._changed.notify_all()
        end()

    def _look(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: not self._watchers, PERIOD)
                if not self._watchers:
                    return
                watched = set(self._watchers.values())
            for refresh in watched:
                try:
                    refresh()
                except Exception:  # looks again in a while
                    log.exception("a look at the master failed")
