"""Eyes, nose and mouth of a face, and what it looks like, as numbers that are alike for pictures of the same person."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

import numpy as np

from nao_sim_bridge.base.imports import Library

cv2 = Library("cv2")

Point = Tuple[float, float]
Box = Tuple[float, float, float, float]

# Eyes are looked for in a face of this size, px; the cascade's frame of a face is its whole.
SIZE = 64
# Where the middle between the eyes is expected in the frame, how far the eyes are from it, and by how much each may
# differ; shares of the frame. The slope is that of the line through the eyes.
MIDDLE_X, MIDDLE_Y, HALF_DISTANCE = 0.5, 0.385, 0.195
STEPS_X = np.arange(-0.05, 0.051, 0.0125)
STEPS_Y = np.arange(-0.08, 0.081, 0.0125)
STEPS_DISTANCE = np.arange(-0.045, 0.046, 0.0125)
SLOPES = np.tan(np.radians(np.arange(-16, 17, 4)))
# How far above an eye its brow is, px, and what it counts.
BROW, BROW_SHARE = 6, 0.5
# How much less likely a place is at the end of its range.
DOUBT, SLOPE_DOUBT = 0.35, 1.6
# An upright face in which the eyes are at fixed places: its size, and the middle between the eyes, px.
UPRIGHT, UPRIGHT_EYES, UPRIGHT_DISTANCE = (96, 112), (48.0, 40.0), 40.0
# A face is described in this size, px: about that of one two metres away in a VGA picture.
SMALL = (48, 56)
CELL = 8
DIRECTIONS, TONES = 8, 3
DESCRIPTION_LENGTH = (DIRECTIONS + TONES) * math.prod(len(range(CELL // 2, size, CELL // 2)) for size in SMALL)
"""Numbers of a description of a face: of each cell the edges of each direction, its brightness and two colours."""
# How far from its middle the face counts, in halves of its width and height: at its rim it changes when the head turns.
RIM = (0.8, 1.0)
# A cell whose edges are all fainter than this, of 255 a pixel, says nothing.
FAINT = 6.0
SHARE_OF_EDGES = 0.5
"""What the edges count; the tones count for the rest."""


@dataclass(frozen=True)
class FacePoints:
    """Points of a face in the picture, px; left and right are the person's own.

    Of an eye: centre, limit at the nose, limit at the ear. Of the nose: middle of its lower end, left and right limit.
    Of the mouth: left, right and upper limit.
    """

    left_eye: Tuple[Point, Point, Point]
    right_eye: Tuple[Point, Point, Point]
    nose: Tuple[Point, Point, Point]
    mouth: Tuple[Point, Point, Point]


def find_eyes(grey: np.ndarray, box: Box) -> tuple[Point, Point]:
    """Centres, px, of the eyes on the left and right of a (h, w) uint8 picture, in the cascade's frame of a face."""
    x, y, width, _ = box
    scale = SIZE / width
    enlarged = np.float32(((scale, 0, -x * scale), (0, scale, -y * scale)))
    face = cv2.warpAffine(grey, enlarged, (SIZE, SIZE), borderMode=cv2.BORDER_REPLICATE)
    dark = _darkness(face.astype(np.float32))
    middles_x, middles_y, halves, slopes, belief = _candidates()
    rise = halves * slopes
    left_x, right_x = middles_x - halves, middles_x + halves
    score = _at(dark, left_x, middles_y - rise) + _at(dark, right_x, middles_y + rise)
    best = int(np.argmax(score * belief))
    left = (left_x[best], middles_y[best] - rise[best])
    right = (right_x[best], middles_y[best] + rise[best])
    return tuple((x + px / scale, y + py / scale) for px, py in (left, right))  # type: ignore[return-value]


def upright(picture: np.ndarray, eyes: tuple[Point, Point]) -> tuple[np.ndarray, np.ndarray]:
    """The face turned upright, eyes at fixed places, and the (2, 3) matrix from the picture to it."""
    (lx, ly), (rx, ry) = eyes
    dx, dy = rx - lx, ry - ly
    distance = max(float(np.hypot(dx, dy)), 1.0)
    scale = UPRIGHT_DISTANCE / distance
    cos, sin = scale * dx / distance, scale * dy / distance
    middle_x, middle_y = (lx + rx) / 2.0, (ly + ry) / 2.0
    matrix = np.array(
        (
            (cos, sin, UPRIGHT_EYES[0] - cos * middle_x - sin * middle_y),
            (-sin, cos, UPRIGHT_EYES[1] + sin * middle_x - cos * middle_y),
        )
    )
    return cv2.warpAffine(picture, matrix, UPRIGHT, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), matrix


