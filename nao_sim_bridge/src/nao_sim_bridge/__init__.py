"""A simulated NAO: a library for Python, and a program that speaks NAOqi over libqi."""

from __future__ import annotations

from typing import Any

__all__ = ["NaoSim"]


def __getattr__(name: str) -> Any:
    """What a program imports from here is loaded when it does: ROS nodes and workers need little of it."""
    if name == "NaoSim":
        from nao_sim_bridge.library.nao_sim import NaoSim

        return NaoSim
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
