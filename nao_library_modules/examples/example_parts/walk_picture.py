"""Draws a recorded walk as seen from above: footprints, centre of mass, centre of pressure. Needs Pillow."""

from __future__ import annotations

import math
from typing import Iterable, List, Sequence, Tuple

from PIL import Image, ImageDraw, ImageFont

from .walk_record import LEFT, RIGHT, Footprint, Place, Point, Sample, footprints, moved

# Contact patch of the left sole around the point below the ankle, m, counter-clockwise; the right one is its mirror
# image. Source: measured on the robot's surface model.
SOLE = (
    *((-0.0507, -0.0214), (-0.0426, -0.0306), (-0.0377, -0.0337), (0.0577, -0.0388), (0.0740, -0.0373)),
    *((0.0877, -0.0315), (0.0918, -0.0277), (0.0969, -0.0188), (0.0994, -0.0101), (0.1001, -0.0016)),
    *((0.0990, 0.0087), (0.0970, 0.0165), (0.0940, 0.0242), (0.0905, 0.0295), (0.0846, 0.0361)),
    *((0.0799, 0.0395), (0.0657, 0.0461), (0.0572, 0.0477), (-0.0312, 0.0517), (-0.0359, 0.0496)),
    *((-0.0410, 0.0460), (-0.0491, 0.0376)),
)
# The number of a step stands here in its sole, m: ahead of the ankle, where no path runs.
NUMBER_AT = 0.075
PAPER, GRID, INK = (255, 255, 255), (226, 226, 230), (60, 60, 66)
MASS, PRESSURE = (20, 140, 60), (190, 40, 150)
LINES = {LEFT: (35, 95, 180), RIGHT: (205, 85, 20)}
FILLS = {LEFT: (205, 222, 245), RIGHT: (252, 222, 200)}
# Around everything, m; between the lines of the grid, m.
MARGIN, MESH = 0.06, 0.1
# Drawn so many times larger and then reduced, for smooth edges.
FINE = 3
# Largest picture, pixels; the largest scale, pixels for each m.
WIDTH, HEIGHT, LARGEST = 1280, 960, 1200.0
LEGEND = 30
Color = Tuple[int, int, int]


class _Map:
    def __init__(self, points: Sequence[Point]) -> None:
        xs, ys = zip(*points)
        self.low = (min(xs) - MARGIN, min(ys) - MARGIN)
        self.high = (max(xs) + MARGIN, max(ys) + MARGIN)
        wide, tall = (b - a for a, b in zip(self.low, self.high))
        self.scale = min(LARGEST, WIDTH / wide, (HEIGHT - LEGEND) / tall)
        # The legend has room even below a robot that went nowhere.
        self.size = (max(640, math.ceil(wide * self.scale)), math.ceil(tall * self.scale) + LEGEND)

    def at(self, x: float, y: float) -> Point:
        """Pixels of a point on the ground; x points to the right, y up."""
        fine = FINE * self.scale
        return ((x - self.low[0]) * fine, (self.high[1] - y) * fine)


def draw(samples: Sequence[Sample]) -> Image.Image:
    """Draw a walk to scale; the sides of a square of the grid are 0.1 m.

    Args:
        samples: At least one.

    Raises:
        ValueError: There is no sample.
    """
    if not samples:
        raise ValueError("a walk without a sample cannot be drawn")
    prints = footprints(samples)
    pressures = [point for point in (sample.pressure for sample in samples) if point]
    masses = [sample.mass for sample in samples]
    corners = [corner for each in prints for corner in outline(each.foot, each.place)]
    ground = _Map([*corners, *masses, *pressures])
    picture = Image.new("RGB", (ground.size[0] * FINE, ground.size[1] * FINE), PAPER)
    pen = ImageDraw.Draw(picture)
    _draw_grid(pen, ground)
    for each in prints:
        line = LINES[each.foot]
        corners = [ground.at(*corner) for corner in outline(each.foot, each.place)]
        pen.polygon(corners, fill=FILLS[each.foot])
        pen.line([*corners, corners[0]], fill=line, width=2 * FINE)
    for number, each in enumerate(prints, 1):
        if each.planned:
            _cross(pen, ground.at(*each.planned[:2]), LINES[each.foot])
            _ring(pen, ground.at(*each.place[:2]), LINES[each.foot])
        pen.text(
            ground.at(*moved(each.place, NUMBER_AT, 0.0)), str(number), LINES[each.foot], _font(14 * FINE), anchor="mm"
        )
    for point in pressures:
        _dot(pen, ground.at(*point), PRESSURE)
    if len(masses) > 1:
        pen.line([ground.at(*point) for point in masses], fill=MASS, width=2 * FINE, joint="curve")
    _draw_legend(pen, ground, prints)
    return picture.resize(ground.size, Image.LANCZOS)


def outline(foot: str, place: Place) -> List[Point]:
    """Outline of a sole on the ground, m."""
    side = 1.0 if foot == LEFT else -1.0
    return [moved(place, x, side * y) for x, y in SOLE]


def _draw_grid(pen: ImageDraw.ImageDraw, ground: _Map) -> None:
    low, high = ground.low, ground.high
    for x in _marks(low[0], low[0] + ground.size[0] / ground.scale):
        pen.line([ground.at(x, low[1]), ground.at(x, high[1])], fill=GRID, width=FINE)
    for y in _marks(low[1], high[1]):
        right = low[0] + ground.size[0] / ground.scale
        pen.line([ground.at(low[0], y), ground.at(right, y)], fill=GRID, width=FINE)


def _marks(low: float, high: float) -> Iterable[float]:
    return (MESH * index for index in range(math.ceil(low / MESH), math.floor(high / MESH) + 1))


def _draw_legend(pen: ImageDraw.ImageDraw, ground: _Map, prints: Sequence[Footprint]) -> None:
    y = (ground.size[1] - LEGEND / 2.0) * FINE
    x = 12.0 * FINE
    entries = [("left foot", LINES[LEFT]), ("right foot", LINES[RIGHT]), ("centre of mass", MASS)]
    entries += [("centre of pressure", PRESSURE)]
    font = _font(13 * FINE)
    for text, color in entries:
        pen.rectangle([x, y - 5 * FINE, x + 10 * FINE, y + 5 * FINE], fill=color)
        pen.text((x + 15 * FINE, y), text, INK, font, anchor="lm")
        x += 15 * FINE + pen.textlength(text, font) + 16 * FINE
    words = "squares of 0.1 m" + (", ankle: o as it is, x as planned" if any(each.planned for each in prints) else "")
    pen.text((x, y), words, INK, font, anchor="lm")


def _cross(pen: ImageDraw.ImageDraw, at: Point, color: Color) -> None:
    x, y = at
    arm = 4 * FINE
    pen.line([(x - arm, y - arm), (x + arm, y + arm)], fill=color, width=FINE)
    pen.line([(x - arm, y + arm), (x + arm, y - arm)], fill=color, width=FINE)


def _ring(pen: ImageDraw.ImageDraw, at: Point, color: Color) -> None:
    x, y = at
    pen.ellipse([x - 4 * FINE, y - 4 * FINE, x + 4 * FINE, y + 4 * FINE], outline=color, width=FINE)


def _dot(pen: ImageDraw.ImageDraw, at: Point, color: Color) -> None:
    x, y = at
    pen.ellipse([x - 1.5 * FINE, y - 1.5 * FINE, x + 1.5 * FINE, y + 1.5 * FINE], fill=color)


def _font(size: int) -> ImageFont.FreeTypeFont:
    return ImageFont.load_default(size)