def find_points(grey: np.ndarray, eyes: tuple[Point, Point]) -> FacePoints:
    """The other points of a face whose eyes are known; see `find_eyes`."""
    face, matrix = upright(grey, eyes)
    face = cv2.GaussianBlur(face, (0, 0), 1.5).astype(np.float32)
    back = cv2.invertAffineTransform(matrix)
    nose_row, nose_left, nose_right = _dark_row(face, (0.45, 0.85), 0.32)
    mouth_row, mouth_left, mouth_right = _dark_row(face, (max(0.85, _depth(nose_row) + 0.2), 1.45), 0.6)
    mouth_top = _upper_limit(face, mouth_row)
    middle, half = UPRIGHT_EYES[0], UPRIGHT_DISTANCE / 2.0
    sides = []
    for sign in (1.0, -1.0):  # the person's left eye is on the right of the picture
        centre = middle + sign * half
        inner, outer = _eye_limits(face, centre, sign)
        sides.append(tuple(_back(back, px, UPRIGHT_EYES[1]) for px in (centre, inner, outer)))
    return FacePoints(
        left_eye=sides[0],
        right_eye=sides[1],
        nose=tuple(_back(back, px, nose_row) for px in ((nose_left + nose_right) / 2.0, nose_right, nose_left)),
        mouth=tuple(
            _back(back, *at) for at in ((mouth_right, mouth_row), (mouth_left, mouth_row), (middle, mouth_top))
        ),
    )


@lru_cache(maxsize=1)
def _candidates() -> tuple[np.ndarray, ...]:
    """Places of a pair of eyes in the face of size `SIZE`, px, and how likely each is, at most 1."""
    rows, belief = [], []
    for dx, dy, dd, slope in itertools.product(STEPS_X, STEPS_Y, STEPS_DISTANCE, SLOPES):
        rows.append((MIDDLE_X + dx, MIDDLE_Y + dy, HALF_DISTANCE + dd, slope))
        doubts = (dx / STEPS_X[-1], dy / STEPS_Y[-1], dd / STEPS_DISTANCE[-1], SLOPE_DOUBT * slope / SLOPES[-1])
        belief.append(1.0 - DOUBT * sum(d * d for d in doubts) / len(doubts))
    table = np.array(rows).T
    return table[0] * SIZE, table[1] * SIZE, table[2] * SIZE, table[3], np.array(belief)


def _darkness(face: np.ndarray) -> np.ndarray:
    """How much darker than its surroundings a spot of the size of an eye is, and a brow above it: an eye has one."""
    dark = np.maximum(cv2.GaussianBlur(face, (0, 0), 7.0) - cv2.GaussianBlur(face, (0, 0), 2.0), 0.0)
    brow = np.zeros_like(dark)
    brow[BROW:] = cv2.dilate(dark, np.ones((3, 1), np.uint8))[:-BROW]
    return dark + BROW_SHARE * brow


