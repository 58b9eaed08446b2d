"""The numbers that all programs of OpenGL share: camera, lamp, floor and sky."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.render.scene.view import NEAR, View
from nao_sim_bridge.world.world import World

BLOCK = np.dtype(
    [(name, "f4", (4, 4)) for name in ("clip", "still_matrix", "moving_matrix")]
    + [(name, "f4", 4) for name in ("eye", "right", "upwards", "forward", "above")]
)
"""As `shaders.SCENE` declares it."""
FROM_BELOW = 0.80
"""Share of the light from above that comes from below, too."""
WALLS = 0.11
"""What surfaces that stand upright get besides."""
FILL = 0.12
"""Of the second lamp, for surfaces that face it."""
BRIGHTER = 1.06
"""Things, than the floor of the same colour: else a room looks dim."""
SUNK = 0.0005
"""What is deeper in the floor is not drawn, m."""


def world_constants(world: World) -> dict[str, float | np.ndarray]:
    """What a world gives to the programs, by the names it has there."""
    normal = np.array(world.floor.normal)
    lamp = np.array(world.light.direction) / np.linalg.norm(world.light.direction)
    color = np.array(world.light.color)
    ambient = color * world.light.ambient
    # From the other side, half as steep.
    fill = -lamp + normal * (1.5 * (lamp @ normal))
    fill = FILL * fill / np.linalg.norm(fill)
    tint = 0.75 + 0.25 * np.array(world.floor.color) / max(*world.floor.color, 0.01)
    # The floor in full light has its colour of the file.
    rest = np.maximum(1.0 - ambient - max(float(fill @ normal), 0.0), 0.0)
    return {
        "UP": normal,
        "LAMP": lamp,
        "LAMP_COLOR": rest / max(float(lamp @ normal), 0.2),
        "AMBIENT": ambient,
        "BOUNCE": FROM_BELOW * ambient * tint,
        "WALLS": WALLS * color,
        "FILL": fill,
        "SHADE": 1.0 - rest,
        "BRIGHTER": BRIGHTER,
        "TILE": world.floor.tile_size,
        "EVEN_TILE": np.array(world.floor.color),
        "ODD_TILE": np.array(world.floor.tile_color),
        "HORIZON": np.array(world.background.horizon),
        "TOP": np.array(world.background.top),
        "HAZE": world.background.haze,
    }


def camera_block(view: View, normal: np.ndarray, still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """What the camera gives to the programs, () of `BLOCK`.

    Args:
        normal: (3,) unit vector out of the floor.
        still: (4, 4) from world to the shadow map of what stands still.
        moving: (4, 4) the same of what moves.
    """
    right, up, forward = view.axes
    wide, high = view.tangents
    height = float(view.eye @ normal)
    block = np.zeros((), BLOCK)
    # OpenGL takes matrices column by column.
    block["clip"] = (projection(view) @ view.to_camera()).T
    block["still_matrix"], block["moving_matrix"] = still.T, moving.T
    block["eye"] = (*view.eye, height)
    block["right"] = (*(right * wide), 2.0 * high / view.height)
    block["upwards"][:3] = up * high
    block["forward"][:3] = forward
    block["above"] = (*(normal if height > 0.0 else np.zeros(3)), SUNK)
    return block


def projection(view: View) -> np.ndarray:
    """(4, 4) from the camera's frame to a picture whose first row is the upper one; nothing is too far to be seen."""
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = 1.0 / view.tangents[0], -1.0 / view.tangents[1]
    matrix[2, 2], matrix[2, 3] = -1.0, -2.0 * NEAR
    matrix[3, 2] = -1.0
    return matrix
