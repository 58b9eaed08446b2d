"""How a walk ends before time: what the robot says about it."""

from __future__ import annotations

from typing import Any


class WalkFailure:
    """Why a walk ended before time, as the robot tells in an event that may come a little after the end.

    Told from a thread of libqi, asked from the one that executes goals.
    """

    def __init__(self) -> None:
        """Nothing has failed yet."""
        self._cause = ""

    def tell(self, value: Any) -> None:
        """Take a value of ALMotion/MoveFailed: cause, 0 not started or 1 stopped on the way, place of an obstacle."""
        self._cause = str(value[0]) if isinstance(value, (list, tuple)) and value else str(value or "")

    def forget(self) -> None:
        """A new walk begins."""
        self._cause = ""

    @property
    def cause(self) -> str:
        """What the robot said last; empty if nothing since `forget`."""
        return self._cause
