"""What tests of pictures share: states to draw, shots of a camera, and what is to be seen in a picture."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from nao_sim_bridge.cameras.sensor import Shot
from nao_sim_bridge.model.kinematics import matrix_quaternion, rpy_matrix
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.world.reader import read_world
from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import World

MODEL = load_model()
UNTURNED = (0.0, 0.0, 0.0, 1.0)
GREEN, RED, BLUE = (0.0, 0.9, 0.0), (0.9, 0.0, 0.0), (0.0, 0.0, 0.9)
STATE = RenderState((0.0, 0.0, 0.333), UNTURNED, posture(MODEL, "Stand"), (0.0,) * 89)
AWAY = replace(STATE, base_position=(-5.0, 0.0, 0.333))


def world(*objects) -> World:
    content = {"floor": {"friction": 1.0, "color": [0.7, 0.7, 0.7], "tile_color": [0.7, 0.7, 0.7]}}
    return read_world({**content, "objects": list(objects)}, "test", "test.yaml")


def placed(*entries, **changes):
    """The state without the robot, with things of an otherwise empty world."""
    return replace(AWAY, placed=world(*entries).objects, **changes)


def shot(position=(0.0, 0.0, 0.5), rpy=(0.0, 0.0, 0.0), width=320, height=240, fov=(56.3, 43.7)):
    """As the camera in the head takes it: X is ahead."""
    hfov, vfov = (math.radians(angle) for angle in fov)
    return Shot("V6", 0, position, matrix_quaternion(rpy_matrix(rpy)), hfov, vfov, width, height, 11)


def clear(picture, channel):
    """(h, w) how much of one primary colour each pixel has beyond the others, 0..1; noise and greys have none."""
    values = picture.astype(float)
    others = np.max(np.delete(values, channel, axis=2), axis=2)
    share = (values[..., channel] - others) / np.maximum(values[..., channel], 1.0)
    return np.where(share > 0.15, share, 0.0)


def middle(weights):
    """Column and row of the middle, in pixels from the upper left corner."""
    rows, columns = np.indices(weights.shape)
    return float(((columns + 0.5) * weights).sum() / weights.sum()), float(
        ((rows + 0.5) * weights).sum() / weights.sum()
    )
