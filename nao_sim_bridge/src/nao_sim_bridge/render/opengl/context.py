"""A place to draw with OpenGL that needs no display."""

from __future__ import annotations

import os
from typing import Any

from nao_sim_bridge.base.errors import SimulationError

VERSION = 430
"""Draws of many things in one call came with it; software has more than that since years."""
MOST_THREADS = 4
# Names with their numbers, for the links without are part of packages for developers.
LIBRARIES = {"libgl": "libGL.so.1", "libegl": "libEGL.so.1"}


def open_context() -> Any:
    """A moderngl context of OpenGL.

    Raises:
        SimulationError: OpenGL cannot be had here.
        ImportError: The Python package is not installed.
    """
    # Mesa tells on the standard error what it would have liked better than what it takes.
    os.environ.setdefault("EGL_LOG_LEVEL", "fatal")
    # In software: threads beside this one, which mostly waits for them. A core is left for the simulation.
    os.environ.setdefault("LP_NUM_THREADS", str(max(1, min(MOST_THREADS, (os.cpu_count() or 1) - 1))))
    import moderngl

    try:
        return moderngl.create_context(standalone=True, require=VERSION, backend="egl", **LIBRARIES)
    except Exception as error:  # the package raises bare Exception
        raise SimulationError(str(error) or "no context") from error


def describe(context: Any) -> str:
    """What draws, for people."""
    return f"OpenGL: {context.info['GL_RENDERER']}"
