"""Pictures that are on things, as textures."""

from __future__ import annotations

from typing import Any, Iterable

import moderngl
import numpy as np

from nao_sim_bridge.world.pictures import WorldPicture, paint

ANISOTROPY = 4.0
"""So many times narrower may a pixel be seen than it is high, and the picture stays sharp."""


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
