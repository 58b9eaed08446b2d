"""Vision: the module NaoVision, and its threads for pictures of any camera, which need neither a NAO nor NAOqi."""

from __future__ import annotations

from typing import Any

__all__ = ["CAMERAS", "PARAMETERS", "ImageThreads", "NaoVision"]


def __getattr__(name: str) -> Any:
    """What is asked for is loaded: whoever has another camera needs nothing of the robot's."""
    if name == "ImageThreads":
        from .threads import ImageThreads

        return ImageThreads
    if name in __all__:
        from . import server

        return getattr(server, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
