"""Keeps the arms from body, head, thighs and each other, by the spheres and capsules that NAOqi takes the robot for.

An arm that would come too close stays where it is until its motion leads away. Distances are those of the commands:
what the arm really does is up to its motors.
"""

from __future__ import annotations

from typing import AbstractSet, Sequence

import numpy as np

from nao_sim_bridge.model.kinematics import link_transforms, rpy_matrix
from nao_sim_bridge.model.robot_model import CollisionShape, RobotModel, joint_kind

ARMS = ("LArm", "RArm")
# The shapes are wider than the limbs: with the elbows on the knees, in the posture Crouch, they overlap by 4 mm.
CONTACT = -0.006
# From this distance on, m, an arm is near something.
NEAR = 0.02
# How far a shape comes at most for each rad that a joint turns, m, by kind of joint; others move no shape.
REACH = {
    "HeadYaw": 0.04,
    "HeadPitch": 0.08,
    "ShoulderPitch": 0.23,
    "ShoulderRoll": 0.23,
    "ElbowYaw": 0.12,
    "ElbowRoll": 0.12,
    "HipYawPitch": 0.2,
    "HipRoll": 0.2,
    "HipPitch": 0.2,
    "KneePitch": 0.1,
}
ROUNDING = 1e-9
# Squares of lengths below this, m2, are those of points.
POINT = 1e-12
NONE, CLOSE, COLLISION = "none", "near", "collision"
NOBODY: frozenset[int] = frozenset()


class SelfCollision:
    """Distances of the arms, and the guard of the joints' commands that keeps them.

    Attributes:
        enabled: Arms that are kept apart from the rest.
        suspended: True while a move runs that has been tried with its contacts; nothing is kept apart then.
    """

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self.enabled = set(ARMS)
        self.suspended = False
        self._chains = {arm: frozenset(model.joint_index[name] for name in model.chains[arm]) for arm in ARMS}
        shapes = model.collision_shapes
        moving = {arm: [k for k, shape in enumerate(shapes) if _link(shape) == f"{arm[0]}ElbowRoll"] for arm in ARMS}
        fixed = [k for k, shape in enumerate(shapes) if "Elbow" not in _link(shape) and "Ankle" not in _link(shape)]
        pairs = [(k, other, {arm}) for arm in ARMS for k in moving[arm] for other in fixed]
        pairs += [(k, other, set(ARMS)) for k in moving["LArm"] for other in moving["RArm"]]
        self._first, self._second = (np.array([pair[side] for pair in pairs]) for side in (0, 1))
        self._of_arm = {arm: np.array([arm in arms for _, _, arms in pairs]) for arm in ARMS}
        self._links = [_link(shape) for shape in shapes]
        self._ends = np.array([_ends(shape) for shape in shapes])
        radii = np.array([shape.radius for shape in shapes])
        self._radii = radii[self._first] + radii[self._second]
        self._movers = [_movers(model, chain) for chain in ("LArm", "RArm", "LLeg", "RLeg", "Head")]
        between = np.array([len(arms) > 1 for _, _, arms in pairs])
        self._groups = [self._of_arm[arm] & ~between for arm in ARMS] + [between]
        # How far shapes may still come, in m, before anything can touch, for each group of pairs: left arm and body,
        # right arm and body, both arms. Known for these commands.
        self._slack = [0.0] * len(self._groups)
        self._seen: Sequence[float] = ()
        # Distances where an arm was kept last: it is likely to be kept there for a while.
        self._held_at: Sequence[float] = ()
        self._held = np.empty(0)

    def __call__(self, before: Sequence[float], commands: Sequence[float]) -> AbstractSet[int]:
        """Joints of arms that must not take this step, from `before` to `commands` (26, rad)."""
        if self.suspended or not self.enabled:
            self._seen = ()
            return NOBODY
        known = before == self._seen
        self._seen = tuple(commands)
        if known and self._far_apart(before, commands):
            return NOBODY
        after = self.distances(commands)
        self._slack = [max(float(after[group].min()) - CONTACT, 0.0) for group in self._groups]
        closing = after < CONTACT
        if not closing.any():
            return NOBODY
        if before != self._held_at:
            self._held_at, self._held = tuple(before), self.distances(before)
        closing &= after < self._held - ROUNDING
        return frozenset().union(
            *(self._chains[arm] for arm in ARMS if arm in self.enabled and closing[self._of_arm[arm]].any())
        )

    def _far_apart(self, before: Sequence[float], commands: Sequence[float]) -> bool:
        """Whether nothing can touch after this step, by how far shapes have come at most since distances were known."""
        left, right, left_leg, right_leg, head = [
            sum([abs(commands[i] - before[i]) * reach for i, reach in movers]) for movers in self._movers
        ]
        body = head + (left_leg if left_leg > right_leg else right_leg)
        slack = self._slack
        slack[0] -= left + body
        slack[1] -= right + body
        slack[2] -= left + right
        return min(slack) > 0.0

    def distances(self, angles: Sequence[float]) -> np.ndarray:
        """(n,) distances in m of all pairs of shapes for joint angles (26, rad); negative where they overlap."""
        links = link_transforms(self._model, angles)
        poses = np.array([links[name] for name in self._links])
        ends = np.einsum("kij,kej->kei", poses[:, :3, :3], self._ends) + poses[:, None, :3, 3]
        first, second = ends[self._first], ends[self._second]
        return segment_distances(first[:, 0], first[:, 1], second[:, 0], second[:, 1]) - self._radii

    def state(self, arm: str, angles: Sequence[float]) -> str:
        """NAOqi's word for how close an arm is to anything else of the robot with these joint angles."""
        least = float(self.distances(angles)[self._of_arm[arm]].min())
        if least < CONTACT:
            return COLLISION
        return CLOSE if least < NEAR else NONE


