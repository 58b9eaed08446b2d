"""Where the body is over its feet, worked out from what the robot itself measures: joint encoders and inertial unit.

Positions are in the *level frame*: origin in the torso, Z up against gravity, X where the torso heads. Everything is a
function of its arguments. Vectors are carried from the tips of the limbs to the torso, joint by joint, in plain floats:
this runs in the tick, and a product of matrices for each link would cost several times as much.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Iterable, NamedTuple, Sequence, Tuple

from nao_sim_bridge.base.rotations import Vector3, cross, from_roll_pitch_yaw, rotate, vector3
from nao_sim_bridge.model.robot_model import Joint, RobotModel

FEET = ("LAnkleRoll", "RAnkleRoll")
ZERO: Vector3 = (0.0, 0.0, 0.0)
UP: Vector3 = (0.0, 0.0, 1.0)
AXES: Tuple[Vector3, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), UP)
# An axis that is none of X, Y, Z: that of the hips that yaw and pitch at once.
SLANTED = 3


class _Step(NamedTuple):
    """What happens to a vector on its way over one joint: add `before`, turn about the axis, add `after`."""

    index: int
    kind: int
    axis: Vector3
    before: Vector3
    after: Vector3


@dataclass(frozen=True)
class Stance:
    """The body over its feet, in the level frame, m.

    Attributes:
        com: Centre of mass of the whole robot.
        left_ankle: Where pitch and roll axis of the ankle cross.
        right_ankle: The same on the right.
    """

    com: Vector3
    left_ankle: Vector3
    right_ankle: Vector3

    @property
    def com_from_feet(self) -> Vector3:
        """Centre of mass as seen from the middle between the ankles."""
        x, y, z = ((left + right) / 2 for left, right in zip(self.left_ankle, self.right_ankle))
        return (self.com[0] - x, self.com[1] - y, self.com[2] - z)


class MassCarrier:
    """Where the mass of the torso and of some limbs is.

    Attributes:
        mass: Of all of them, kg.

    Args:
        tips: Last links of the limbs, see `limb_tips`.
    """

    def __init__(self, model: RobotModel, tips: Iterable[str]) -> None:
        torso = model.link("Torso")
        limbs = [_limb(model, tip) for tip in tips]
        self.mass = torso.mass + sum(model.link(joint.child_link or "").mass for limb in limbs for joint in limb)
        self._torso_moment = _times(torso.com, torso.mass)
        self._limbs = [_moment_steps(model, limb) for limb in limbs]

    def moment(self, angles: Sequence[float]) -> Vector3:
        """Mass times centre of mass in the torso frame, kg m; (26,) angles in rad."""
        x, y, z = self._torso_moment
        for steps in self._limbs:
            dx, dy, dz = _carry(steps, angles, ZERO)
            x, y, z = x + dx, y + dy, z + dz
        return (x, y, z)


def limb_tips(model: RobotModel) -> list[str]:
    parents = {link.parent_joint and model.joint(link.parent_joint).parent_link for link in model.links}
    return [link.name for link in model.links if link.name not in parents]


class StanceReader:
    """Makes stances of one robot."""

    def __init__(self, model: RobotModel) -> None:
        self._masses = MassCarrier(model, limb_tips(model))
        self._sole_height = model.sole_height
        legs = [_limb(model, foot) for foot in FEET]
        self._places = [[_step(model, joint, after=vector3(joint.origin)) for joint in leg] for leg in legs]
        self._directions = [[_step(model, joint) for joint in leg] for leg in legs]
        self._soles = [[(float(x), float(y), -model.sole_height) for x, y in model.sole_polygon(s)] for s in "LR"]

    def read(self, angles: Sequence[float], roll: float, pitch: float) -> Stance:
        """The stance of a robot whose torso leans.

        Args:
            angles: (26,) joint angles in Body order, rad.
            roll: Of the torso in world, rad.
            pitch: Of the torso in world, rad.
        """
        x, y, z = self._masses.moment(angles)
        level = from_roll_pitch_yaw(roll, pitch, 0.0)
        mass = self._masses.mass
        com = rotate(level, (x / mass, y / mass, z / mass))
        left, right = (rotate(level, _carry(steps, angles, ZERO)) for steps in self._places)
        return Stance(com, left, right)

    def lean(self, angles: Sequence[float]) -> tuple[float, float]:
        """Roll and pitch of the torso, rad, when both soles are flat on a level floor: on average of the two."""
        left, right = (_carry(steps, angles, UP) for steps in self._directions)
        x, y, z = (a + b for a, b in zip(left, right))
        return math.atan2(y, z), math.atan2(-x, math.hypot(y, z))

    def ankle(self, side: int, angles: Sequence[float]) -> Vector3:
        """Where pitch and roll axis of an ankle cross in the torso frame, m; side 0 left, 1 right, angles in rad."""
        return _carry(self._places[side], angles, ZERO)

    def sole_center(self, side: int, angles: Sequence[float]) -> Vector3:
        """The point of the sole below the ankle in the torso frame, m; side 0 left, 1 right, angles in rad."""
        return _carry(self._places[side], angles, (0.0, 0.0, -self._sole_height))

    def toe_direction(self, side: int, angles: Sequence[float]) -> Vector3:
        """Where a foot points, a unit vector in the torso frame; side 0 left, 1 right, angles in rad."""
        return _carry(self._directions[side], angles, AXES[0])

    def sole(self, side: int, angles: Sequence[float], roll: float, pitch: float) -> list[Vector3]:
        """Corners of the outline of a sole, side 0 left, 1 right, in the level frame, m; all else as in `read`."""
        level = from_roll_pitch_yaw(roll, pitch, 0.0)
        ankle = rotate(level, _carry(self._places[side], angles, ZERO))
        ahead = rotate(level, _carry(self._directions[side], angles, AXES[0]))
        up = rotate(level, _carry(self._directions[side], angles, UP))
        aside = cross(up, ahead)
        return [
            tuple(o + x * a + y * b + z * c for o, a, b, c in zip(ankle, ahead, aside, up))  # type: ignore[misc]
            for x, y, z in self._soles[side]
        ]


@lru_cache(maxsize=None)
def stance_reader(model: RobotModel) -> StanceReader:
    """The reader of all robots of a model, worked out once."""
    return StanceReader(model)


def _limb(model: RobotModel, tip: str) -> list[Joint]:
    """Joints from the link `tip` to the torso."""
    joints = []
    link = model.link(tip)
    while link.parent_joint is not None:
        joints.append(model.joint(link.parent_joint))
        link = model.link(joints[-1].parent_link)
    return joints


def _moment_steps(model: RobotModel, limb: Sequence[Joint]) -> list[_Step]:
    """Steps that gather mass times centre of mass of a limb about the torso's origin, kg m."""
    steps = []
    carried = 0.0
    for joint in limb:
        link = model.link(joint.child_link or "")
        carried += link.mass
        steps.append(_step(model, joint, _times(link.com, link.mass), _times(joint.origin, carried)))
    return steps


