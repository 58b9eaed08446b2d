"""Paints the features of a face: shading of the skin, eyes, brows, nose, mouth, folds.

Places count from the middle between the eyes, in halves of the head's width.
"""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.world.painting.canvas import Canvas, arch
from nao_sim_bridge.world.painting.known_faces import HEAD_HALF_HEIGHT, FaceLook

SIDES = (-1.0, 1.0)
WHITE_OF_EYE = (0.94, 0.93, 0.91)
NEARLY_BLACK = (0.07, 0.05, 0.05)


def face_outline(canvas: Canvas, look: FaceLook) -> np.ndarray:
    """Signed depth inside the outline of the head, about in lengths; below the cheeks it depends on the jaw."""
    height = np.clip(canvas.y / HEAD_HALF_HEIGHT, -1.0, 1.0)
    round_part = np.sqrt(1.0 - height**2)
    half_width = np.where(canvas.y < 0.0, round_part ** (0.55 + 0.45 * look.jaw), round_part)
    sideways = half_width - np.abs(canvas.x)
    upwards = HEAD_HALF_HEIGHT - np.abs(canvas.y)
    return np.minimum(sideways, upwards)


def paint_skin(canvas: Canvas, look: FaceLook) -> None:
    """Roundness of the head, sockets, cheeks, temples, chin."""
    side = np.clip(np.abs(canvas.x), 0.0, 1.2)
    canvas.shade(np.clip(side, 0.0, 1.0) ** 3, (0.66, 0.60, 0.57))
    canvas.shade(canvas.inside(-canvas.y - 1.05, 0.7), (0.72, 0.68, 0.66))
    canvas.shade(canvas.ellipse(0.0, 0.62, 0.62, 0.34, soft=1.0), 1.07)
    for sign in SIDES:
        eye = look.eyes[0] * sign
        canvas.shade(canvas.ellipse(eye, 0.07, 0.36, 0.24, soft=1.0), (0.72, 0.66, 0.64))
        canvas.shade(canvas.ellipse(eye * 1.12, -0.36, 0.27, 0.17, soft=1.0), 1.07)
        rose = canvas.ellipse(eye * 1.28, -0.46, 0.28, 0.20, soft=1.0)
        canvas.lay(rose, (look.skin[0], look.skin[1] * 0.72, look.skin[2] * 0.70), 0.55 * look.blush)
        canvas.shade(canvas.ellipse(0.86 * sign, 0.28, 0.16, 0.42, soft=1.0), 0.90)
    canvas.shade(canvas.ellipse(0.0, -1.19, 0.20, 0.13, soft=1.0), 1.08)


def paint_folds(canvas: Canvas, look: FaceLook) -> None:
    """What years leave: folds from the nose to the mouth, under the eyes, on the forehead."""
    nose_width, nose_length = look.nose
    for sign in SIDES:
        start, end = (sign * (nose_width + 0.06), -nose_length + 0.08), (sign * (look.mouth[0] + 0.13), -0.90)
        middle = (sign * (nose_width + 0.17), -nose_length - 0.08)
        canvas.shade(canvas.stroke([start, middle, end], (0.006, 0.014, 0.004), 0.06), 0.90 - 0.16 * look.age)
        eye = look.eyes[0] * sign
        bag = [(eye + x, y - 0.19) for x, y in arch(0.20, -0.03, 0.05)]
        canvas.shade(canvas.stroke(bag, [0.008] * 9, 0.05), 0.94 - 0.18 * look.age)
    for height in (0.55, 0.70):
        line = [(x, y + height) for x, y in arch(0.45, 0.03, 0.0)]
        canvas.shade(canvas.stroke(line, [0.006] * 9, 0.05), 1.0 - 0.14 * look.age)


def paint_eyes(canvas: Canvas, look: FaceLook) -> None:
    """Eyes that look ahead, with lids, lashes and the light in them."""
    distance, half_width, half_height = look.eyes
    for sign in SIDES:
        x = distance * sign
        upper = 1.0 - ((canvas.x - x) / half_width) ** 2
        slit = np.minimum(half_height * 1.15 * upper - canvas.y, canvas.y + half_height * 0.95 * upper)
        opening = canvas.inside(slit)
        canvas.lay(opening, WHITE_OF_EYE)
        canvas.shade(opening * canvas.inside(canvas.y - half_height * 0.45, half_height), 0.72)
        radius = half_height * 0.98
        iris = canvas.ellipse(x, 0.01, radius, radius) * opening
        canvas.lay(iris, look.iris)
        canvas.shade(iris * (1.0 - canvas.ellipse(x, 0.01, radius * 0.8, radius * 0.8, soft=0.3)), 0.45)
        canvas.lay(canvas.ellipse(x, 0.01, radius * 0.50, radius * 0.50) * opening, NEARLY_BLACK)
        canvas.lay(canvas.ellipse(x - 0.03, 0.045, radius * 0.24, radius * 0.24) * opening, (1.0, 1.0, 1.0))
        lid = [(x + t, y) for t, y in arch(half_width * 1.05, half_height * 1.18, -0.01)]
        thick = 0.016 + 0.016 * look.lashes
        canvas.lay(canvas.stroke(lid, [thick * 0.6, *[thick] * 7, thick * 0.6]), NEARLY_BLACK, 0.92)
        if look.lashes > 0.6:
            outer = x + sign * half_width
            wing = [(outer - sign * 0.05, 0.03), (outer + sign * 0.07, 0.085)]
            canvas.lay(canvas.stroke(wing, (0.022, 0.006)), NEARLY_BLACK, 0.9)
        crease = [(x + t, y + 0.055) for t, y in arch(half_width * 0.98, half_height * 1.25, 0.02)]
        canvas.shade(canvas.stroke(crease, [0.012] * 9, 0.03), 0.70)
        under = [(x + t, y) for t, y in arch(half_width, -half_height * 0.98, 0.0)]
        canvas.shade(canvas.stroke(under, [0.008] * 9, 0.02), 0.68)