def _at(values: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    columns = np.clip(np.rint(x).astype(int), 0, SIZE - 1)
    rows = np.clip(np.rint(y).astype(int), 0, SIZE - 1)
    return values[rows, columns]


def _depth(row: float) -> float:
    """How far below the eyes a row of the upright face is, in distances of the eyes."""
    return (row - UPRIGHT_EYES[1]) / UPRIGHT_DISTANCE


def _dark_row(face: np.ndarray, depths: Tuple[float, float], reach: float) -> tuple[float, float, float]:
    """The row of a dark feature on the middle line of the face, and its limits to the left and right of the picture.

    It is looked for between two depths below the eyes and reaches no further to both sides, in distances of the eyes.
    """
    first, last = (round(UPRIGHT_EYES[1] + depth * UPRIGHT_DISTANCE) for depth in depths)
    last = min(last, UPRIGHT[1] - 3)
    middle, side = round(UPRIGHT_EYES[0]), round(reach * UPRIGHT_DISTANCE)
    strip = face[first:last, middle - side : middle + side + 1]
    around = cv2.blur(face, (1, 15))[first:last, middle - side : middle + side + 1]
    dark = np.maximum(around - strip, 0.0)
    weights = np.exp(-((np.arange(-side, side + 1) / (0.6 * side)) ** 2))
    best = int(np.argmax(dark @ weights))
    profile = dark[max(best - 1, 0) : best + 2].max(axis=0)
    inside = np.flatnonzero(profile > 0.35 * profile.max()) if profile.max() > 0.0 else np.array([0, 2 * side])
    return float(first + best), float(middle - side + inside[0]), float(middle - side + inside[-1])


def _upper_limit(face: np.ndarray, mouth_row: float) -> float:
    """Row of the upper edge of the lips: where the middle line brightens most above the mouth."""
    row, middle = round(mouth_row), round(UPRIGHT_EYES[0])
    reach = round(0.22 * UPRIGHT_DISTANCE)
    column = face[row - reach : row + 1, middle - 4 : middle + 5].mean(axis=1)
    steps = column[:-1] - column[1:]
    return float(row - reach + int(np.argmax(steps[: reach - 1])))


def _eye_limits(face: np.ndarray, centre: float, sign: float) -> tuple[float, float]:
    """Where the dark of an eye ends towards the nose and towards the ear; `sign` points to the ear."""
    row = round(UPRIGHT_EYES[1])
    reach = round(0.42 * UPRIGHT_DISTANCE)
    steps = np.arange(-reach, reach + 1)
    columns = np.clip(np.rint(centre + sign * steps).astype(int), 0, UPRIGHT[0] - 1)
    profile = face[row - 2 : row + 3, columns].min(axis=0)
    light = np.percentile(profile, 90)
    dark = profile < light - 0.35 * (light - profile[reach])
    inner = reach
    while inner > 0 and dark[inner - 1]:
        inner -= 1
    outer = reach
    while outer < 2 * reach and dark[outer + 1]:
        outer += 1
    return centre + sign * steps[inner], centre + sign * steps[outer]


def _back(matrix: np.ndarray, x: float, y: float) -> Point:
    px, py = matrix @ (x, y, 1.0)
    return float(px), float(py)


def describe(picture: np.ndarray, eyes: Tuple[Point, Point]) -> np.ndarray:
    """(n,) float32 description, of length 1, of a face in a BGR picture with these centres of eyes, px.

    Two parts, each of length 1: how strong edges of each direction are in each part of the face (they say how brows,
    eyes, glasses, mouth, beard and hair line are), and how bright and of what colour each part is compared with the
    whole face. Both are taken from a face of one small size, so that distance changes little, and neither knows how
    bright the light is; the second takes the colour of the light out, too.
    """
    face, _ = upright(picture, eyes)
    face = cv2.resize(face, SMALL, interpolation=cv2.INTER_AREA)
    return np.concatenate((np.sqrt(SHARE_OF_EDGES) * _edges(face), np.sqrt(1.0 - SHARE_OF_EDGES) * _tones(face)))


def likeness(one: np.ndarray, others: np.ndarray) -> np.ndarray:
    """How alike a description (n,) is to each of others (m, n), at most 1."""
    return others @ one


def _edges(face: np.ndarray) -> np.ndarray:
    grey = cv2.GaussianBlur(cv2.cvtColor(face, cv2.COLOR_BGR2GRAY), (3, 3), 0).astype(np.float32)
    dx, dy = cv2.Sobel(grey, cv2.CV_32F, 1, 0) / 4.0, cv2.Sobel(grey, cv2.CV_32F, 0, 1) / 4.0
    strength, angle = np.hypot(dx, dy), np.mod(np.arctan2(dy, dx), np.pi)
    # Each edge counts for the two directions next to its own.
    place = angle / np.pi * DIRECTIONS
    low = np.floor(place).astype(int)
    share = place - low
    maps = np.zeros((DIRECTIONS, *grey.shape), np.float32)
    rows, columns = np.indices(grey.shape)
    maps[low % DIRECTIONS, rows, columns] += strength * (1.0 - share)
    maps[(low + 1) % DIRECTIONS, rows, columns] += strength * share
    cells = np.stack([_cells(one) for one in maps], axis=-1)
    # As strong as the strong ones of the neighbourhood: light from one side does not count.
    around = cv2.blur(cells.sum(axis=-1), (3, 3), borderType=cv2.BORDER_REPLICATE)
    cells = np.sqrt(np.maximum(cells, 0.0) / (around + FAINT)[..., None])
    return _unit((cells - cells.mean(axis=(0, 1))) * _weights(cells.shape)[..., None])


def _tones(face: np.ndarray) -> np.ndarray:
    logs = np.log(face.astype(np.float32) + 8.0)
    brightness = logs.mean(axis=2)
    colour = np.stack((logs[..., 2] - logs[..., 1], logs[..., 0] - logs[..., 1]), axis=-1)
    cells = np.stack([_cells(brightness), *(_cells(colour[..., i]) for i in range(2))], axis=-1)
    weights = _weights(cells.shape)[..., None]
    return _unit((cells - (cells * weights).sum(axis=(0, 1)) / weights.sum()) * weights)


def _cells(values: np.ndarray) -> np.ndarray:
    """Means over overlapping cells."""
    means = cv2.blur(values, (CELL, CELL), borderType=cv2.BORDER_REPLICATE)
    return means[CELL // 2 :: CELL // 2, CELL // 2 :: CELL // 2]


def _weights(shape: Tuple[int, ...]) -> np.ndarray:
    """(rows, columns) of how much each cell counts."""
    rows, columns = (np.linspace(-1.0, 1.0, count) for count in shape[:2])
    return np.exp(-((columns[None, :] / RIM[0]) ** 2) - (rows[:, None] / RIM[1]) ** 2)


def _unit(values: np.ndarray) -> np.ndarray:
    flat = values.ravel().astype(np.float32)
    return flat / max(float(np.linalg.norm(flat)), 1e-6)
