"""Somebody waits for a frame: who, and what may come."""

from __future__ import annotations

from typing import Callable, Union

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.cameras.frame import Frame

Answer = Union[Frame, Exception]


class CameraClosed(SimulationError):
    """A stream, or all cameras, were closed while somebody waited for a frame."""


class Ask:
    """Somebody waits for a frame.

    Args:
        callback: Called once, with a frame or an error.
    """

    def __init__(self, callback: Callable[[Answer], None]) -> None:
        self.callback = callback
        self.given_up = False

    @property
    def answered(self) -> bool:
        """Whether the callback has been called, or is about to be."""
        return self.callback is _answered

    def take_callback(self) -> Callable[[Answer], None]:
        """The callback, to be called; it can be had once."""
        callback, self.callback = self.callback, _answered
        return callback


def _answered(_: Answer) -> None:
    """In the place of a callback that has been called: what it belongs to need not be kept."""
