"""Paints hair, beard and glasses of a face. Places as in `face_features.py`."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.world.painting.canvas import Canvas, grain
from nao_sim_bridge.world.painting.face_features import NEARLY_BLACK, SIDES
from nao_sim_bridge.world.painting.known_faces import HEAD_HALF_HEIGHT, FaceLook

STRANDS = (9, 2)
"""Size of the grains of hair in pixels, down and across."""


def paint_hair(canvas: Canvas, look: FaceLook, seed: int) -> None:
    """Hair over the forehead and at the sides."""
    if look.hair_style == "bald":
        canvas.shade(canvas.ellipse(-0.15, 1.05, 0.4, 0.22, soft=1.0), 1.22)
        return
    x, y = canvas.x, canvas.y
    line = look.hairline - 0.30 * np.abs(x) ** 4
    side = 0.90
    lowest = {"short": 0.10, "fringe": -0.55, "long": -1.40, "parted": -0.10, "curly": -0.35}[look.hair_style]
    if look.hair_style == "parted":
        line = look.hairline - 0.42 * np.clip(x + 0.30, 0.0, None) ** 1.5 - 0.55 * np.clip(-0.30 - x, 0.0, None)
    elif look.hair_style == "fringe":
        line = look.hairline + 0.02 * np.sin(x * 23.0) - 0.25 * x**4
        side = 0.82
    elif look.hair_style == "long":
        line = look.hairline - 0.85 * np.abs(x) ** 1.8
        side = 0.80
    elif look.hair_style == "curly":
        line = look.hairline + 0.07 * np.sin(x * 14.0) - 0.34 * np.abs(x) ** 2.5
        side = 0.84 + 0.04 * np.sin(y * 13.0)
    top = canvas.inside(y - line, 0.05)
    sides = canvas.inside(np.abs(x) - side, 0.04) * canvas.inside(y - lowest, 0.10)
    shadow = canvas.inside(y - line + 0.10, 0.20)
    canvas.shade(shadow * (1.0 - top), 0.80)
    _lay_hair(canvas, np.maximum(top, sides), look, seed)


def paint_back_hair(canvas: Canvas, look: FaceLook, seed: int) -> None:
    """What is to be seen behind and above the head, on portraits."""
    if look.hair_style == "bald":
        return
    if look.hair_style == "curly":
        bumps = 0.05 * np.sin(np.arctan2(canvas.y - 0.2, canvas.x) * 19.0)
        reach = np.hypot(canvas.x / 1.22, (canvas.y - 0.28) / 1.42) + bumps
        mask = canvas.inside(1.0 - reach, 0.04) * canvas.inside(canvas.y + 0.75, 0.2)
    else:
        mask = canvas.ellipse(0.0, 0.10, 1.08, 1.46, soft=0.03) * canvas.inside(canvas.y - 0.05, 0.3)
    if look.hair_style in ("long", "fringe"):
        low = -2.0 if look.hair_style == "long" else -0.75
        wide = 1.10 + 0.10 * np.sin(np.clip((0.6 - canvas.y) / 2.6, 0.0, 1.0) * np.pi)
        fall = canvas.inside(wide - np.abs(canvas.x), 0.04)
        fall = fall * canvas.inside(canvas.y - low, 0.2) * canvas.inside(0.4 - canvas.y, 0.5)
        mask = np.maximum(mask, fall)
    _lay_hair(canvas, mask, look, seed, 0.82)


def paint_beard(canvas: Canvas, look: FaceLook, seed: int) -> None:
    """Beard and moustache, around the mouth."""
    x, y = canvas.x, canvas.y
    rough = 0.5 + 0.5 * grain(x.shape, seed, (5, 2))
    mouth = canvas.ellipse(0.0, -0.90, look.mouth[0] + 0.06, 0.15, soft=0.3)
    if look.beard > 0.0:
        edge = -0.80 + 0.68 * np.clip(np.abs(x) - 0.30, 0.0, 0.8) ** 1.1
        mask = canvas.inside(edge - y, 0.18) * (1.0 - mouth)
        canvas.lay(mask * (0.72 + 0.28 * rough), look.hair, look.beard)
    if look.moustache > 0.0:
        height = -look.nose[1] - 0.16
        half = look.mouth[0] + 0.06
        points = [(-half, height - 0.14), (-half * 0.5, height - 0.015), (0.0, height + 0.015)]
        points += [(-px, py) for px, py in points[1::-1]]
        mask = canvas.stroke(points, (0.02, 0.065, 0.05, 0.065, 0.02), 0.03)
        canvas.lay(mask * (0.75 + 0.25 * rough), look.hair, look.moustache * 0.95)


def paint_glasses(canvas: Canvas, look: FaceLook) -> None:
    """A frame around the eyes, with some light on the glass."""
    if look.glasses == "none":
        return
    if look.glasses == "round":
        power, half_width, half_height, thick, color = 2.0, 0.30, 0.27, 0.022, (0.48, 0.26, 0.20)
    else:
        power, half_width, half_height, thick, color = 5.0, 0.33, 0.23, 0.042, NEARLY_BLACK
    for sign in SIDES:
        dx = np.abs(canvas.x - sign * (look.eyes[0] + 0.01)) / half_width
        dy = np.abs(canvas.y + 0.02) / half_height
        reach = ((dx**power + dy**power) ** (1.0 / power) - 1.0) * min(half_width, half_height)
        canvas.lay(canvas.inside(thick - np.abs(reach)), color)
        arm = [(sign * (look.eyes[0] + half_width), 0.05), (sign * 1.02, 0.08)]
        canvas.lay(canvas.stroke(arm, (thick, thick)), color)
    gap = look.eyes[0] - half_width
    canvas.lay(canvas.stroke([(-gap, 0.03), (0.0, 0.07), (gap, 0.03)], [thick] * 3), color)


def _lay_hair(canvas: Canvas, mask: np.ndarray, look: FaceLook, seed: int, light: float = 1.0) -> None:
    strands = grain(mask.shape, seed, (5, 5) if look.hair_style == "curly" else STRANDS)
    shine = np.exp(-(((canvas.y - 1.05 * HEAD_HALF_HEIGHT * 0.78 + 0.15 * np.abs(canvas.x)) / 0.14) ** 2))
    level = light * (0.92 + 0.22 * strands + 0.35 * shine)
    color = np.asarray(look.hair, np.float32) * level[..., None]
    canvas.rgb += mask[..., None] * (color - canvas.rgb)
