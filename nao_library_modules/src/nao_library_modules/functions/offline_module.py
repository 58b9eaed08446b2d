"""A module that no node runs, for its checks: in place of the robot a table of facts, in place of ROS nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..base.clock import WallClock
from .known_robot import KnownRobot


def offline_module(kind: type) -> Any:
    """A module of a class of this package; it connects to nothing and serves nothing."""
    return kind("127.0.0.1", 9559, robot=KnownRobot(), node=_OfflineNode())


class _OfflineServer:
    """An action server that gets no goals."""

    def start(self) -> None:
        """There is nothing to start."""


class _NothingKept:
    """Takes the place of `Kept`: what belongs to no node outlives nothing."""

    def load(self) -> None:
        """Nothing was kept."""

    def save(self, _value: Any) -> None:
        """Nothing is kept."""

    forget = load


class _OfflineNode:
    """Takes the place of `ServerNode`: what is published goes nowhere, what is served is never asked."""

    namespace = "/"

    def __init__(self) -> None:
        self.clock = WallClock()

    def action_server(self, *_: Any) -> _OfflineServer:
        return _OfflineServer()

    def driver(self) -> None:
        """There is none."""

    def event_sink(self) -> Callable[[str, Any], None]:
        return lambda _name, _value: None

    def frame_prefix(self) -> str:
        return ""

    def kept(self) -> _NothingKept:
        return _NothingKept()

    def on_shutdown(self, _action: Callable[[], None]) -> None:
        """It does not end."""

    def publish_diagnostics(self, *_: Any) -> None:
        """Nobody would see them."""

    def seconds(self, _name: str, default: float) -> float:
        return default

    def serve(self, *_: Any) -> None:
        """Nobody would ask."""

    serve_description = subscribe = serve
