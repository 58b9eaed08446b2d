"""Finds red balls by their colour and by their outline."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.vision.cone import Cone, fit_cone
from nao_sim_bridge.vision.settings import BallSettings, load_vision

ROUNDS = 3
"""How often edges are looked for, each time from a better middle."""
WHOLE = 0.95
"""With less of its edge inside the picture, a ball counts as cut."""
BORDER = 1.5
"""Pixels; an edge closer to that of the picture may be that of the picture."""
INSIDE = (0.35, 0.8)
"""Where along a ray the ball is surely meant, as shares of the radius."""
REACH = 1.6
"""How far outwards edges are looked for, as a share of the radius."""
STEPS = 48
"""Samples along a ray."""


@dataclass(frozen=True)
class Ball:
    """A red ball in a picture.

    Attributes:
        alpha: Direction of its centre seen from above, rad, positive to the left.
        beta: Direction of its centre seen from the side, rad, positive downwards.
        radius: Angular radius, rad.
        x: Its centre in the picture, 0 at the left edge and 1 at the right one.
        y: The same from the upper edge to the lower one.
        quality: How much it looks like a ball, up to 1.
    """

    alpha: float
    beta: float
    radius: float
    x: float
    y: float
    quality: float

    def distance(self, radius: float) -> float:
        """Distance from the camera to its centre, m, when its radius is `radius`, m."""
        return radius / math.sin(self.radius)


class BallDetector:
    """Red balls of any size, also those that the edge of the picture cuts, best first."""

    def __init__(self, settings: BallSettings | None = None) -> None:
        self._settings = settings or load_vision().ball

    def detect(self, image: np.ndarray, optics: Optics, _: Any = None) -> list[Ball]:
        """The balls in a picture; see `Detector`."""
        excess, redness = red_parts(image, self._settings.dark)
        found: list[Ball] = []
        for level in self._settings.redness:
            for component in _components(redness, level, self._settings):
                ball = self._ball(component, excess, redness, optics)
                if ball is not None and not any(_same(ball, other) for other in found):
                    found.append(ball)
        return sorted(found, key=lambda ball: -ball.quality)

    def _ball(self, component: np.ndarray, excess: np.ndarray, redness: np.ndarray, optics: Optics) -> Ball | None:
        """The ball that a component of red is, if it is one."""
        lens = _Lens(optics, redness.shape[1], redness.shape[0])
        cone = fit_cone(lens.directions(component[lens.inside(component, BORDER)]))
        edges = None
        for _ in range(ROUNDS):
            if cone is None or not self._possible(cone):
                return None
            edges = _edges(cone, excess, lens, self._settings)
            if edges.found < self._settings.edges * edges.inside:
                return None
            cone = fit_cone(_without_outliers(edges.directions, cone))
        if cone is None or edges is None or not self._possible(cone):
            return None
        pixel = 1.0 / lens.fx
        # Little of a small outline fits a circle whatever it is.
        cut = edges.inside < WHOLE
        if edges.inside < self._settings.arc or (cut and cone.angle < self._settings.least_cut * pixel):
            return None
        allowed = self._settings.roundness[0] * pixel + self._settings.roundness[1] * cone.angle
        filled = _filled(cone, redness, lens, self._settings.redness[0])
        if cone.residual > allowed or filled < self._settings.filled:
            return None
        x, y = optics.project(cone.axis)
        quality = filled * edges.found * (1.0 - 0.5 * cone.residual / allowed)
        return Ball(cone.alpha, cone.beta, cone.angle, x, y, quality)

    def _possible(self, cone: Cone) -> bool:
        return self._settings.least_radius <= cone.angle <= self._settings.most_radius


def red_parts(image: np.ndarray, dark: float) -> tuple[np.ndarray, np.ndarray]:
    """How red pixels are.

    Args:
        image: (h, w, 3) uint8, blue, green, red.
        dark: Red from which on redness counts fully.

    Returns:
        (h, w) float32 arrays: the excess of red over the other colours, -255..255, which is mixed as light is at an
        edge; and redness, that less what the others differ by (orange has more green than blue, as the robot's own
        arms have), as a share of red, which is the same in light and shadow.
    """
    blue, green, red = cv2.split(image)
    red32 = red.astype(np.float32)
    excess = red32 - cv2.max(blue, green)
    return excess, (excess - cv2.absdiff(green, blue)) / np.maximum(red32, dark)


# --- inside ---------------------------------------------------------------------------------------------------------


class _Lens:
    """Directions to pixels of one picture, and back."""

    def __init__(self, optics: Optics, width: int, height: int) -> None:
        numbers = optics.intrinsics(width, height)
        self.width, self.height = width, height
        self.fx, self.fy, self.cx, self.cy = numbers.fx, numbers.fy, numbers.cx, numbers.cy

    def directions(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) unit vectors to (n, 2) places in pixels."""
        rays = np.empty((len(points), 3))
        rays[:, 0] = 1.0
        rays[:, 1] = (self.cx - points[:, 0]) / self.fx
        rays[:, 2] = (self.cy - points[:, 1]) / self.fy
        return rays / np.linalg.norm(rays, axis=1, keepdims=True)

    def places(self, directions: np.ndarray) -> np.ndarray:
        """(..., 2) places in pixels of (..., 3) directions; not a number for those behind the camera."""
        ahead = np.where(directions[..., 0] > 0.05, directions[..., 0], np.nan)
        x = self.cx - self.fx * directions[..., 1] / ahead
        y = self.cy - self.fy * directions[..., 2] / ahead
        return np.stack([x, y], axis=-1)

    def inside(self, places: np.ndarray, border: float = 0.0) -> np.ndarray:
        """Which places are in the picture and not within `border` pixels of its edge."""
        x, y = places[..., 0], places[..., 1]
        with np.errstate(invalid="ignore"):
            across = (x > border) & (x < self.width - border)
            return across & (y > border) & (y < self.height - border)


