"""Pictures with cards of faces in front of a wall, as a camera would see them."""

from __future__ import annotations

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.world.pictures import WorldPicture, paint

OPTICS = Optics(0.9826, 0.7627)
FOCAL = 320.0 / np.tan(OPTICS.hfov / 2.0)
CARD = 0.22
"""Width of a card, m."""


def wall(seed=0, width=640, height=480):
    random = np.random.default_rng(seed)
    coarse = random.normal(150.0, 12.0, (6, 8, 3)).astype(np.float32)
    picture = cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC)
    return picture + random.normal(0.0, 3.0, picture.shape)


def face_picture(name, distance, yaw=0.0, place=(320, 240), light=1.0, seed=0, picture=None):
    """A VGA picture with the card of somebody `distance` m away, turned by `yaw`, its middle at a pixel."""
    picture = wall(seed) if picture is None else picture.astype(np.float32)
    card = paint(WorldPicture("face", name))[:, :, ::-1]
    rows, columns = card.shape[:2]
    wide = int(min(columns, 1.5 * FOCAL * CARD / distance))
    card = cv2.resize(card, (wide, wide * rows // columns), interpolation=cv2.INTER_AREA)
    corners = []
    for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)):
        depth = distance + x * CARD * np.sin(yaw)
        across, down = x * CARD * np.cos(yaw), y * CARD * rows / columns
        corners.append((place[0] + FOCAL * across / depth, place[1] + FOCAL * down / depth))
    rows, columns = card.shape[:2]
    source = np.float32([(0, 0), (columns, 0), (columns, rows), (0, rows)])
    matrix = cv2.getPerspectiveTransform(source, np.float32(corners))
    size = (picture.shape[1], picture.shape[0])
    there = cv2.warpPerspective(np.ones(card.shape[:2], np.float32), matrix, size)[..., None]
    picture = picture * (1.0 - there) + cv2.warpPerspective(card.astype(np.float32), matrix, size) * there
    return np.clip(light * picture, 0.0, 255.0).astype(np.uint8)
