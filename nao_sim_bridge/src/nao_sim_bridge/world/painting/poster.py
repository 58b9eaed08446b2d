"""Paints posters: drawings of our own, of simple shapes."""

from __future__ import annotations

from typing import Callable, Mapping

import numpy as np

from nao_sim_bridge.world.painting.canvas import Canvas, grain

WIDTH, HEIGHT = 384, 512
UNIT = WIDTH / 2.0
"""Pixels of half the width: a poster is 2 wide and 2.67 high, with (0, 0) in the middle."""
FRAME = 0.05
WHITE = (0.95, 0.94, 0.91)


def paint_poster(name: str) -> np.ndarray:
    """A poster with a white border, (512, 384, 3) uint8."""
    canvas = Canvas(WIDTH, HEIGHT, UNIT, (WIDTH / 2.0, HEIGHT / 2.0), WHITE)
    DRAWINGS[name](canvas)
    inside = np.minimum(1.0 - FRAME - np.abs(canvas.x), HEIGHT / WIDTH - FRAME - np.abs(canvas.y))
    canvas.lay(1.0 - canvas.inside(inside), WHITE)
    return canvas.pixels()


def _hills(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.68, 0.83, 0.90)
    canvas.lay(canvas.inside(1.4 + canvas.y, 2.8), (0.55, 0.74, 0.88), 0.5)
    canvas.lay(canvas.ellipse(0.40, 0.72, 0.20, 0.20, soft=0.1), (0.98, 0.90, 0.55))
    layers = (
        (0.25, 0.17, 2.1, 0.3, (0.50, 0.63, 0.72)),
        (-0.05, 0.20, 1.6, 1.9, (0.38, 0.56, 0.58)),
        (-0.40, 0.15, 2.3, 4.0, (0.30, 0.50, 0.38)),
        (-0.80, 0.18, 1.7, 0.9, (0.42, 0.58, 0.28)),
    )
    for height, swing, pace, phase, color in layers:
        line = height + swing * np.sin(pace * canvas.x + phase) + swing * 0.3 * np.sin(3.1 * pace * canvas.x + phase)
        canvas.lay(canvas.inside(line - canvas.y), color)


def _circles(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.90, 0.86, 0.76)
    discs = (
        (-0.30, 0.45, 0.52, (0.20, 0.36, 0.52)),
        (0.35, 0.10, 0.44, (0.88, 0.66, 0.24)),
        (-0.15, -0.45, 0.36, (0.36, 0.55, 0.50)),
        (0.42, -0.72, 0.24, (0.24, 0.24, 0.28)),
        (-0.60, -0.85, 0.16, (0.62, 0.50, 0.66)),
    )
    for x, y, radius, color in discs:
        canvas.lay(canvas.ellipse(x, y, radius, radius), color, 0.88)
    canvas.lay(canvas.stroke([(-0.8, 1.0), (0.8, -1.1)], (0.012, 0.012)), (0.2, 0.2, 0.22))


def _leaves(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.94, 0.93, 0.86)
    canvas.lay(canvas.stroke([(0.0, -1.15), (0.05, 0.0), (-0.02, 1.05)], (0.022, 0.018, 0.008)), (0.32, 0.42, 0.26))
    for step in range(9):
        height = -0.85 + 0.21 * step
        side = 1.0 if step % 2 else -1.0
        size = 0.34 - 0.018 * step
        tone = 0.80 + 0.05 * (step % 3)
        mask = canvas.ellipse(side * size * 0.95, height + 0.12, size, size * 0.36, side * 0.55)
        canvas.lay(mask, (0.34 * tone, 0.56 * tone, 0.34 * tone))
        vein = [(side * 0.05, height - 0.03), (side * size * 1.6, height + 0.30)]
        canvas.lay(canvas.stroke(vein, (0.008, 0.004)), (0.80, 0.86, 0.70), 0.8)


def _waves(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.93, 0.90, 0.84)
    for step in range(8):
        line = 0.95 - 0.29 * step + 0.10 * np.sin(3.2 * canvas.x + 0.9 * step)
        share = step / 7.0
        color = (0.55 - 0.42 * share, 0.74 - 0.44 * share, 0.80 - 0.34 * share)
        canvas.lay(canvas.inside(line - canvas.y), color)


def _city(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.96, 0.80, 0.62)
    canvas.lay(canvas.inside(canvas.y - 0.1, 1.8), (0.72, 0.66, 0.78))
    chance = np.random.default_rng(7)
    for depth in range(3):
        left, tone = -1.0, 0.62 - 0.20 * depth
        while left < 1.0:
            width, top = chance.uniform(0.16, 0.34), chance.uniform(-0.35, 0.55) - 0.28 * depth
            block = np.minimum(np.minimum(canvas.x - left, left + width - canvas.x), top - canvas.y)
            canvas.lay(canvas.inside(block), (tone, tone * 0.94, tone * 1.08))
            lit = (np.sin((canvas.x - left) * 60.0) > 0.3) & (np.sin(canvas.y * 46.0) > 0.2) & (block > 0.03)
            canvas.lay(lit.astype(np.float32), (0.98, 0.88, 0.60), 0.15 + 0.25 * depth)
            left += width


def _planets(canvas: Canvas) -> None:
    canvas.rgb[:] = (0.08, 0.10, 0.20)
    stars = np.random.default_rng(3).uniform(-1.3, 1.3, (60, 2))
    for x, y in stars:
        canvas.lay(canvas.ellipse(float(x), float(y), 0.012, 0.012), (0.9, 0.9, 0.95))
    for x, y, radius, color in ((0.15, 0.30, 0.48, (0.86, 0.70, 0.48)), (-0.45, -0.62, 0.26, (0.40, 0.62, 0.72))):
        disc = canvas.ellipse(x, y, radius, radius)
        canvas.lay(disc, color)
        bands = 0.5 + 0.5 * np.sin((canvas.y - y) / radius * 9.0 + 0.6 * grain(canvas.x.shape, 5, (40, 60)))
        canvas.shade(disc * bands, 0.86)
        canvas.shade(disc * canvas.inside((canvas.x - x) + (y - canvas.y), radius * 1.6), 0.62)
    ring = canvas.ellipse(0.15, 0.30, 0.86, 0.20, 0.35) - canvas.ellipse(0.15, 0.30, 0.66, 0.13, 0.35)
    canvas.lay(np.clip(ring, 0.0, 1.0) * canvas.inside(0.42 - canvas.y + 0.36 * canvas.x), (0.80, 0.76, 0.66), 0.8)


DRAWINGS: Mapping[str, Callable[[Canvas], None]] = {
    "hills": _hills,
    "circles": _circles,
    "leaves": _leaves,
    "waves": _waves,
    "city": _city,
    "planets": _planets,
}
"""What paints each poster; the names are those of `pictures.py`."""
