"""Where the head was a moment ago: what the microphones heard is known only then."""

from __future__ import annotations

import bisect
from collections import deque
from dataclasses import dataclass
from itertools import islice

import numpy as np

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.model.frames import ROBOT, Placement, space_in_torso
from nao_sim_bridge.model.kinematics import LinkPoses, quaternion_matrix, transform
from nao_sim_bridge.naoqi.motion.arguments import as_position

# Snapshots that are kept: about a second.
KEPT = 256
HEAD = "Head"


@dataclass(frozen=True)
class HeadPose:
    """The head at one time.

    Attributes:
        up: Unit vector upwards in the world, in the frame of the head.
        in_torso: x, y, z in m, wx, wy, wz in rad, in FRAME_TORSO.
        in_robot: The same in FRAME_ROBOT.
    """

    up: tuple[float, float, float]
    in_torso: list[float]
    in_robot: list[float]


class HeadTrack:
    """Remembers the last snapshots. Written in the simulation thread, read in any.

    Args:
        simulation: Of the robot.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._link = simulation.model.effectors[HEAD]
        self._snapshots: deque[Snapshot] = deque([simulation.snapshot], maxlen=KEPT)
        simulation.after_tick.append(self._snapshots.append)

    def at(self, time: float) -> HeadPose:
        """The head at a simulated time, s; the oldest that is known when that is too long ago."""
        return self._pose(self._snapshot(time))

    def _snapshot(self, time: float) -> Snapshot:
        known = self._known()
        return known[max(0, bisect.bisect_right([snapshot.time for snapshot in known], time) - 1)]

    def _known(self) -> list[Snapshot]:
        while True:
            try:
                return list(islice(self._snapshots, len(self._snapshots)))
            except RuntimeError:  # the simulation thread appended meanwhile
                continue

    def _pose(self, snapshot: Snapshot) -> HeadPose:
        model = self._simulation.model
        odometry = transform(quaternion_matrix(snapshot.odometry.orientation), snapshot.odometry.position)
        placement = Placement(LinkPoses(model, snapshot.positions), odometry)
        head = placement.links[self._link.parent_link]
        in_robot = np.linalg.inv(space_in_torso(model, ROBOT, placement)) @ head
        up = (quaternion_matrix(snapshot.torso.orientation) @ head[:3, :3])[2]
        return HeadPose(tuple(up.tolist()), as_position(head), as_position(in_robot))
