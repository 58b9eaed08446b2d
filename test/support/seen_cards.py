"""Pictures for detectors, drawn without a renderer: exact spheres, and cards in perspective."""

from __future__ import annotations

import math

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.world.painting.known_landmarks import load_landmarks
from nao_sim_bridge.world.pictures import WorldPicture, paint

OPTICS = CameraOptics("V6", 0)
GREY = (150, 160, 170)
FINE = 4
"""Rays or samples a pixel, across and down."""


def towards(distance, alpha, beta):
    """(3,) point in the frame of the camera, m."""
    ray = np.array((1.0, math.tan(alpha), -math.tan(beta)))
    return distance * ray / np.linalg.norm(ray)


def developed(fine, size, noise, seed):
    """A picture of `size` from one that is `FINE` times as large, with noise."""
    picture = cv2.resize(fine.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    picture += np.random.default_rng(seed).normal(0.0, noise, picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def sphere(distance, radius, alpha=0.0, beta=0.0, color=(20, 25, 215), back=GREY, size=(320, 240), noise=2.0, seed=0):
    """A ball that is lit from above, colours in the order blue, green, red."""
    lens = OPTICS.intrinsics(FINE * size[0], FINE * size[1])
    center = towards(distance, alpha, beta)
    picture = np.empty((FINE * size[1], FINE * size[0], 3))
    picture[:] = back
    # Only around its middle: rays take their time.
    reach = 1.5 * lens.fx * math.tan(math.asin(radius / distance))
    across, down = lens.cx - lens.fx * center[1] / center[0], lens.cy - lens.fy * center[2] / center[0]
    left, right = (int(np.clip(across + side, 0, FINE * size[0])) for side in (-reach, reach))
    top, bottom = (int(np.clip(down + side, 0, FINE * size[1])) for side in (-reach, reach))
    x, y = np.meshgrid(np.arange(left, right) + 0.5, np.arange(top, bottom) + 0.5)
    rays = np.stack([np.ones_like(x), (lens.cx - x) / lens.fx, (lens.cy - y) / lens.fy], axis=-1)
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    along = rays @ center
    root = along**2 - distance**2 + radius**2
    hit = root > 0.0
    normal = (rays * (along - np.sqrt(np.maximum(root, 0.0)))[..., None] - center) / radius
    light = 0.45 + 0.55 * np.maximum(normal @ np.array((-0.3, 0.2, 0.93)), 0.0)
    picture[top:bottom, left:right][hit] = (np.array(color) * light[..., None])[hit]
    return developed(picture, size, noise, seed)


def card(
    picture, width, distance, alpha=0.0, beta=0.0, yaw=0.0, pitch=0.0, roll=0.0, size=(320, 240), seed=0, onto=None
):
    """A card that hangs in front of the camera, turned about the vertical, slanted and rolled (counterclockwise).

    Args:
        picture: WorldPicture on it.
        width: m.
        onto: What is behind it; a grey picture when there is nothing.
    """
    painted = paint(picture)
    rows, columns = painted.shape[:2]
    lens = OPTICS.intrinsics(FINE * size[0], FINE * size[1])
    middle = towards(distance, alpha, beta)
    turn = _about_z(math.atan2(middle[1], middle[0]) + yaw) @ _about_y(pitch) @ _about_x(-roll)
    right, up = turn @ (0.0, -1.0, 0.0), turn @ (0.0, 0.0, 1.0)
    half = np.array((width, width * rows / columns)) / 2.0
    corners = [middle + i * half[0] * right + j * half[1] * up for i, j in ((-1, 1), (1, 1), (1, -1), (-1, -1))]
    places = np.float32([[lens.cx - lens.fx * c[1] / c[0], lens.cy - lens.fy * c[2] / c[0]] for c in corners])
    edges = np.float32([[0, 0], [columns, 0], [columns, rows], [0, rows]])
    matrix = cv2.getPerspectiveTransform(edges, places)
    shrunk = columns / np.linalg.norm(places[1] - places[0])
    soft = painted if shrunk < 1.5 else cv2.GaussianBlur(painted, (0, 0), 0.4 * shrunk)
    fine = (FINE * size[0], FINE * size[1])
    seen = cv2.warpPerspective(soft, matrix, fine).astype(np.float32) * 0.8 + 25.0
    there = cv2.warpPerspective(np.ones((rows, columns), np.float32), matrix, fine)[..., None]
    behind = np.full((*fine[::-1], 3), 120.0) if onto is None else cv2.resize(onto, fine).astype(np.float32)
    return developed(seen * there + behind * (1.0 - there), size, 2.0, seed)


def mark(number, distance, **how):
    """A landmark of the usual size."""
    table = load_landmarks()
    return card(WorldPicture("landmark", str(number)), table.diameter * (1.0 + table.margin), distance, **how)


def _about_x(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)))


def _about_y(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)))


def _about_z(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
