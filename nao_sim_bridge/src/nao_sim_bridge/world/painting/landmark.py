"""Paints landmarks: a black disc with white fans on a white card."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.world.painting.known_landmarks import load_landmarks

PIXELS, FINER = 512, 3
"""Edge of the picture, and how many rays a pixel has each way: edges are soft."""
BLACK, WHITE = 18.0, 243.0
"""Of printed paper, not of a screen."""


def paint_landmark(number: int) -> np.ndarray:
    """A mark on its card, (512, 512, 3) uint8."""
    table = load_landmarks()
    count = PIXELS * FINER
    line = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    x, down = np.meshgrid(line * (1.0 + table.margin), line * (1.0 + table.margin))
    radius = np.hypot(x, down)
    clockwise = np.arctan2(x, -down) % (2.0 * np.pi)
    sector = np.minimum((clockwise / (2.0 * np.pi) * table.sectors).astype(int), table.sectors - 1)
    fans = np.array(table.marks[number])[sector] & (radius > table.fan_inner) & (radius < table.fan_outer)
    white = (radius > 1.0) | fans
    shade = np.where(white, WHITE, BLACK).reshape(PIXELS, FINER, PIXELS, FINER).mean(axis=(1, 3))
    return np.repeat(shade.astype(np.uint8)[..., None], 3, axis=2)
