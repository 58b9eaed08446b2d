"""What each foot may do under whole body control, where it stays, and what it carries. Pure but for its own records."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Iterable, Sequence

import numpy as np

from nao_sim_bridge.control.whole_body.body_kinematics import BodyKinematics, BodyPose
from nao_sim_bridge.control.whole_body.grounded_pose import Footing, GroundedPose
from nao_sim_bridge.control.whole_body.inverse_kinematics import ALL_AXES, Goal
from nao_sim_bridge.model.body_mass import convex_hull
from nao_sim_bridge.model.frames import FEET, frame_of
from nao_sim_bridge.model.kinematics import axis_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel

# Distance to keep from the edge of the support polygon, m.
MARGIN = 0.035
# What of a sole is ahead of this, m, does not count: the ankle has not the torque to lean the whole weight on the toes.
FRONT = 0.08
# A small polygon keeps at least this share of the way from its centre to its nearest edge.
CORE = 0.4
# A sole this much above the lowest one, m, is in the air.
LIFTED = 0.008
# The cosine of how much a sole may lean while it still presses on the ground: postures are not exact.
NEARLY_UPRIGHT = math.cos(0.07)


@dataclass(frozen=True, eq=False)
class BalanceRegion:
    """A convex region of the ground, over which the centre of mass stays: half planes, `normals @ point <= limits`.

    Attributes:
        normals: (n, 2) unit vectors that point out.
        limits: (n,) m.
        center: (2,) where balance is best, m.
    """

    normals: np.ndarray
    limits: np.ndarray
    center: np.ndarray

    def excess(self, point: np.ndarray) -> np.ndarray:
        """(n,) how far a point is beyond each edge, m, negative inside."""
        return self.normals @ point - self.limits


def sole_corners(model: RobotModel, foot: str, pose: np.ndarray) -> np.ndarray:
    """(n, 2) outline on the ground, m, of what counts of the sole of `LLeg` or `RLeg`, whose effector has a `pose`."""
    outline = np.minimum(model.sole_polygon(foot[0]), (FRONT, np.inf))
    corners = np.column_stack((outline, np.zeros(len(outline)), np.ones(len(outline))))
    return (pose @ corners.T)[:2].T


def balance_region(corners: Iterable[Sequence[float]]) -> BalanceRegion:
    """The region within the convex hull of `corners` (m, at least three that are not in line)."""
    hull = np.array(convex_hull(corners))
    edges = np.roll(hull, -1, axis=0) - hull
    lengths = np.hypot(edges[:, 0], edges[:, 1])
    normals = np.column_stack((edges[:, 1], -edges[:, 0])) / lengths[:, None]
    center = _centroid(hull)
    limits = (normals * hull).sum(axis=1)
    room = float((limits - normals @ center).min())
    return BalanceRegion(normals, limits - min(MARGIN, (1.0 - CORE) * room), center)


def _centroid(hull: np.ndarray) -> np.ndarray:
    """(2,) centre of the area of a polygon, counter-clockwise."""
    following = np.roll(hull, -1, axis=0)
    areas = hull[:, 0] * following[:, 1] - following[:, 0] * hull[:, 1]
    return ((hull + following) * areas[:, None]).sum(axis=0) / (3.0 * areas.sum())


class FootState(Enum):
    """What a foot may do: nothing, slide and turn on the ground, anything."""

    FIXED = "Fixed"
    PLANE = "Plane"
    FREE = "Free"


# Height, roll and pitch are what a foot in its plane keeps.
AXES = {FootState.FIXED: ALL_AXES, FootState.PLANE: 4 | 8 | 16}


class Footholds:
    """The two feet on the ground; its frame is that of the left sole when they were put down.

    Attributes:
        states: What each foot may do.
    """

    def __init__(self, body: BodyKinematics) -> None:
        self._body = body
        self._soles = {foot: frame_of(body.model, foot) for foot in FEET}
        self._poses = {foot: np.eye(4) for foot in FEET}
        self._regions: dict[tuple[str, ...], BalanceRegion] = {}
        self.states = dict.fromkeys(FEET, FootState.FIXED)

    def put_down(self, pose: BodyPose) -> None:
        """Both feet are where they are now; soles that lie on the ground but for a little become flat on it."""
        left, right = (pose.pose(self._soles[foot]) for foot in FEET)
        other = np.linalg.inv(left) @ right
        if abs(other[2, 3]) <= LIFTED and other[2, 2] >= NEARLY_UPRIGHT:
            heading = math.atan2(other[1, 0], other[0, 0])
            other = transform(axis_matrix((0.0, 0.0, 1.0), heading), (other[0, 3], other[1, 3], 0.0))
        self._poses = dict(zip(FEET, (np.eye(4), other)))
        self._regions.clear()

    def set_state(self, foot: str, state: FootState, now: GroundedPose) -> None:
        """Say what a foot may do from now on; what it keeps is as it is now."""
        self._poses[foot] = now.pose(self._soles[foot])
        self._regions.clear()
        self.states[foot] = state

    @property
    def footing(self) -> Footing | None:
        """The foot that the body stands on, a fixed one before others; None when both are free."""
        foot = self._root
        return None if foot is None else Footing(self._soles[foot], self._poses[foot])

    @property
    def kept(self) -> list[Goal]:
        """What the other foot keeps."""
        return [
            Goal(self._soles[foot], self._poses[foot], AXES[state], rank=0)
            for foot, state in self.states.items()
            if foot != self._root and state is not FootState.FREE
        ]

    def on_ground(self, now: GroundedPose, feet: Iterable[str]) -> list[str]:
        """Those of `feet` whose soles are on the ground."""
        heights = {foot: now.pose(sole)[2, 3] for foot, sole in self._soles.items()}
        lowest = min(heights[foot] for foot in FEET)
        return [foot for foot in feet if heights[foot] <= lowest + LIFTED]

    def carrying(self, now: GroundedPose, feet: Iterable[str]) -> list[str]:
        """Those of `feet` that the body may rely on: on the ground, and not free to leave it."""
        return [foot for foot in self.on_ground(now, feet) if self.states[foot] is not FootState.FREE]

    def region(self, now: GroundedPose, feet: Iterable[str]) -> BalanceRegion:
        """Where the centre of mass may be over `feet`, at least one."""
        key = tuple(feet)
        if any(self.states[foot] is not FootState.FIXED and foot != self._root for foot in key):
            return self._region(now, key)
        # Feet that stay have the same region at every tick.
        if key not in self._regions:
            self._regions[key] = self._region(now, key)
        return self._regions[key]

    def _region(self, now: GroundedPose, feet: Iterable[str]) -> BalanceRegion:
        corners = [sole_corners(self._body.model, foot, now.pose(self._soles[foot])) for foot in feet]
        return balance_region(np.concatenate(corners))

    def standing(self) -> list[str]:
        return [foot for foot, state in self.states.items() if state is not FootState.FREE]

    @property
    def _root(self) -> str | None:
        for wanted in (FootState.FIXED, FootState.PLANE):
            for foot, state in self.states.items():
                if state is wanted:
                    return foot
        return None
