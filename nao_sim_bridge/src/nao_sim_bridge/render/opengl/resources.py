"""What OpenGL draws with: a context that needs no display, canvases whose pixels come back, textures."""

from __future__ import annotations

import os
from collections import OrderedDict
from typing import Any, Iterable

import moderngl
import numpy as np

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.world.pictures import WorldPicture, paint

VERSION = 430
"""Draws of many things in one call came with it; software has more than that since years."""
MOST_THREADS = 4
# Names with their numbers, for the links without are part of packages for developers.
LIBRARIES = {"libgl": "libGL.so.1", "libegl": "libEGL.so.1"}
MOST_KEPT = 4
MANY_PIXELS = 4_000_000
"""Larger pictures are drawn with one sample a pixel: memory is not free, and their edges are fine."""
SAMPLES = 4
ANISOTROPY = 4.0
"""So many times narrower may a pixel be seen than it is high, and the picture stays sharp."""


def open_context() -> Any:
    """A moderngl context of OpenGL.

    Raises:
        SimulationError: OpenGL cannot be had here.
    """
    # Mesa tells on the standard error what it would have liked better than what it takes.
    os.environ.setdefault("EGL_LOG_LEVEL", "fatal")
    # In software: threads beside this one, which mostly waits for them. A core is left for the simulation.
    os.environ.setdefault("LP_NUM_THREADS", str(max(1, min(MOST_THREADS, (os.cpu_count() or 1) - 1))))
    try:
        return moderngl.create_context(standalone=True, require=VERSION, backend="egl", **LIBRARIES)
    except Exception as error:  # the package raises bare Exception
        raise SimulationError(str(error) or "no context") from error


class Canvas:
    """A picture of one size, whose edges are drawn for so many samples of each pixel."""

    def __init__(self, context: Any, width: int, height: int, samples: int) -> None:
        self._context = context
        size = (width, height)
        self._parts = [
            context.renderbuffer(size, 4, samples=samples),
            context.depth_renderbuffer(size, samples=samples),
        ]
        self._drawn = self._flat = context.framebuffer(self._parts[:1], self._parts[1])
        if samples:
            self._parts.append(context.renderbuffer(size, 4))
            self._flat = context.framebuffer(self._parts[2:])

    def begin(self) -> None:
        """Draw into it from now on."""
        self._drawn.use()
        self._drawn.clear(depth=1.0)

    def read(self) -> np.ndarray:
        """The (h, w, 3) uint8 pixels, in the order of the memory."""
        if self._flat is not self._drawn:
            self._context.copy_framebuffer(self._flat, self._drawn)
        width, height = self._flat.size
        pixels = np.empty((height, width, 3), dtype=np.uint8)
        self._flat.read_into(pixels, components=3, alignment=1)
        return pixels

    def release(self) -> None:
        for part in (*{self._drawn, self._flat}, *self._parts):
            part.release()


class Canvases:
    """One canvas a size; the last few are kept."""

    def __init__(self, context: Any) -> None:
        self._context = context
        self._kept: OrderedDict[tuple[int, int, int], Canvas] = OrderedDict()

    def get(self, width: int, height: int, fineness: int) -> Canvas:
        """A canvas; a fineness of 1 is for one sample a pixel, more is for smooth edges."""
        samples = SAMPLES if fineness > 1 and width * height <= MANY_PIXELS else 0
        key = (width, height, samples)
        if key not in self._kept:
            while len(self._kept) >= MOST_KEPT:
                self._kept.popitem(last=False)[1].release()
            self._kept[key] = Canvas(self._context, *key)
        self._kept.move_to_end(key)
        return self._kept[key]


class Textures:
    """Textures by what is on them."""

    def __init__(self, context: Any) -> None:
        self._context = context
        self._made: dict[WorldPicture, Any] = {}

    def keep(self, pictures: Iterable[WorldPicture]) -> None:
        """Free all but these."""
        wanted = set(pictures)
        for picture in set(self._made) - wanted:
            self._made.pop(picture).release()

    def use(self, picture: WorldPicture, place: int) -> None:
        """Bind one to a number of the programs, painted the first time."""
        if picture not in self._made:
            self._made[picture] = self._make(paint(picture))
        self._made[picture].use(place)

    def _make(self, pixels: np.ndarray) -> Any:
        height, width = pixels.shape[:2]
        # OpenGL counts rows from below.
        rows = np.ascontiguousarray(pixels[::-1])
        texture = self._context.texture((width, height), 3, rows.tobytes(), alignment=1)
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        texture.anisotropy = ANISOTROPY
        texture.repeat_x = texture.repeat_y = False
        return texture
