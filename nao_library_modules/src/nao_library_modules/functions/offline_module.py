"""A module that no node runs, for its checks: in place of the robot a table of facts, in place of ROS nothing."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from ..base.clock import WallClock
from .known_robot import KnownRobot


def offline_module(kind: type) -> Any:
    """A module of a class of this package; it connects to nothing and serves nothing."""
    return kind("127.0.0.1", 9559, robot=KnownRobot(), node=_OfflineNode())


def _nothing(*_: Any) -> None:
    """What is published goes nowhere, what is served is never asked, and nothing is kept."""


class _OfflineNode:
    """Takes the place of `ServerNode`."""

    namespace = "/"
    driver = on_shutdown = publish_diagnostics = serve = serve_description = subscribe = staticmethod(_nothing)

    def __init__(self) -> None:
        self.clock = WallClock()

    def action_server(self, *_: Any) -> SimpleNamespace:
        """An action server that gets no goals."""
        return SimpleNamespace(start=_nothing)

    def event_sink(self) -> Callable[[str, Any], None]:
        return _nothing

    def frame_prefix(self) -> str:
        return ""

    def kept(self) -> SimpleNamespace:
        """What stands for `Kept`: a module that belongs to no node outlives nothing."""
        return SimpleNamespace(load=_nothing, save=_nothing, forget=_nothing)

    def seconds(self, _name: str, default: float) -> float:
        return default
