"""A module without robot and without ROS: to look at its functions where nothing runs."""

from __future__ import annotations

import inspect
from typing import Any

from ..base.clock import WallClock


class _Nothing:
    """Takes the place of robot and ROS: whatever it is asked for, it is nothing, and does nothing."""

    address = ""
    state = "not connected"
    generation = 0

    def __getattr__(self, name: str) -> _Nothing:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __call__(self, *_: Any, **__: Any) -> _Nothing:
        return self


class _Edge(_Nothing):
    """Remembers what a module serves."""

    namespace = "/"

    def __init__(self) -> None:
        self.clock = WallClock()
        self.served: list[tuple[str, type]] = []

    def load(self) -> None:
        """There is nothing that was kept."""

    def driver(self) -> None:
        """There is none."""

    def action_server(self, name: str, action: type, *_: Any) -> _Nothing:
        """Note an action server."""
        self.served.append((name, action))
        return _Nothing()


def offline_module(kind: type, robot: Any = None) -> tuple[Any, list[tuple[str, type]]]:
    """A module that nothing runs, and the names and types of the actions that it would serve.

    Args:
        kind: Its class, of the family of NaoBasic.
        robot: What it asks; None: something that answers nothing.
    """
    edge = _Edge()
    # Some have more to do with ROS than others; what they take None for, they would make themselves.
    parameters = inspect.signature(kind).parameters.values()
    more = {parameter.name: _Nothing() for parameter in parameters if parameter.default is None}
    module = kind("127.0.0.1", 9559, **{**more, "launchpath": None, "robot": robot or _Nothing(), "edge": edge})
    return module, edge.served
