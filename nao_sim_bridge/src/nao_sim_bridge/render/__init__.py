"""Pictures of the simulation, made in a process of their own so that the physics never waits for them."""

from __future__ import annotations

from nao_sim_bridge.render.client import Renderer, RenderError, Viewer
from nao_sim_bridge.render.png import write_png
from nao_sim_bridge.world.render_state import PRESETS, Camera, RenderState, RobotLook, preset_camera

__all__ = [
    "PRESETS",
    "Camera",
    "RenderError",
    "RenderState",
    "Renderer",
    "RobotLook",
    "Viewer",
    "preset_camera",
    "write_png",
]
