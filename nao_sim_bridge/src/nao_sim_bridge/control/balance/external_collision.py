"""What the sonars see in front of the robot, and how fast arms may move there.

The sonars are all that a NAO measures distances with. An echo says how far the nearest thing within a cone is, not
where in the cone: an arm slows down as it gets as far out as the echo comes from.
"""

from __future__ import annotations

import math
from typing import Mapping, Sequence

import numpy as np

from nao_sim_bridge.body.sensors.sonar import HALF_CONE
from nao_sim_bridge.model.frames import frame_of
from nao_sim_bridge.model.kinematics import link_transforms, rpy_matrix
from nao_sim_bridge.model.robot_model import RobotModel

ARMS = ("LArm", "RArm")
PARTS = ("Move", *ARMS)
# Echoes from further away, m, are none: nothing there is in reach.
FARTHEST = 1.0
# No hand gets further than this from a sonar, m.
FARTHEST_HAND = 0.5
# An arm this close to an obstacle, m, has only this share of its speed left.
CLOSEST, SLOWEST = 0.02, 0.1


class ExternalCollision:
    """Security distances, and what they make of arms.

    Attributes:
        enabled: Which of "Move", "LArm" and "RArm" are protected.
        orthogonal: Distance to an obstacle ahead at which a move at full speed stops, m.
        tangential: Least distance to any obstacle, m; arms slow down within it.
    """

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._chains = {arm: tuple(model.joint_index[name] for name in model.chains[arm]) for arm in ARMS}
        self._hands = {arm: frame_of(model, arm) for arm in ARMS}
        self._sonars = [(np.asarray(s.position), rpy_matrix(s.rpy)[:, 0]) for s in model.sonars]
        self.enabled = set(PARTS)
        self.orthogonal, self.tangential = 0.4, 0.1

    def closest_obstacle(self, arm: str, positions: Sequence[float], echoes: Sequence[float]) -> np.ndarray | None:
        """(3,) the obstacle that is nearest to a hand, m, in torso, taken to be in the middle of its cone; or None."""
        hand = self._hand(arm, link_transforms(self._model, positions))
        seen = [place + echo * ahead for (place, ahead), echo in zip(self._sonars, echoes) if echo <= FARTHEST]
        return min(seen, key=lambda point: float(np.linalg.norm(point - hand)), default=None)

    def speed_shares(self, positions: Sequence[float], echoes: Sequence[float]) -> Mapping[int, float]:
        """Share of the top speed that the joints of arms have, by index, for those that may not use all of it."""
        arms = self.enabled.intersection(ARMS)
        if not arms or min(echoes) > FARTHEST_HAND + self.tangential:
            return {}
        links = link_transforms(self._model, positions)
        shares: dict[int, float] = {}
        for arm in sorted(arms):
            gap = self._gap(self._hand(arm, links), echoes)
            if gap < self.tangential:
                room = max(self.tangential - CLOSEST, 1e-3)
                share = min(max((gap - CLOSEST) / room, SLOWEST), 1.0)
                shares.update((index, share) for index in self._chains[arm])
        return shares

    def blocks(self, ahead: float, echoes: Sequence[float]) -> bool:
        """Whether the robot must not go on: at full speed it stops at the orthogonal distance, a slow one gets nearer.

        Args:
            ahead: How fast it goes forward, as a share of its full speed.
            echoes: Of the sonars, m.
        """
        if ahead <= 0.0 or "Move" not in self.enabled:
            return False
        return min(echoes) < self.tangential + min(ahead, 1.0) * max(self.orthogonal - self.tangential, 0.0)

    def obstacle_ahead(self, echoes: Sequence[float]) -> np.ndarray:
        """(3,) the nearest obstacle, m, in torso, taken to be in the middle of its cone."""
        echo, (place, ahead) = min(zip(echoes, self._sonars), key=lambda pair: pair[0])
        return place + echo * ahead

    def _hand(self, arm: str, links: Mapping[str, np.ndarray]) -> np.ndarray:
        frame = self._hands[arm]
        return (links[frame.link] @ frame.offset)[:3, 3]

    def _gap(self, hand: np.ndarray, echoes: Sequence[float]) -> float:
        """How much further away than the hand the nearest thing in the hand's direction is, m."""
        gaps = [math.inf]
        for (place, ahead), echo in zip(self._sonars, echoes):
            way = hand - place
            far = float(np.linalg.norm(way))
            if echo <= FARTHEST and float(way @ ahead) >= far * math.cos(HALF_CONE):
                gaps.append(echo - far)
        return min(gaps)