def _step(model: RobotModel, joint: Joint, before: Vector3 = ZERO, after: Vector3 = ZERO) -> _Step:
    axis = vector3(joint.axis)
    kind = AXES.index(axis) if axis in AXES else SLANTED
    return _Step(model.joint_index[joint.name], kind, axis, before, after)


def _carry(steps: Sequence[_Step], angles: Sequence[float], start: Vector3) -> Vector3:
    """A vector given at the tip of a limb, in the frame of the torso."""
    x, y, z = start
    for index, kind, axis, (bx, by, bz), (ax, ay, az) in steps:
        angle = angles[index]
        s, c = math.sin(angle), math.cos(angle)
        x, y, z = x + bx, y + by, z + bz
        if kind == 0:
            x, y, z = x + ax, c * y - s * z + ay, s * y + c * z + az
        elif kind == 1:
            x, y, z = c * x + s * z + ax, y + ay, c * z - s * x + az
        elif kind == 2:
            x, y, z = c * x - s * y + ax, s * x + c * y + ay, z + az
        else:
            u, v, w = axis
            along = (1.0 - c) * (u * x + v * y + w * z)
            x, y, z = (
                c * x + s * (v * z - w * y) + along * u + ax,
                c * y + s * (w * x - u * z) + along * v + ay,
                c * z + s * (u * y - v * x) + along * w + az,
            )
    return (x, y, z)


def _times(vector: Sequence[float], factor: float) -> Vector3:
    x, y, z = (float(value) * factor for value in vector)
    return (x, y, z)
