"""Where the head was, along time."""

from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.robot_model import Joint, RobotModel


class HeadPoses(NamedTuple):
    """Poses of the link of the head in world at several times: (n, 3, 3) rotations and (n, 3) positions, m."""

    rotations: np.ndarray
    positions: np.ndarray

    def place(self, points: np.ndarray) -> np.ndarray:
        """(n, k, 3) in world of (k, 3) points of the head, m."""
        return points @ np.swapaxes(self.rotations, 1, 2) + self.positions[:, None, :]


class PoseTrack:
    """Remembers torso and head of the last `keep` ticks. Written in the simulation thread, read in any.

    From the `link` of the head the neck is followed down to the torso.
    """

    def __init__(self, model: RobotModel, link: str, keep: int) -> None:
        self._neck = _chain(model, link)
        self._columns = [model.joint_index[joint.name] for joint in self._neck]
        self._keep = keep
        self._poses: dict[int, tuple[Sequence[float], Sequence[float], tuple[float, ...]]] = {}
        self._first = self._began = 0

    def record(self, tick: int, snapshot: Snapshot) -> None:
        torso, angles = snapshot.torso, snapshot.positions
        if not self._poses:
            self._first = self._began = tick
        self._poses[tick] = (torso.position, torso.orientation, tuple([angles[column] for column in self._columns]))
        if tick - self._first >= self._keep:
            self._poses.pop(self._first, None)
            self._first += 1

    def knows(self, tick: int) -> bool:
        return tick in self._poses

    def at(self, first: int, last: int) -> HeadPoses:
        """Poses at the ticks `first` to `last`, this one included; before all of them the head was where it was first.

        Raises:
            BadValue: One of them is still to come, or forgotten.
        """
        try:
            known = [self._poses[max(tick, self._began)] for tick in range(first, last + 1)]
        except KeyError as error:
            raise BadValue("tick", error.args[0], f"{self._first} to {self._first + len(self._poses) - 1}") from error
        rotations = _quaternion_matrices(np.array([pose[1] for pose in known]))
        positions = np.array([pose[0] for pose in known])
        angles = np.array([pose[2] for pose in known])
        for column, joint in enumerate(self._neck):
            positions = positions + rotations @ joint.origin
            rotations = rotations @ _axis_matrices(joint.axis, angles[:, column])
        return HeadPoses(rotations, positions)


def _chain(model: RobotModel, link: str) -> list[Joint]:
    joints: list[Joint] = []
    while link != "Torso":
        joints.insert(0, next(joint for joint in model.joints if joint.child_link == link))
        link = joints[0].parent_link
    return joints


def _quaternion_matrices(q: np.ndarray) -> np.ndarray:
    """(n, 3, 3) rotations of (n, 4) unit quaternions (x, y, z, w)."""
    x, y, z, w = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def _axis_matrices(axis: Sequence[float], angles: np.ndarray) -> np.ndarray:
    """(n, 3, 3) rotations about a unit vector by (n,) angles in rad."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sines, cosines = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + sines * cross + (1.0 - cosines) * (cross @ cross)
