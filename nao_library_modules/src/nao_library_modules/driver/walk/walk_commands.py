"""Commands to walk (a velocity, a target, a step) and gait parameters: messages become checked values. No ROS."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, List, Union

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...base.field_checks import number_parameter, require_within
from ...base.limits import limit
from ...base.places import Place

WAY, ANGLE = limit("way"), limit("angle")
NO_VELOCITY = 1e-3
"""A velocity below this (fraction of the top speed) in all directions is none."""
LEFT, RIGHT = "LLeg", "RLeg"
LEGS = {0: RIGHT, 1: LEFT}
"""Legs of nao_library_msgs/StepTarget, as ALMotion names them."""
GaitConfig = List[List[Union[str, float]]]
"""What ALMotion takes: [["MaxStepX", 0.04], ...]."""
FORM = "a list like [[MaxStepX, 0.03], [StepHeight, 0.02]], or a dictionary"


@dataclass(frozen=True)
class Velocity:
    """A walking velocity forward, to the left and turning to the left: fractions -1..1 of the top speed."""

    x: float
    y: float
    theta: float

    @property
    def is_zero(self) -> bool:
        return max(abs(self.x), abs(self.y), abs(self.theta)) < NO_VELOCITY

    def __str__(self) -> str:
        return f"walking at ({self.x:.2f}, {self.y:.2f}, {self.theta:.2f}) of the top speed"


STANDSTILL = Velocity(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Target:
    """A place to walk to, in the robot's frame: x and y in m, theta in rad."""

    x: float
    y: float
    theta: float

    def __str__(self) -> str:
        return f"walking to ({self.x:.2f} m, {self.y:.2f} m, {self.theta:.2f} rad)"


@dataclass(frozen=True)
class FootStep:
    """The leg that moves, and where its foot goes in the frame of the other foot: x and y in m, theta in rad."""

    leg: str
    x: float
    y: float
    theta: float

    @property
    def place(self) -> Place:
        return Place(self.x, self.y, self.theta)

    def __str__(self) -> str:
        return f"the step of {self.leg} by ({self.x:.3f} m, {self.y:.3f} m, {self.theta:.2f} rad)"


def read_velocity(twist: Any) -> tuple[Velocity, str]:
    """The velocity of a geometry_msgs/Twist, and in words which of its parts were clamped to -1..1 (empty: none).

    Raises BadGoal if a part is not a finite number.
    """
    clamped = []
    values = []
    for name, value in (("linear.x", twist.linear.x), ("linear.y", twist.linear.y), ("angular.z", twist.angular.z)):
        if not math.isfinite(value):
            raise BadGoal(name, value, "-1 to 1")
        if abs(value) > 1.0:
            clamped.append(f"{name} is {value:g}, taken as {math.copysign(1.0, value):g}")
        values.append(max(-1.0, min(1.0, value)))
    return Velocity(*values), ", ".join(clamped)


def read_target(pose: Any) -> Target:
    """The target of a geometry_msgs/Pose2D. Raises BadGoal if a part is out of its bounds."""
    return Target(*_pose(pose))


def read_step(step: Any, field: str = "") -> FootStep:
    """The step of a nao_library_msgs/StepTarget; `field` is where it stands in a goal, for texts.

    Raises BadGoal if it names no leg, or a part is out of its bounds.
    """
    if step.leg not in LEGS:
        raise BadGoal(f"{field}leg", step.leg, "0 (right) or 1 (left)")
    return FootStep(LEGS[step.leg], *_pose(step.pose, field))


def require_way(field: str, way: Place) -> Place:
    """The way to a target, seen from the robot. Raises BadGoal if it is too far."""
    if not way.distance <= WAY.highest:
        raise BadGoal(field, f"{way.distance:g} m away", f"up to {WAY.highest:g} m from the robot")
    return way


def read_gait_config(name: str, value: Any) -> GaitConfig:
    """Gait parameters from pairs of name and value, or a dictionary. Names and ranges are the robot's to judge.

    Raises NaoError if it is something else; `name` is the parameter's, for its text.
    """
    pairs = list(value.items()) if isinstance(value, Mapping) else value
    if not isinstance(pairs, (list, tuple)):
        raise NaoError(f"{name} is {value!r}: {FORM}")
    config: GaitConfig = []
    for pair in pairs:
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not isinstance(pair[0], str):
            raise NaoError(f"{name} has the entry {pair!r}: {FORM}")
        key, number = pair
        config.append([key, number_parameter(f"{name}: {key}", number, limit("setting"))])
    return config


def _pose(pose: Any, field: str = "") -> tuple[float, float, float]:
    for name, limit_ in (("x", WAY), ("y", WAY), ("theta", ANGLE)):
        require_within(f"{field}pose.{name}", getattr(pose, name), limit_)
    return float(pose.x), float(pose.y), float(pose.theta)
