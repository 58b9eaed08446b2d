"""What works while somebody is subscribed and it is not paused: what extractors have in common inside."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod


class Switch(ABC):
    """Begins to work when somebody wants it, and ends when nobody does or it is paused. Any thread may call.

    Who inherits it writes `_update`, which is called under the lock whenever `_works` may have changed.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._wanted = False
        self._paused = False

    @property
    def paused(self) -> bool:
        """Whether it does nothing although somebody is subscribed."""
        return self._paused

    @property
    def _works(self) -> bool:
        return self._wanted and not self._paused

    def start(self) -> None:
        """Somebody is subscribed."""
        self._set("_wanted", True)

    def stop(self) -> None:
        """Nobody is subscribed any more."""
        self._set("_wanted", False)

    def pause(self, paused: bool) -> None:
        """Do nothing for a while, or go on."""
        self._set("_paused", paused)

    def _set(self, name: str, value: bool) -> None:
        with self._lock:
            setattr(self, name, value)
            self._update()

    @abstractmethod
    def _update(self) -> None:
        """Begin or end to work."""
