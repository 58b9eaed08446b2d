"""What a Cartesian command means for the body: which joints move, which goals they serve, what stays. Pure.

An arm or the head moves alone. A leg moves by the joints of both, as both share a motor, and the other foot stays
where it is seen from the torso. The torso moves over feet that stay on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterable, Sequence

import numpy as np

from nao_sim_bridge.control.whole_body.body_kinematics import BodyKinematics
from nao_sim_bridge.control.whole_body.grounded_pose import Footing
from nao_sim_bridge.control.whole_body.inverse_kinematics import Goal
from nao_sim_bridge.model.frames import FEET, TORSO, Placement, frame_of, space_in_torso
from nao_sim_bridge.model.robot_model import RobotModel

BASE = "Torso"


@dataclass(frozen=True, eq=False)
class EffectorMove:
    """One effector (a chain or `Torso`) on its way: a time in s to its (4, 4) pose in `TORSO`, `WORLD` or `ROBOT`.

    The mask says which axes count.
    """

    name: str
    space: int
    mask: int
    pose_at: Callable[[float], np.ndarray]


def moving_joints(model: RobotModel, names: Iterable[str]) -> list[int]:
    """Body indices of the joints that move effectors, without hands."""
    chains: list[str] = []
    for name in names:
        chains += FEET if name in (BASE, *FEET) else [name]
    joints = [model.joint_index[joint] for chain in dict.fromkeys(chains) for joint in model.chains[chain]]
    return [i for i in joints if not model.joints[i].is_hand]


class CartesianMove:
    """Goals of effectors that move at once; the ground is the frame that the torso is in when they begin.

    Attributes:
        indices: Joints that move.

    Args:
        moves: Where effectors should be, each effector once.
        placed: Where the commands put the robot when the move begins.
    """

    def __init__(self, body: BodyKinematics, moves: Sequence[EffectorMove], placed: Placement) -> None:
        self._model = body.model
        self._moves = {move.name: move for move in moves}
        self._placed = placed
        self._spaces = {move.name: space_in_torso(self._model, move.space, placed) for move in moves}
        self.indices = moving_joints(self._model, self._moves)
        self._torso_moves = BASE in self._moves
        self._foot = self._standing_foot()
        feet_move = self._torso_moves or any(foot in self._moves for foot in FEET)
        kept = [foot for foot in FEET if feet_move and foot not in (*self._moves, self._footed)]
        self._kept = [Goal(frame_of(self._model, foot), self._now(foot), rank=0) for foot in kept]

    @property
    def _footed(self) -> str | None:
        """The foot that the body stands on while the torso moves."""
        return self._foot if self._torso_moves else None

    def goals_at(self, elapsed: float) -> list[Goal]:
        """All goals after `elapsed` seconds."""
        return self._kept + [self._goal(move, elapsed) for move in self._moves.values() if move.name != self._footed]

    def footing_at(self, elapsed: float) -> Footing | None:
        """The foot that the body stands on; None while the torso stays where it is."""
        if not self._torso_moves:
            return None
        move = self._moves.get(self._foot)
        pose = self._now(self._foot) if move is None else self._spaces[self._foot] @ move.pose_at(elapsed)
        return Footing(frame_of(self._model, self._foot), pose)

    def _goal(self, move: EffectorMove, elapsed: float) -> Goal:
        space = self._spaces[move.name]
        return Goal(
            frame_of(self._model, move.name),
            space @ move.pose_at(elapsed),
            move.mask,
            space[:3, :3],
            # Seen from a torso that moves itself, only its own frame makes a difference.
            grounded=move.space != TORSO or move.name == BASE,
            rank=0 if self._torso_moves and move.name in FEET else 1,
        )

    def _standing_foot(self) -> str:
        """A foot that is not asked to move, the lower one of two."""
        idle = [foot for foot in FEET if foot not in self._moves] or list(FEET)
        return min(idle, key=lambda foot: round((self._placed.torso_in_world @ self._now(foot))[2, 3], 4))

    def _now(self, foot: str) -> np.ndarray:
        return self._placed.in_torso(frame_of(self._model, foot))
