"""What a face looks like, as numbers that are close together for pictures of the same person.

Two parts, each of length 1: how strong edges of each direction are in each part of the face (they say how brows, eyes,
glasses, mouth, beard and hair line are), and how bright and of what colour each part is compared with the whole face.
Both are taken from a face of one small size, so that distance changes little, and neither knows how bright the light
is; the second takes the colour of the light out, too.
"""

from __future__ import annotations

from typing import Tuple

import cv2
import numpy as np

from nao_sim_bridge.vision.faces_points import Point, upright

# The face is looked at in this size, px: about that of one two metres away in a VGA picture.
SMALL = (48, 56)
CELL = 8
DIRECTIONS = 8
# How far from its middle the face counts, in halves of its width and height: at its rim it changes when the head turns.
RIM = (0.8, 1.0)
# A cell whose edges are all fainter than this, of 255 a pixel, says nothing.
FAINT = 6.0
SHARE_OF_EDGES = 0.5
"""What the edges count; the tones count for the rest."""


def describe(picture: np.ndarray, eyes: Tuple[Point, Point]) -> np.ndarray:
    """(n,) float32 description, of length 1, of a face in a BGR picture with these centres of eyes, px."""
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