def paint_brows(canvas: Canvas, look: FaceLook) -> None:
    """Brows, thick towards the nose."""
    thickness, height, tilt = look.brows
    color = tuple(0.62 * part for part in look.hair)
    for sign in SIDES:
        points, widths = [], []
        for t in np.linspace(-1.0, 1.0, 7):
            across = look.eyes[0] + 0.02 + 0.27 * t
            points.append((float(sign * across), float(height + 0.045 * (1.0 - t * t) + 0.27 * t * tilt)))
            widths.append(float(thickness * 0.5 * (1.0 - 0.55 * max(t, 0.0))))
        canvas.lay(canvas.stroke(points, widths, thickness * 0.5), color, 0.9)


def paint_nose(canvas: Canvas, look: FaceLook) -> None:
    """A nose by its lights and shadows alone."""
    half_width, length = look.nose
    for sign in SIDES:
        bridge = [(sign * 0.115, 0.12), (sign * 0.10, -0.16), (sign * (half_width * 0.80), -length + 0.10)]
        canvas.shade(canvas.stroke(bridge, (0.03, 0.02, 0.03), 0.14), 0.80 if sign > 0 else 0.86)
        wing = canvas.ellipse(sign * half_width * 0.78, -length + 0.04, half_width * 0.36, 0.085, soft=0.7)
        canvas.shade(wing, 0.88)
    canvas.shade(canvas.stroke([(0.0, 0.15), (0.0, -length + 0.16)], (0.02, 0.035), 0.09), 1.12)
    canvas.shade(canvas.ellipse(0.0, -length + 0.09, 0.10, 0.085, soft=0.9), 1.12)
    under = [(x, y - length) for x, y in arch(half_width * 0.9, -0.045, 0.03)]
    canvas.shade(canvas.stroke(under, [0.014] * 9, 0.06), 0.62)
    for sign in SIDES:
        hole = canvas.ellipse(sign * half_width * 0.45, -length - 0.012, half_width * 0.25, 0.036, 0.2 * sign, 0.5)
        canvas.lay(hole, NEARLY_BLACK, 0.72)
    canvas.shade(canvas.ellipse(0.0, -length - 0.14, 0.05, 0.09, soft=1.0), 0.90)


def paint_mouth(canvas: Canvas, look: FaceLook) -> None:
    """Closed lips: the upper one in shadow, the lower one in the light."""
    half_width, half_height, corners = look.mouth
    y = -0.88
    reach = np.clip(1.0 - (canvas.x / half_width) ** 2, 0.0, None)
    middle = y + corners * (canvas.x / half_width) ** 2
    cupid = 1.0 - 0.28 * np.exp(-((canvas.x / (half_width * 0.22)) ** 2))
    upper = np.minimum(middle + half_height * 0.95 * reach * cupid - canvas.y, canvas.y - middle)
    lower = np.minimum(middle - canvas.y, canvas.y - middle + half_height * 1.25 * np.sqrt(reach) * reach**0.25)
    there = canvas.inside(half_width - np.abs(canvas.x))
    canvas.lay(canvas.inside(upper, 0.015) * there, tuple(0.78 * part for part in look.lips))
    canvas.lay(canvas.inside(lower, 0.015) * there, look.lips)
    canvas.shade(canvas.ellipse(0.0, y - half_height * 0.62, half_width * 0.5, half_height * 0.34, soft=1.0), 1.16)
    line = [(x, h + y) for x, h in arch(half_width * 1.04, 0.0, corners)]
    canvas.lay(canvas.stroke(line, [0.007, *[0.013] * 7, 0.007], 0.012), (0.22, 0.08, 0.08), 0.9)
    canvas.shade(canvas.ellipse(0.0, y - half_height * 1.25 - 0.09, half_width * 0.7, 0.075, soft=1.0), 0.80)
    for sign in SIDES:
        canvas.shade(canvas.ellipse(sign * (half_width + 0.04), y + corners, 0.06, 0.06, soft=1.0), 0.84)
