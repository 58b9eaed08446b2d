"""Where all links are and how they move with the joints: poses, Jacobians, centre of mass, many at a time. Pure.

Columns of a Jacobian are the 26 joints of the Body. The motor of both hips has the column of LHipYawPitch: what the
right hip adds is in there, and the column of RHipYawPitch is zero like those of the hands.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Sequence

import numpy as np

from nao_sim_bridge.model.frames import Frame
from nao_sim_bridge.model.robot_model import RobotModel

LEFT_HIP, RIGHT_HIP = "LHipYawPitch", "RHipYawPitch"


class BodyKinematics:
    """The constants of one robot, as arrays.

    Attributes:
        model: The robot.
        max_velocities: (26,) rad/s.
        movable: (26,) True for the joints that have a column: all but hands and RHipYawPitch.
    """

    def __init__(self, model: RobotModel) -> None:
        self.model = model
        count = len(model.joints)
        self.left_hip, self.right_hip = model.joint_index[LEFT_HIP], model.joint_index[RIGHT_HIP]
        self.movable = np.array([not j.is_hand for j in model.joints])
        self.movable[self.right_hip] = False
        # The torso is the row after the joints; a link has the row of its parent joint.
        self.row = {**model.joint_index, "Torso": count}
        self.axes = np.array([j.axis for j in model.joints])
        self.skews = np.array([[[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]] for x, y, z in self.axes])
        self.squares = self.skews @ self.skews
        self.origins = np.array([j.origin for j in model.joints])
        parents = np.array([self.row[j.parent_link] for j in model.joints])
        self.levels = _levels(parents)
        # moves[link, joint]: whether the joint carries the link.
        self.moves = np.zeros((count + 1, count), dtype=bool)
        for joints, above in self.levels:
            self.moves[joints] = self.moves[above]
            self.moves[joints, joints] = True
        self.masses = np.zeros(count + 1)
        self.coms = np.zeros((count + 1, 3))
        for link in model.links:
            self.masses[self.row[link.name]], self.coms[self.row[link.name]] = link.mass, link.com
        self.carried = self.moves.T.astype(float)
        self.carried_mass = self.carried @ self.masses
        self.max_velocities = np.array([j.max_velocity for j in model.joints])
        self._limits = model.limits_array()
        self._couplings = tuple(model.coupled_limits.values())
        for constant in (self.movable, self.moves, self.carried):
            constant.flags.writeable = False

    def limits(self, angles: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """(26,) lower and upper limits in rad; some depend on where another joint is."""
        lower, upper = self._limits[:, 0].copy(), self._limits[:, 1].copy()
        for coupling in self._couplings:
            joint = coupling.joint
            least, most = coupling.limits_at(float(angles[coupling.by]))
            lower[joint], upper[joint] = max(lower[joint], least), min(upper[joint], most)
        return lower, upper

    def at(self, angles: Sequence[float]) -> BodyPose:
        """The body with these (26,) joint angles, rad."""
        return BodyPose(self, np.asarray(angles, dtype=float))


class BodyPose:
    """The body at one set of joint angles; everything is in the torso frame.

    Attributes:
        angles: (26,) rad.
        poses: (27, 4, 4) of the links, by the row of their parent joint; the last one is the torso.
    """

    def __init__(self, body: BodyKinematics, angles: np.ndarray) -> None:
        self._body = body
        self.angles = angles
        sines, versines = np.sin(angles)[:, None, None], (1.0 - np.cos(angles))[:, None, None]
        steps = np.zeros((len(angles), 4, 4))
        steps[:, :3, :3] = np.eye(3) + sines * body.skews + versines * body.squares
        steps[:, :3, 3] = body.origins
        steps[:, 3, 3] = 1.0
        self.poses = np.empty((len(angles) + 1, 4, 4))
        self.poses[-1] = np.eye(4)
        for joints, above in body.levels:
            self.poses[joints] = self.poses[above] @ steps[joints]
        self._places = self.poses[:-1, :3, 3]
        self._axes = (self.poses[:-1, :3, :3] @ body.axes[:, :, None])[:, :, 0]

    def pose(self, frame: Frame) -> np.ndarray:
        """(4, 4) pose of a frame."""
        return self.poses[self._body.row[frame.link]] @ frame.offset

    def jacobian(self, frame: Frame) -> np.ndarray:
        """(6, 26) velocity of the frame's origin (m) and its rotation (rad), per rad of each joint."""
        point = self.pose(frame)[:3, 3]
        moving = self._body.moves[self._body.row[frame.link]]
        rows = np.zeros((6, len(self.angles)))
        rows[:3] = cross_rows(self._axes, point - self._places).T * moving
        rows[3:] = self._axes.T * moving
        return self._coupled(rows)

    def center_of_mass(self) -> np.ndarray:
        """(3,) of the whole robot, m."""
        return self._moments().sum(axis=0) / self._body.model.total_mass

    def com_jacobian(self) -> np.ndarray:
        """(3, 26) velocity of the centre of mass (m) per rad of each joint."""
        body = self._body
        # About each joint, the moment of all that it carries.
        moments = body.carried @ self._moments() - body.carried_mass[:, None] * self._places
        return self._coupled(cross_rows(self._axes, moments).T / body.model.total_mass)

    def _moments(self) -> np.ndarray:
        body = self._body
        centers = (self.poses[:, :3, :3] @ body.coms[:, :, None])[:, :, 0] + self.poses[:, :3, 3]
        return centers * body.masses[:, None]

    def _coupled(self, rows: np.ndarray) -> np.ndarray:
        left, right = self._body.left_hip, self._body.right_hip
        rows[:, left] += rows[:, right]
        rows[:, right] = 0.0
        return rows


@lru_cache(maxsize=None)
def body_kinematics(model: RobotModel) -> BodyKinematics:
    """The constants of `model`, worked out once."""
    return BodyKinematics(model)


def cross_rows(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products of the rows of two (n, 3) arrays; several times as fast as NumPy's for few rows."""
    result = np.empty_like(a)
    result[:, 0] = a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1]
    result[:, 1] = a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]
    result[:, 2] = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return result


def _levels(parents: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """(joints, rows of their parents) in layers: each one hangs on those before it only."""
    torso = len(parents)
    depth: dict[int, int] = {torso: 0}
    for joint, parent in enumerate(parents):
        depth[joint] = depth[int(parent)] + 1
    layers = []
    for level in range(1, max(depth.values()) + 1):
        joints = np.array([joint for joint in range(torso) if depth[joint] == level])
        layers.append((joints, parents[joints]))
    return layers
