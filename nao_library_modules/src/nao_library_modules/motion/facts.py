"""What a robot's joints are and can do, asked of it once for each connection."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..base.errors import BadGoal
from ..functions.joint_trajectory import expand_names
from ..nao.joint_names import MOTION, JointNames

BODY = "Body"


@dataclass(frozen=True)
class JointLimits:
    """Range of one joint.

    Attributes:
        lower: rad (hands 0..1).
        upper: rad (hands 0..1).
        max_speed: rad/s (hands 1/s).
    """

    lower: float
    upper: float
    max_speed: float


@dataclass(frozen=True)
class MotionFacts:
    """Joints of one robot.

    Attributes:
        chains: Chain -> its joints.
        limits: Joint -> its limits.
    """

    chains: Mapping[str, Sequence[str]]
    limits: Mapping[str, JointLimits]

    def joints(self, names: Sequence[str], field: str = "names") -> list[str]:
        """Joints behind joint and chain names, in order.

        Raises:
            BadGoal: If there is none, one is unknown, or one comes twice.
        """
        return list(expand_names([name.strip() for name in names], self.chains, field))


@dataclass(frozen=True)
class JointState:
    """Where the joints are told to be, and how stiff they are.

    Attributes:
        angles: Joint -> rad (hands 0..1); None where it is not known.
        stiffnesses: Joint -> 0..1.
    """

    angles: Mapping[str, float | None]
    stiffnesses: Mapping[str, float]


class MotionAccess:
    """Facts and state of the joints of one robot. Used from the thread that executes goals only."""

    def __init__(self, robot: Any, call: Callable[..., Any]) -> None:
        """Ask nothing yet.

        Args:
            robot: Proxies and connection.
            call: Calls a method; preemption interrupts it.
        """
        self._robot = robot
        self._call = call
        self._names = JointNames(robot)
        self._facts: tuple[int, MotionFacts] | None = None

    @property
    def facts(self) -> MotionFacts:
        """What there is, asked again after each reconnection.

        Raises:
            NaoError: If the robot cannot be asked.
        """
        generation = self._robot.connection.generation
        if self._facts is None or self._facts[0] != generation:
            chains = self._names.chains
            rows = self._call(self._robot.proxy(MOTION), "getLimits", BODY)
            limits = {joint: JointLimits(*map(float, row[:3])) for joint, row in zip(chains[BODY], rows)}
            self._facts = (generation, MotionFacts(chains, limits))
        return self._facts[1]

    def state(self) -> JointState:
        """Commands and stiffnesses of all joints now.

        Raises:
            NaoError: If the robot cannot be asked.
        """
        joints = self.facts.chains[BODY]
        motion = self._robot.proxy(MOTION)
        angles = self._call(motion, "getAngles", BODY, False)
        stiffnesses = self._call(motion, "getStiffnesses", BODY)
        return JointState(dict(zip(joints, angles)), dict(zip(joints, stiffnesses)))


def one_each(values: Sequence[float], joints: Sequence[str], field: str) -> list[float]:
    """One value for each joint, from one for all or one each.

    Raises:
        BadGoal: If there are as many as neither.
    """
    if len(values) == 1:
        return list(values) * len(joints)
    if len(values) != len(joints):
        raise BadGoal(
            field,
            list(values),
            f"one value, or one for each of {', '.join(joints)}",
            problem=f"{len(values)} values for {len(joints)} joints",
        )
    return list(values)
