"""What works while somebody is subscribed and it is not paused: what extractors have in common inside."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from typing import Any, Callable, Mapping

from nao_sim_bridge.naoqi.binding.errors import NaoqiError


class Switch(ABC):
    """Begins to work when somebody wants it, and ends when nobody does or it is paused. Any thread may call.

    Who inherits it writes `_update`, which is called under the lock whenever `_works` may have changed.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._wanted = False
        self.paused = False  # whether it does nothing although somebody is subscribed

    @property
    @abstractmethod
    def runs(self) -> bool:
        """Whether it works: somebody is subscribed, and it is not paused."""

    @property
    def _works(self) -> bool:
        return self._wanted and not self.paused

    def start(self) -> None:
        """Somebody is subscribed."""
        self._set("_wanted", True)

    def stop(self) -> None:
        """Nobody is subscribed any more."""
        self._set("_wanted", False)

    def pause(self, paused: bool) -> None:
        """Do nothing for a while, or go on."""
        self._set("paused", paused)

    def _set(self, name: str, value: bool) -> None:
        with self._lock:
            setattr(self, name, value)
            self._update()

    @abstractmethod
    def _update(self) -> None:
        """Begin or end to work."""


class SwitchModule:
    """What NAOqi's extractors with ears or eyes have in common, and nothing else; `setters` take parameters by name."""

    def __init__(self, switch: Switch, setters: Mapping[str, Callable[[Any], Any]]) -> None:
        self._switch = switch
        self._setters = setters

    def pause(self, status: bool) -> None:
        self._switch.pause(bool(status))

    def isPaused(self) -> bool:
        return self._switch.paused

    def isProcessing(self) -> bool:
        return self._switch.runs

    def setParameter(self, parameter: str, value: Any) -> None:
        if parameter not in self._setters:
            raise NaoqiError(f"unknown parameter {parameter!r}; there are {', '.join(self._setters)}")
        self._setters[parameter](value)
