"""Modules that cost nothing until somebody calls them: they are not made, nor their code read, before that."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any, Callable

from nao_sim_bridge.base.imports import imported
from nao_sim_bridge.naoqi.binding.signals import Signals


class Later(Sequence):
    """The parts of a module, made when the first of its methods is called, in the thread of that call.

    The service of such a module publishes all methods of its table, as none of its parts is there to be looked at; they
    have to have them all.

    Attributes:
        signals: What the service publishes beside its methods, and the parts raise; None for nothing.

    Args:
        make: Makes the parts, once; when it raises, that call fails and the next one tries again.
    """

    def __init__(self, make: Callable[[], Sequence[Any]], signals: Signals | None = None) -> None:
        self.signals = signals
        self._make = make
        self._parts: Sequence[Any] | None = None
        self._lock = threading.RLock()

    @property
    def made(self) -> Sequence[Any]:
        """The parts if they are there, else none."""
        return self._parts or ()

    def __getitem__(self, index: Any) -> Any:
        return self._all()[index]

    def __len__(self) -> int:
        return len(self._all())

    def _all(self) -> Sequence[Any]:
        with self._lock:
            if self._parts is None:
                self._parts = self._make()
            return self._parts


def later(where: str, *arguments: Any, signals: Signals | None = None) -> Later:
    """A module of one part that is made later: the class at `where` with these arguments; see `imported`."""
    return Later(lambda: [imported(where)(*arguments)], signals)


def made(parts: Sequence[Any]) -> Sequence[Any]:
    """Those parts of a module that are there; does not make any."""
    return parts.made if isinstance(parts, Later) else parts
