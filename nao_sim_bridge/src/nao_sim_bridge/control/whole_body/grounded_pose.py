"""The body as seen from a foot that stays where it is: torso, effectors and centre of mass over the ground. Pure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.control.whole_body.body_kinematics import BodyPose
from nao_sim_bridge.model.frames import Frame

TORSO = Frame("Torso", np.eye(4))


@dataclass(frozen=True, eq=False)
class Footing:
    """A foot, by the frame of its sole, that stays at a (4, 4) pose in the frame that is called the ground."""

    foot: Frame
    pose: np.ndarray


class GroundedPose:
    """A body pose in the frame of the ground.

    Attributes:
        body: The pose in the torso frame.
        torso: (4, 4) pose of the torso in the ground frame.

    Args:
        footing: The foot that stays; without one it is the torso that stays, and its frame is the ground's.
    """

    def __init__(self, body: BodyPose, footing: Footing | None) -> None:
        self.body = body
        self.torso = np.eye(4)
        self._foot = np.zeros(3)
        self._foot_jacobian: np.ndarray | None = None
        if footing is not None:
            foot = body.pose(footing.foot)
            self._foot = foot[:3, 3]
            self._foot_jacobian = body.jacobian(footing.foot)
            self.torso = footing.pose @ np.linalg.inv(foot)

    def pose(self, frame: Frame) -> np.ndarray:
        """(4, 4) pose of a frame of the robot in the ground frame."""
        return self.torso @ self.body.pose(frame)

    def jacobian(self, frame: Frame) -> np.ndarray:
        """(6, 26) velocity of the frame's origin and its rotation, along the ground's axes."""
        rows = self.body.jacobian(frame)
        if self._foot_jacobian is None:
            return rows
        rows[:3] -= foot_moves(self._foot_jacobian, self.body.pose(frame)[:3, 3] - self._foot)
        rows[3:] -= self._foot_jacobian[3:]
        turn = self.torso[:3, :3]
        return np.concatenate((turn @ rows[:3], turn @ rows[3:]))

    def center_of_mass(self) -> np.ndarray:
        """(3,) in the ground frame, m."""
        return self.torso[:3, :3] @ self.body.center_of_mass() + self.torso[:3, 3]

    def com_jacobian(self) -> np.ndarray:
        """(3, 26) velocity of the centre of mass along the ground's axes."""
        rows = self.body.com_jacobian()
        if self._foot_jacobian is not None:
            rows = rows - foot_moves(self._foot_jacobian, self.body.center_of_mass() - self._foot)
        return self.torso[:3, :3] @ rows


def foot_moves(jacobian: np.ndarray, place: np.ndarray) -> np.ndarray:
    """(3, n) velocity of a point fixed to a frame with the (6, n) `jacobian`, at `place` (m) from its origin."""
    x, y, z = place
    turn_x, turn_y, turn_z = jacobian[3:]
    moves = jacobian[:3].copy()
    moves[0] += turn_y * z - turn_z * y
    moves[1] += turn_z * x - turn_x * z
    moves[2] += turn_x * y - turn_y * x
    return moves
