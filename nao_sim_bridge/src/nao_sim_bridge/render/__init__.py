"""Pictures of the simulation, made in a process of their own so that the physics never waits for them."""

from __future__ import annotations

from nao_sim_bridge.base.errors import UnknownName

ENGINES = ("auto", "opengl", "builtin")


def require_engine(name: str) -> None:
    """Raise UnknownName if nothing of that name draws."""
    if name not in ENGINES:
        raise UnknownName("renderer", name, ENGINES)
