"""Nodes that keep the robot from walking. Counted: it walks again when all of them have let go."""

from __future__ import annotations

import threading
from collections import Counter
from typing import Any

from ...base.kept import Kept


class WalkInhibition:
    """Holds on walking, by the node that put them on. Every method may be called from any thread.

    A node that inhibits walking means the others: one that follows a path keeps a joystick from interfering, and walks
    itself. `kept`: where they are kept for the time after the death of this node. `own`: name of this node: holds of
    parts that died with it are gone.
    """

    def __init__(self, kept: Kept, own: str = "") -> None:
        self._lock = threading.Lock()
        self._kept = kept
        self._holds: Counter[str] = kept.load(_kept_holds) or Counter()
        self._holds.pop(own, None)

    def inhibit(self, owner: str) -> int:
        """Put a hold on walking; how many there are now."""
        with self._lock:
            self._holds[owner] += 1
            return self._keep()

    def let_go(self, owner: str) -> int:
        """Take a hold off, one of the node's own if it has any, else the first that was put on; how many are left.

        A person who lets go at a command line has another name each time. Without any hold this is no error: clients
        of nao_robot let go to be sure, or once more than they inhibited.
        """
        with self._lock:
            if not self._holds:
                return 0
            held = owner if owner in self._holds else next(iter(self._holds))
            self._holds[held] -= 1
            if not self._holds[held]:
                del self._holds[held]
            return self._keep()

    def drop(self) -> None:
        """Take all holds off."""
        with self._lock:
            self._holds.clear()
            self._keep()

    def _keep(self) -> int:
        self._kept.save(self._holds)
        return sum(self._holds.values())

    @property
    def owners(self) -> list[str]:
        with self._lock:
            return list(self._holds)

    def against(self, node: str) -> list[str]:
        """The other nodes that keep a node from walking."""
        return [owner for owner in self.owners if owner != node]


def _kept_holds(kept: Any) -> Counter[str]:
    if not all(type(count) is int and count > 0 for count in kept.values()):
        raise ValueError(f"{kept!r} does not count holds on walking")
    return Counter(kept)