@dataclass(frozen=True, eq=False)
class _Edges:
    """Where the red ends around a middle: directions to it, and the shares of rays with an edge and in the picture."""

    directions: np.ndarray
    found: float
    inside: float


def _same(ball: Ball, other: Ball) -> bool:
    """Whether two findings are of one ball."""
    return math.hypot(ball.alpha - other.alpha, ball.beta - other.beta) < other.radius


def _components(redness: np.ndarray, level: float, settings: BallSettings) -> list[np.ndarray]:
    """Outlines, (n, 2) in pixels, of the largest areas that are redder than a level."""
    mask = (redness > level).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    sized = [(cv2.contourArea(contour) + len(contour) / 2.0, contour) for contour in contours]
    large = sorted((item for item in sized if item[0] >= settings.least_pixels), key=lambda item: -item[0])
    return [contour[:, 0, :] + 0.5 for _, contour in large[: settings.most_candidates]]


def _edges(cone: Cone, excess: np.ndarray, lens: _Lens, settings: BallSettings) -> _Edges:
    """Edges between red and not red along rays from the middle, where excess falls to half of what it is inside."""
    shares = np.linspace(INSIDE[0], REACH, STEPS)
    turns = np.arange(settings.rays) * (2.0 * math.pi / settings.rays)
    left = np.cross((0.0, 0.0, 1.0), cone.axis)
    left /= np.linalg.norm(left)
    up = np.cross(cone.axis, left)
    out = np.cos(turns)[:, None] * left + np.sin(turns)[:, None] * up
    angles = cone.angle * shares
    rays = np.cos(angles)[None, :, None] * cone.axis + np.sin(angles)[None, :, None] * out[:, None, :]
    places = lens.places(rays)
    # A ray counts as far as it stays in the picture.
    usable = np.logical_and.accumulate(lens.inside(places, BORDER), axis=1)
    where = np.nan_to_num(places, nan=-1e4).astype(np.float32) - 0.5
    values = cv2.remap(excess, where[..., 0], where[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    sure = shares <= INSIDE[1]
    level = np.median(values[:, sure], axis=1)
    # What is behind need not be grey: the edge is half way between what is inside and what is just outside.
    behind = np.minimum(np.median(values[:, -STEPS // 4 :], axis=1), 0.6 * level)
    half = 0.5 * (level + behind)
    below = (values < half[:, None]) & ~sure[None, :]
    first = np.argmax(below, axis=1)
    index = np.arange(settings.rays)
    has = below.any(axis=1) & (level > 0.0)
    has &= usable[index, first]
    complete = usable[:, -STEPS // 4]
    before, after = values[index, first - 1], values[index, first]
    part = np.clip((before - half) / np.maximum(before - after, 1e-6), 0.0, 1.0)
    share = shares[first - 1] + part * (shares[1] - shares[0])
    angle = cone.angle * share[has]
    directions = np.cos(angle)[:, None] * cone.axis + np.sin(angle)[:, None] * out[has]
    inside = float(np.mean(complete | has))
    return _Edges(directions, float(np.mean(has)), inside)


def _without_outliers(directions: np.ndarray, cone: Cone) -> np.ndarray:
    """Without the few that are far off what the others say: a highlight at the rim, a thing in front."""
    if not len(directions):
        return directions
    better = fit_cone(directions) or cone
    off = np.abs(np.arccos(np.clip(directions @ better.axis, -1.0, 1.0)) - better.angle)
    limit = max(3.0 * float(np.median(off)), 0.06 * better.angle)
    kept = off <= limit
    return directions[kept] if kept.mean() >= 0.85 else directions


def _filled(cone: Cone, redness: np.ndarray, lens: _Lens, level: float) -> float:
    """Share of the disc, as far as it is in the picture and but for its rim, that is red."""
    center = lens.places(cone.axis)
    reach = 1.3 * cone.angle * max(lens.fx, lens.fy) / max(float(cone.axis[0]), 0.2) ** 2
    low = np.maximum(np.floor(center - reach), 0).astype(int)
    high = np.minimum(np.ceil(center + reach), (lens.width, lens.height)).astype(int)
    if np.any(high <= low):
        return 0.0
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    directions = lens.directions(np.column_stack([x.ravel(), y.ravel()]))
    disc = directions @ cone.axis > math.cos(0.85 * cone.angle)
    if not disc.any():
        return 0.0
    return float(np.mean(redness[low[1] : high[1], low[0] : high[0]].ravel()[disc] > level))
