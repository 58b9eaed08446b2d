"""Who keeps the robot from walking. Counted: it walks again when everybody has let go."""

from __future__ import annotations

import threading
from collections import Counter

from naoqi.errors import NaoError

from ...base.kept import Kept


class NotInhibited(NaoError):
    """Somebody lets walking go that nobody inhibits."""

    def __init__(self) -> None:
        """Compose the text."""
        super().__init__("walking is not inhibited, so there is nothing to let go")


class WalkInhibition:
    """Holds on walking, by who put them on. Every method may be called from any thread.

    Args:
        kept: Where they are kept for the time after the death of this node.
        own: Name of this node: holds of parts that died with it are gone.

    Whoever inhibits walking means the others: a node that follows a path keeps a joystick from interfering, and
    walks itself.
    """

    def __init__(self, kept: Kept, own: str = "") -> None:
        self._lock = threading.Lock()
        self._kept = kept
        self._holds: Counter[str] = Counter(kept.load() or {})
        self._holds.pop(own, None)

    def inhibit(self, owner: str) -> int:
        """Put a hold on walking.

        Args:
            owner: Name of the node that does.

        Returns:
            How many there are now.
        """
        with self._lock:
            self._holds[owner] += 1
            return self._keep()

    def let_go(self, owner: str) -> int:
        """Take a hold off: one of the node's own if it has any, else the first that was put on.

        A person who lets go at a command line has another name each time.

        Args:
            owner: Name of the node that does.

        Returns:
            How many are left.

        Raises:
            NotInhibited: If there is none.
        """
        with self._lock:
            if not self._holds:
                raise NotInhibited()
            held = owner if owner in self._holds else next(iter(self._holds))
            self._holds[held] -= 1
            if not self._holds[held]:
                del self._holds[held]
            return self._keep()

    def _keep(self) -> int:
        """Keep what there is; its number."""
        self._kept.save(self._holds)
        return sum(self._holds.values())

    @property
    def owners(self) -> list[str]:
        """Who inhibits walking."""
        with self._lock:
            return list(self._holds)

    def against(self, node: str) -> list[str]:
        """Who else keeps a node from walking."""
        return [owner for owner in self.owners if owner != node]
