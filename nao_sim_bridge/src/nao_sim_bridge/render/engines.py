"""Which engine draws: OpenGL where the computer has it, else the slower one that comes with the physics engine."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.render.scene.view import View
from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import World

HELP = "for OpenGL without a graphics card install the packages libegl1, libgl1 and libgl1-mesa-dri"


class Engine(Protocol):
    """Something that draws; one thread only. Its name is for people."""

    name: str

    def draw(self, state: RenderState, view: View) -> np.ndarray:
        """The (h, w, 3) uint8 picture of a state; the caller may write into it."""

    def close(self) -> None:
        """Free what it holds."""


def open_engine(wanted: str, world: World, version: str) -> tuple[Engine, str | None]:
    """The engine for a world.

    Args:
        wanted: "opengl", "builtin", or "auto" for OpenGL where it can be had.

    Returns:
        It, and why it is not the better one; None if it is what was wanted.

    Raises:
        SimulationError: There is no OpenGL, and nothing else is wanted.
    """
    complaint = None
    if wanted != "builtin":
        try:
            from nao_sim_bridge.render.opengl.engine import OpenGLEngine

            return OpenGLEngine(world, version), None
        except (ImportError, SimulationError) as error:
            if wanted == "opengl":
                raise SimulationError(f"OpenGL: {error}; {HELP}") from error
            complaint = f"pictures are drawn slowly, without OpenGL: {error}; {HELP}"
    from nao_sim_bridge.render.studio import Studio

    return Studio(world, version), complaint
