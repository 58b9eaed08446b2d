"""Where pictures are drawn, and how their pixels come back."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

import numpy as np

MOST_KEPT = 4
MANY_PIXELS = 4_000_000
"""Larger pictures are drawn with one sample a pixel: memory is not free, and their edges are fine."""
SAMPLES = 4


class Canvas:
    """A picture of one size.

    Args:
        samples: Points of each pixel that edges are drawn for.
    """

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
        """A canvas.

        Args:
            fineness: 1 for one sample a pixel; more for smooth edges.
        """
        samples = SAMPLES if fineness > 1 and width * height <= MANY_PIXELS else 0
        key = (width, height, samples)
        if key not in self._kept:
            while len(self._kept) >= MOST_KEPT:
                self._kept.popitem(last=False)[1].release()
            self._kept[key] = Canvas(self._context, *key)
        self._kept.move_to_end(key)
        return self._kept[key]
