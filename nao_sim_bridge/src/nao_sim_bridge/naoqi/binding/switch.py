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
        """Whether it is to work."""
        return self._wanted and not self._paused

    def start(self) -> None:
        """Somebody is subscribed."""
        with self._lock:
            self._wanted = True
            self._update()

    def stop(self) -> None:
        """Nobody is subscribed any more."""
        with self._lock:
            self._wanted = False
            self._update()

    def pause(self, paused: bool) -> None:
        """Do nothing for a while, or go on."""
        with self._lock:
            self._paused = paused
            self._update()

    @abstractmethod
    def _update(self) -> None:
        """Begin or end to work."""
