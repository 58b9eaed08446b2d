"""Drawing with OpenGL, on a graphics card or, without one, in software."""

from __future__ import annotations

from nao_sim_bridge.render.opengl.engine import OpenGLEngine

__all__ = ["OpenGLEngine"]
