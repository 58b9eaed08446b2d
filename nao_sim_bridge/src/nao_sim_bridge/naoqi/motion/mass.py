"""Part of ALMotion: mass, centre of mass, support polygon."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.model.body_mass import center_of_links, convex_hull, links_of, mass_of
from nao_sim_bridge.model.frames import EVEN, TORSO, space_in_torso
from nao_sim_bridge.naoqi.motion.part import MotionPart
from nao_sim_bridge.naoqi.motion.placements import placement, space_of

# A sole this much higher than the other one, m, carries nothing.
LIFTED = 0.005


class Mass(MotionPart):
    """What follows from the masses of the links and the soles on the ground."""

    def getMass(self, name: str) -> float:
        return mass_of(links_of(self._model, name))

    def getCOM(self, name: str, space: int, use_sensors: bool) -> list[float]:
        links = links_of(self._model, name)
        now = self._runner.snapshot
        center = center_of_links(self._model, links, now.positions if use_sensors else self._robot.joints.commands)
        frame = space_in_torso(self._model, space_of(space), placement(self._model, self._robot, now, use_sensors))
        return (np.linalg.inv(frame) @ np.append(center, 1.0))[:3].tolist()

    def getSupportPolygon(self, space: int, use_sensors: bool) -> list[list[float]]:
        if space_of(space) == TORSO:
            raise BadValue("space", space, "1 (FRAME_WORLD) or 2 (FRAME_ROBOT)")
        placed = placement(self._model, self._robot, self._runner.snapshot, use_sensors)
        to_space = np.linalg.inv(space_in_torso(self._model, space, placed))
        soles = []
        for side in ("L", "R"):
            contour = self._model.sole_polygon(side)
            corners = np.column_stack((contour, np.full((len(contour), 2), (-self._model.sole_height, 1.0))))
            soles.append((to_space @ placed.links[f"{side}AnkleRoll"] @ corners.T).T)
        ground = min(sole[:, 2].min() for sole in soles) + EVEN
        standing = [sole for sole in soles if sole[:, 2].min() <= ground + LIFTED]
        return [list(corner) for corner in convex_hull(np.vstack(standing)[:, :2])]