def _movers(model: RobotModel, chain: str) -> list[tuple[int, float]]:
    """Joints of a chain that move shapes, by index, and how far for each rad, m."""
    joints = ((model.joint_index[name], REACH.get(joint_kind(name), 0.0)) for name in model.chains[chain])
    return [(index, reach) for index, reach in joints if reach]


def _link(shape: CollisionShape) -> str:
    return shape.place.parent_link


def _ends(shape: CollisionShape) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the axis of a capsule in the frame of its link, m; both are the centre of a sphere."""
    centre = np.asarray(shape.place.position, dtype=float)
    half = 0.0 if shape.length is None else max(shape.length / 2.0 - shape.radius, 0.0)
    axis = rpy_matrix(shape.place.rpy)[:, 2] * half
    return centre - axis, centre + axis


def segment_distances(p1: np.ndarray, q1: np.ndarray, p2: np.ndarray, q2: np.ndarray) -> np.ndarray:
    """(n,) distances in m between segments p1-q1 and p2-q2, each (n, 3) in one frame; ends may coincide (spheres).

    Source: the closest points follow from the two normal equations, clamped to the ends of the segments one after the
    other (C. Ericson, Real-Time Collision Detection, 5.1.9).
    """
    d1, d2, between = q1 - p1, q2 - p2, p1 - p2
    a, e = _dot(d1, d1), _dot(d2, d2)
    b, c, f = _dot(d1, d2), _dot(d1, between), _dot(d2, between)
    safe_a, safe_e = np.maximum(a, POINT), np.maximum(e, POINT)
    denominator = a * e - b * b
    parallel = denominator < POINT
    s = np.where(parallel, 0.0, np.clip((b * f - c * e) / np.where(parallel, 1.0, denominator), 0.0, 1.0))
    t = np.clip((b * s + f) / safe_e, 0.0, 1.0) * (e > POINT)
    s = np.clip((b * t - c) / safe_a, 0.0, 1.0) * (a > POINT)
    apart = between + s[:, None] * d1 - t[:, None] * d2
    return np.sqrt(_dot(apart, apart))


def _dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", first, second)
