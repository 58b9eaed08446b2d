"""Paints what furniture and walls are made of: wood, cloth, bricks, backs of books, a view out of a window."""

from __future__ import annotations

from typing import Callable, Mapping

import numpy as np

from nao_sim_bridge.world.painting.canvas import Canvas, grain

PIXELS = 384


def paint_pattern(name: str) -> np.ndarray:
    """A square of it, (384, 384, 3) uint8."""
    canvas = Canvas(PIXELS, PIXELS, PIXELS / 2.0, (PIXELS / 2.0, PIXELS / 2.0), (0.5, 0.5, 0.5))
    PATTERNS[name](canvas)
    return canvas.pixels()


def _wood(color: tuple[float, float, float], seed: int) -> Callable[[Canvas], None]:
    def paint(canvas: Canvas) -> None:
        canvas.rgb[:] = color
        shape = canvas.x.shape
        bend = grain(shape, seed, (120, 190))
        rings = np.sin((canvas.y + 0.22 * bend) * 34.0 + 2.0 * grain(shape, seed + 1, (20, 200)))
        canvas.shade(0.5 + 0.5 * rings, 0.90)
        canvas.shade(0.5 + 0.5 * grain(shape, seed + 2, (2, 48)), 0.90)
        boards = np.abs(((canvas.y + 1.0) * 2.0) % 1.0 - 0.5) * 2.0
        canvas.shade(canvas.inside(boards - 0.985, 0.02), 0.66)

    return paint


def _checks(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.88, 0.86, 0.80)
    for line in (canvas.x, canvas.y):
        canvas.lay((((line + 1.0) * 3.0) % 1.0 < 0.5).astype(np.float32), (0.36, 0.48, 0.62), 0.45)


def _stripes(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.86, 0.84, 0.78)
    across = ((canvas.x + 1.0) * 5.0) % 1.0
    canvas.lay((across < 0.45).astype(np.float32), (0.40, 0.56, 0.52))
    canvas.lay((np.abs(across - 0.72) < 0.05).astype(np.float32), (0.70, 0.58, 0.36))


def _weave(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.55, 0.57, 0.60)
    over = np.sin(canvas.x * 110.0) * np.sin(canvas.y * 110.0)
    canvas.shade(0.5 + 0.5 * over, 0.82)
    canvas.shade(0.5 + 0.5 * grain(canvas.x.shape, 11, (3, 3)), 0.90)


def _bricks(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.78, 0.76, 0.72)
    row = np.floor((canvas.y + 1.0) * 6.0)
    down = ((canvas.y + 1.0) * 6.0) % 1.0
    along = ((canvas.x + 1.0) * 3.0 + 0.5 * (row % 2)) % 1.0
    brick = np.minimum(np.minimum(down, 1.0 - down) / 6.0, np.minimum(along, 1.0 - along) / 3.0) - 0.012
    canvas.lay(canvas.inside(brick), (0.62, 0.45, 0.38))
    canvas.shade(0.5 + 0.5 * grain(canvas.x.shape, 13, (6, 9)), 0.88)


def _books(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.16, 0.13, 0.11)
    colors = ((0.45, 0.22, 0.20), (0.22, 0.33, 0.45), (0.32, 0.42, 0.30), (0.72, 0.64, 0.48), (0.35, 0.30, 0.42))
    chance = np.random.default_rng(17)
    left = -0.99
    while left < 0.97:
        width, height = chance.uniform(0.08, 0.17), chance.uniform(1.35, 1.85)
        right = min(left + width, 0.99)
        top = -1.0 + height
        back = np.minimum(np.minimum(canvas.x - left - 0.005, right - canvas.x), top - canvas.y)
        canvas.lay(canvas.inside(back), colors[chance.integers(len(colors))])
        middle, half = (left + right) / 2.0, (right - left) / 2.0
        canvas.shade(canvas.inside(back) * np.clip(np.abs(canvas.x - middle) / half, 0.0, 1.0) ** 2, 0.72)
        for band in (0.78, 0.70, 0.16):
            stripe = np.minimum(back, 0.015 - np.abs(canvas.y + 1.0 - band * height))
            canvas.lay(canvas.inside(stripe), (0.82, 0.74, 0.52), 0.8)
        left = right


def _window(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.66, 0.80, 0.93)
    canvas.lay(canvas.inside(0.6 - canvas.y, 1.2), (0.86, 0.92, 0.96), 0.8)
    clouds = ((-0.4, 0.5, 0.18), (-0.2, 0.55, 0.24), (0.0, 0.5, 0.17), (0.5, 0.25, 0.14), (0.63, 0.28, 0.18))
    for x, y, radius in clouds:
        canvas.lay(canvas.ellipse(x, y, radius * 1.5, radius, soft=0.8), (0.97, 0.98, 0.99), 0.8)
    hill = -0.35 + 0.12 * np.sin(2.4 * canvas.x + 0.5)
    canvas.lay(canvas.inside(hill - canvas.y), (0.52, 0.66, 0.48))
    canvas.lay(canvas.inside(hill - 0.25 - canvas.y + 0.1 * canvas.x), (0.44, 0.58, 0.38))
    canvas.lay(canvas.stroke([(0.5, -0.6), (0.5, -0.2)], (0.03, 0.02)), (0.40, 0.32, 0.26))
    canvas.lay(canvas.ellipse(0.5, -0.05, 0.22, 0.26, soft=0.3), (0.34, 0.50, 0.30))
    edge = np.minimum(1.0 - np.abs(canvas.x), 1.0 - np.abs(canvas.y))
    bars = np.minimum(np.minimum(edge - 0.10, np.abs(canvas.x) - 0.03), np.abs(canvas.y - 0.2) - 0.03)
    canvas.lay(1.0 - canvas.inside(bars), (0.95, 0.95, 0.93))


PATTERNS: Mapping[str, Callable[[Canvas], None]] = {
    "oak": _wood((0.74, 0.60, 0.42), 1),
    "walnut": _wood((0.46, 0.33, 0.24), 5),
    "pine": _wood((0.86, 0.74, 0.56), 9),
    "checks": _checks,
    "stripes": _stripes,
    "weave": _weave,
    "books": _books,
    "window": _window,
    "bricks": _bricks,
}
"""What paints each pattern; the names are those of `pictures.py`."""
