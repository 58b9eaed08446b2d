"""Names of joints and chains, asked of the robot once for each connection."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from naoqi.errors import NaoError, RobotError
from naoqi.limits import ANSWER_LIMIT

from ..base.once_per_connection import OncePerConnection

MOTION = "ALMotion"
MOVE_FAILED = f"{MOTION}/MoveFailed"
"""Event of a walk that ends, or does not begin: cause, 0 not started or 1 stopped on the way, place of an obstacle."""
LEGS = ("LLeg", "RLeg")
CHAINS = (
    "Body",
    "Head",
    "LArm",
    "RArm",
    "LLeg",
    "RLeg",
    "Arms",
    "Legs",
    "Joints",
    "Actuators",
    "JointActuators",
    "BodyJoints",
    "BodyActuators",
)
"""Names that stand for several joints. Not every robot knows all of them."""


class JointNames:
    """Chains of one robot. Any thread may ask; at worst two ask the robot at the same time."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._chains = OncePerConnection(robot, self._ask)

    @property
    def chains(self) -> Mapping[str, tuple[str, ...]]:
        """Chain -> its joints. Raises NaoError if the robot cannot be asked."""
        return self._chains()

    @property
    def body(self) -> tuple[str, ...]:
        """All joints, in the robot's order. Raises NaoError if the robot cannot be asked."""
        return self.chains["Body"]

    def _ask(self) -> dict[str, tuple[str, ...]]:
        motion = self._robot.proxy(MOTION)
        calls = {chain: motion.call_async("getBodyNames", chain) for chain in CHAINS}
        chains = {}
        for chain, call in calls.items():
            try:
                chains[chain] = tuple(call.result(timeout=ANSWER_LIMIT))
            except RobotError:
                continue  # a robot without this chain says so
        if "Body" not in chains:
            raise NaoError(f"the robot at {self._robot.address} does not tell the names of its joints")
        return chains
