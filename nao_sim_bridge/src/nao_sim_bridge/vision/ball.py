"""Finds red balls by their colour and by their outline.

Directions to the outline of a sphere lie on a cone, wherever in the picture it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.vision.ellipse import sample
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
CONE_ROUNDS = 4
LEAST_POINTS = 5


@dataclass(frozen=True, eq=False)
class Cone:
    """Directions to the outline of a sphere: all have the same angle to an axis, rad, its angular radius.

    The axis is a (3,) unit vector in the frame of the camera: X ahead, Y left, Z up. The residual is the root mean
    square of how far the directions that were used are off, rad.
    """

    axis: np.ndarray
    angle: float
    residual: float

    @property
    def alpha(self) -> float:
        """Direction of the axis seen from above, rad, positive to the left."""
        return math.atan2(self.axis[1], self.axis[0])

    @property
    def beta(self) -> float:
        """Direction of the axis seen from the side, rad, positive downwards."""
        return math.atan2(-self.axis[2], self.axis[0])


def fit_cone(directions: np.ndarray) -> Cone | None:
    """The cone closest to (n, 3) unit vectors, which need not go all the way round; None when they make none."""
    if len(directions) < LEAST_POINTS:
        return None
    middle = directions.mean(axis=0)
    middle /= np.linalg.norm(middle)
    # In the plane across the mean direction, a small cone is nearly a circle: a start for the exact angles.
    left, up = _across(middle)
    ahead = directions @ middle
    if np.any(ahead <= 0.1):
        return None
    across = np.stack([directions @ left, directions @ up], axis=1) / ahead[:, None]
    circle = _circle(across)
    if circle is None:
        return None
    center = circle[:2]
    for _ in range(CONE_ROUNDS):
        axis = middle + center[0] * left + center[1] * up
        axis /= np.linalg.norm(axis)
        angles = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
        if np.any(angles < 1e-9):
            return None
        # Derivatives of the angles when the axis turns towards left and up.
        gradient = np.stack([directions @ left, directions @ up], axis=1) / -np.sin(angles)[:, None]
        system = np.column_stack([gradient, -np.ones(len(angles))])
        step, *_ = np.linalg.lstsq(system, -angles, rcond=None)
        center = center + step[:2]
        if not np.all(np.isfinite(center)):
            return None
    axis = middle + center[0] * left + center[1] * up
    axis /= np.linalg.norm(axis)
    angles = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
    angle = float(angles.mean())
    return Cone(axis, angle, float(np.sqrt(np.mean((angles - angle) ** 2))))


def _across(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors to the left and upwards, across an axis."""
    left = np.cross((0.0, 0.0, 1.0), axis)
    left /= np.linalg.norm(left)
    return left, np.cross(axis, left)


def _circle(points: np.ndarray) -> np.ndarray | None:
    """(x, y, radius) of the circle through (n, 2) points, by least squares."""
    system = np.column_stack([2.0 * points, np.ones(len(points))])
    solution, _, rank, _ = np.linalg.lstsq(system, np.sum(points**2, axis=1), rcond=None)
    square = solution[2] + solution[0] ** 2 + solution[1] ** 2
    if rank < 3 or square <= 0.0:
        return None
    return np.array([solution[0], solution[1], math.sqrt(square)])


@dataclass(frozen=True)
class Ball:
    """A red ball in a picture; its quality says how much it looks like one, up to 1.

    The direction of its centre is alpha, seen from above, to the left, and beta, seen from the side, downwards; these
    and its angular radius are in rad. Its centre is at x, 0 at the left edge of the picture to 1 at the right one, and
    y, likewise from the upper edge down.
    """

    alpha: float
    beta: float
    radius: float
    x: float
    y: float
    quality: float

    def distance(self, radius: float) -> float:
        """Distance from the camera to its centre, m, when it has this radius, m."""
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
    """How red the pixels of a (h, w, 3) uint8 picture, blue, green, red, are: two (h, w) float32 arrays.

    First the excess of red over the other colours, -255..255, which is mixed as light is at an edge. Then redness: that
    less what the others differ by (orange has more green than blue, as the robot's own arms have), as a share of red,
    the same in light and shadow; below `dark` of red it counts less.
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
        with np.errstate(invalid="ignore"):
            return np.all((places > border) & (places < np.array((self.width, self.height)) - border), axis=-1)


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
    left, up = _across(cone.axis)
    out = np.cos(turns)[:, None] * left + np.sin(turns)[:, None] * up
    angles = cone.angle * shares
    rays = np.cos(angles)[None, :, None] * cone.axis + np.sin(angles)[None, :, None] * out[:, None, :]
    places = lens.places(rays)
    # A ray counts as far as it stays in the picture.
    usable = np.logical_and.accumulate(lens.inside(places, BORDER), axis=1)
    values = sample(excess, np.nan_to_num(places, nan=-1e4))
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
