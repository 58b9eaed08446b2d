"""What a robot's joints are and can do, asked of it once for each connection."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..base.errors import BadGoal
from ..functions.joint_trajectory import expand_names
from ..nao.joint_names import LEGS as LEGS
from ..nao.joint_names import MOTION as MOTION

BODY = "Body"
ARMS = ("LArm", "RArm")


@dataclass(frozen=True)
class JointLimits:
    lower: float  # rad (hands 0..1)
    upper: float
    max_speed: float  # rad/s (hands 1/s)

    def within(self, angle: float) -> float:
        """The nearest angle to this one that the joint can have."""
        return min(max(angle, self.lower), self.upper)


@dataclass(frozen=True)
class MotionFacts:
    """Joints of one robot: those of each chain, and the limits of each."""

    chains: Mapping[str, Sequence[str]]
    limits: Mapping[str, JointLimits]

    def joints(self, names: Sequence[str], field: str = "names") -> list[str]:
        """Joints behind joint and chain names, in order.

        Raises BadGoal if there is none, one is unknown, or one comes twice.
        """
        return list(expand_names([name.strip() for name in names], self.chains, field))


@dataclass(frozen=True)
class JointState:
    """The commands of the joints, and how stiff they are."""

    angles: Mapping[str, float | None]  # rad (hands 0..1); None where it is not known
    stiffnesses: Mapping[str, float]  # 0..1


def one_each(values: Sequence[float], joints: Sequence[str], field: str) -> list[float]:
    """One value for each joint, from one for all or one each. Raises BadGoal if there are as many as neither."""
    if len(values) == 1:
        return list(values) * len(joints)
    if len(values) != len(joints):
        problem = f"{len(values)} values for {len(joints)} joints"
        raise BadGoal(field, list(values), f"one value, or one for each of {', '.join(joints)}", problem=problem)
    return list(values)
