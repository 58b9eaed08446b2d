"""Joint angles that bring frames of the robot to poses, all at once, within the joint limits. Pure.

A target out of reach ends at the closest point that was found.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Iterable, Sequence

import numpy as np

from nao_sim_bridge.control.whole_body.body_kinematics import BodyKinematics
from nao_sim_bridge.control.whole_body.grounded_pose import Footing, GroundedPose
from nao_sim_bridge.control.whole_body.task_solver import Wish, ranked_step
from nao_sim_bridge.model.frames import Frame

# Damping keeps steps small near singular poses: more after a step that led nowhere, less after one that did.
DAMPING, LEAST_DAMPING = 1e-4, 1e-6
CAUTION, RELIEF = 10.0, 3.0
MAX_STEP = 0.3  # rad per iteration
# An error counts as this much at most in one iteration, m: far targets only set the direction.
MAX_CHANGE = 0.1
ENOUGH = 1e-5  # m and rad
ITERATIONS = 60
# With more than this missing, m, a leg with a stretched knee is tried with a bent one; this much, rad.
CLOSE, SOFT_KNEE = 3e-4, 0.15
# The search ends when so many iterations have not brought the error down by this share of it.
PATIENCE, PROGRESS = 3, 0.001
# One radian of wrong orientation weighs as much as this many metres of wrong position: about an arm's length.
RADIAN_AS_METRES = 0.2
WEIGHTS = np.array([1.0] * 3 + [RADIAN_AS_METRES] * 3)
# What must hold before all else counts more when the closest point is chosen.
FIRST_RANK_WEIGHT = 10.0
ALL_AXES = 63


@dataclass(frozen=True, eq=False)
class Goal:
    """Where a frame of the robot should be.

    Attributes:
        frame: What is to be moved.
        pose: (4, 4), in the ground frame or in the torso frame.
        mask: Which axes count: x 1, y 2, z 4, and the rotations about them 8, 16, 32.
        axes: (3, 3) orientation, in the same frame as `pose`, of the axes that `mask` speaks of.
        grounded: Whether the pose is in the ground frame.
        rank: 0 for what must hold before all else, 1 for other wishes.
    """

    frame: Frame
    pose: np.ndarray
    mask: int = ALL_AXES
    axes: np.ndarray = field(default_factory=lambda: np.eye(3))
    grounded: bool = True
    rank: int = 1

    def rows(self, now: GroundedPose) -> tuple[np.ndarray, np.ndarray]:
        """(rows, 26) jacobian and (rows,) error of the axes that count, turns weighed as metres."""
        if self.grounded:
            pose, jacobian = now.pose(self.frame), now.jacobian(self.frame)
        else:
            pose, jacobian = now.body.pose(self.frame), now.body.jacobian(self.frame)
        turn = self.axes.T
        error = np.concatenate(
            (turn @ (self.pose[:3, 3] - pose[:3, 3]), turn @ rotation_vector(self.pose[:3, :3] @ pose[:3, :3].T))
        )
        rows = [row for row in range(6) if self.mask >> row & 1]
        turned = np.concatenate((turn @ jacobian[:3], turn @ jacobian[3:]))
        return (WEIGHTS[:, None] * turned)[rows], (WEIGHTS * error)[rows]


def rotation_vector(rotation: np.ndarray) -> np.ndarray:
    """(3,) axis times angle (rad) of a (3, 3) rotation."""
    twist = np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    sine = math.sqrt(twist @ twist) / 2.0
    angle = math.atan2(sine, (rotation[0, 0] + rotation[1, 1] + rotation[2, 2] - 1.0) / 2.0)
    if sine > 1e-9:
        return twist * (angle / (2.0 * sine))
    if angle < 1.0:
        return twist / 2.0
    # Half a turn: the axis is the largest column of R + 1.
    column = max((rotation + np.eye(3)).T, key=lambda c: float(c @ c))
    return column / np.linalg.norm(column) * angle


def solve(
    body: BodyKinematics,
    indices: Iterable[int],
    goals: Sequence[Goal],
    start: Sequence[float],
    footing: Footing | None = None,
    iterations: int = ITERATIONS,
) -> np.ndarray:
    """(26,) angles in rad, within the limits, that bring all goals closest.

    Args:
        indices: Joints that may move; one HipYawPitch stands for both.
        start: (26,) angles to begin at, rad; what may not move stays there.
        footing: The foot that stands; without one the torso stays where it is.
    """
    moving = np.zeros(len(start), dtype=bool)
    moving[list(indices)] = True
    moving[body.left_hip] |= moving[body.right_hip]
    moving &= body.movable
    begin = np.array(start, dtype=float)
    found, missing = _search(body, moving, goals, begin, footing, iterations)
    if missing < CLOSE:
        return found
    softened = soft_knees(body, begin, moving)
    if softened is begin:
        return found
    other, other_missing = _search(body, moving, goals, softened, footing, iterations)
    return other if other_missing < missing else found


def soft_knees(body: BodyKinematics, angles: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """(26,) `angles` with knees that are stretched or bent backwards a little forwards; the same array if none is.

    A knee can be bent backwards by a few degrees, up to its limit: no small step shortens such a leg. Joints that
    may not move, by the (26,) `moving`, stay.
    """
    softened = angles
    for side in "LR":
        hip, knee, ankle = (body.row[side + name] for name in ("HipPitch", "KneePitch", "AnklePitch"))
        bend = SOFT_KNEE - angles[knee]
        if moving[knee] and bend > 0.0:
            softened = softened.copy()
            softened[[hip, knee, ankle]] += (-bend / 2.0, bend, -bend / 2.0)
    return softened


def _search(
    body: BodyKinematics,
    moving: np.ndarray,
    goals: Sequence[Goal],
    start: np.ndarray,
    footing: Footing | None,
    iterations: int,
) -> tuple[np.ndarray, float]:
    """(26,) angles closest to the goals, and the size of the errors that are left."""
    mobility = np.ones(len(start))
    best = angles = start
    smallest, idle, damping = math.inf, 0, DAMPING
    wishes: list[Wish] = []
    for _ in range(iterations):
        asked, size = _wishes(goals, GroundedPose(body.at(angles), footing))
        idle = 0 if size < smallest * (1.0 - PROGRESS) else idle + 1
        if size < smallest:
            best, smallest, wishes = angles, size, asked
            damping = max(damping / RELIEF, LEAST_DAMPING)
        else:
            damping *= CAUTION
        if smallest < ENOUGH or idle >= PATIENCE:
            break
        lower, upper = (np.where(moving, side - best, 0.0) for side in body.limits(best))
        damped = [wish._replace(damping=damping) for wish in wishes]
        step = ranked_step(damped, np.zeros(len(best)), lower, upper, mobility)
        if np.abs(step).max() < 1e-7:
            break
        # Shorter as a whole: bounds of single joints would bend its direction, and cost time.
        angles = best + step / max(1.0, np.abs(step).max() / MAX_STEP)
        angles[body.right_hip] = angles[body.left_hip]
    return best, smallest


def _wishes(goals: Sequence[Goal], now: GroundedPose) -> tuple[list[Wish], float]:
    """Goals of one rank together, and the size of all errors."""
    wishes, size = [], 0.0
    for rank in (0, 1):
        parts = [goal.rows(now) for goal in goals if goal.rank == rank]
        if not parts:
            continue
        jacobian, error = (np.concatenate(both) for both in zip(*parts))
        length = math.sqrt(error @ error)
        size += length * (FIRST_RANK_WEIGHT if rank == 0 else 1.0)
        wishes.append(Wish(jacobian, error * min(1.0, MAX_CHANGE / length) if length else error, DAMPING))
    return wishes, size
