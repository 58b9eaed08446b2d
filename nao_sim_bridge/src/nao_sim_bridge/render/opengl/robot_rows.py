"""Where the links and lamps of a robot are, and how its lamps shine, as rows of what is drawn."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from nao_sim_bridge.model.appearance import Appearance
from nao_sim_bridge.model.kinematics import finger_transforms, link_transforms, quaternion_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.render.opengl.looks import Look
from nao_sim_bridge.world.render_state import RobotLook

CORE_WHITE = 0.12
"""Share of white in the light of a lamp: a saturated colour alone looks like paint, not like light."""


class RobotRows:
    """The rows of one robot; what has not changed is not worked out again.

    Args:
        looks: Of its items.
        items: Their numbers.
    """

    def __init__(self, model: RobotModel, appearance: Appearance, looks: Sequence[Look], items: slice) -> None:
        self._model = model
        self._appearance = appearance
        self._items = items
        self._frames = list(dict.fromkeys(look.frame for look in looks))
        self._frame_of_item = np.array([self._frames.index(look.frame) for look in looks])
        self._lamps = np.array([look.lamp for look in looks])
        self._hands = [(joint.parent_link, joint.name[0], i) for i, joint in enumerate(model.joints) if joint.is_hand]
        self._posed: tuple | None = None
        self._lit: tuple[float, ...] | None = None

    def show(self, look: RobotLook, matrices: np.ndarray, glow: np.ndarray) -> None:
        """Write where its items are, and their light."""
        pose = (look.base_position, look.base_orientation, look.joint_positions)
        if pose != self._posed:
            matrices[self._items] = self._poses(look)[self._frame_of_item]
            self._posed = pose
        if look.led_values != self._lit:
            glow[self._items] = self._light(look.led_values)
            self._lit = look.led_values

    def _poses(self, look: RobotLook) -> np.ndarray:
        """(f, 3, 4) of all frames."""
        base = transform(quaternion_matrix(look.base_orientation), look.base_position)
        links = link_transforms(self._model, look.joint_positions)
        poses = {name: base @ pose for name, pose in links.items()}
        for wrist, side, index in self._hands:
            for phalanx, pose in finger_transforms(self._model, look.joint_positions[index]).items():
                poses[side + phalanx] = poses[wrist] @ pose
        return np.array([poses[frame][:3] for frame in self._frames])

    def _light(self, values: Sequence[float]) -> np.ndarray:
        """(items, 4) glow of all items."""
        light = np.zeros((len(self._lamps), 4))
        colors = np.array([figure.lamp.rgb(values) for figure in self._appearance.lamps])
        level = colors.max(axis=1)
        full = colors / np.where(level > 0.0, level, 1.0)[:, None] * (1.0 - CORE_WHITE) + CORE_WHITE
        of_lamp = self._lamps >= 0
        light[of_lamp, :3] = full[self._lamps[of_lamp]]
        light[of_lamp, 3] = level[self._lamps[of_lamp]]
        return light
