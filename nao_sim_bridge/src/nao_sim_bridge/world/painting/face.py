"""Paints faces: portraits for cards, and what is projected onto the front of a figure's head."""

from __future__ import annotations

import zlib

import numpy as np

from nao_sim_bridge.world.painting import face_features as features
from nao_sim_bridge.world.painting import face_hair as hair
from nao_sim_bridge.world.painting.canvas import Canvas
from nao_sim_bridge.world.painting.known_faces import HEAD_HALF_HEIGHT, FaceLook, load_faces

UNIT = 112
"""Pixels of half the width of a head."""
PORTRAIT = (336, 420)
"""Width and height of a portrait, in pixels."""
BACKGROUNDS = ((0.74, 0.80, 0.84), (0.84, 0.80, 0.74), (0.78, 0.83, 0.77), (0.82, 0.78, 0.82))


def paint_head(name: str) -> np.ndarray:
    """The front of somebody's head as seen from far ahead, (h, w, 3) uint8; its edges are the outline of the head."""
    look = load_faces()[name]
    size = (2 * UNIT, round(2 * UNIT * HEAD_HALF_HEIGHT))
    canvas = Canvas(*size, UNIT, (UNIT, size[1] / 2.0), look.skin)
    _paint_face(canvas, look, _seed(name))
    return canvas.pixels()


def paint_portrait(name: str) -> np.ndarray:
    """Somebody from the shoulders up, before a wall, (420, 336, 3) uint8."""
    look, seed = load_faces()[name], _seed(name)
    width, height = PORTRAIT
    origin = (width / 2.0, height * 0.44)
    canvas = Canvas(width, height, UNIT, origin, BACKGROUNDS[seed % len(BACKGROUNDS)])
    canvas.shade(canvas.ellipse(0.6, -0.6, 2.2, 2.2, soft=1.0), 1.06)
    hair.paint_back_hair(canvas, look, seed + 1)
    neck = canvas.inside(0.52 - np.abs(canvas.x), 0.03) * canvas.inside(-canvas.y - 0.6)
    canvas.lay(neck, look.skin)
    canvas.shade(neck * canvas.inside(-canvas.y - 0.8, 0.9), (0.70, 0.65, 0.63))
    shoulders = canvas.ellipse(0.0, -2.75, 1.75, 1.0, soft=0.02)
    collar = canvas.ellipse(0.0, -1.72, 0.56, 0.30, soft=0.05)
    canvas.lay(shoulders * (1.0 - collar), look.clothes)
    for sign in features.SIDES:
        ear = canvas.ellipse(sign * 1.0, -0.10, 0.13, 0.27, soft=0.1)
        if look.hair_style not in ("long", "fringe"):
            canvas.lay(ear, look.skin)
            canvas.shade(ear, 0.80)
    face = Canvas(width, height, UNIT, origin, look.skin)
    _paint_face(face, look, seed)
    mask = canvas.inside(features.face_outline(canvas, look), 0.02)[..., None]
    canvas.rgb += mask * (face.rgb - canvas.rgb)
    return canvas.pixels()


def _paint_face(canvas: Canvas, look: FaceLook, seed: int) -> None:
    features.paint_skin(canvas, look)
    features.paint_folds(canvas, look)
    features.paint_mouth(canvas, look)
    features.paint_nose(canvas, look)
    features.paint_eyes(canvas, look)
    hair.paint_beard(canvas, look, seed + 3)
    features.paint_brows(canvas, look)
    hair.paint_hair(canvas, look, seed)
    hair.paint_glasses(canvas, look)


def _seed(name: str) -> int:
    return zlib.crc32(name.encode())
