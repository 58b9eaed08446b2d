"""What may draw the pictures of a simulation, by name."""

from __future__ import annotations

from nao_sim_bridge.base.errors import UnknownName

RENDERERS = ("auto", "opengl", "builtin")


def require_renderer(name: str) -> None:
    """Raise UnknownName if nothing of that name draws."""
    if name not in RENDERERS:
        raise UnknownName("renderer", name, RENDERERS)
