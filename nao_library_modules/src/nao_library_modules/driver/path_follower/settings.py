"""Parameters of nao_path_follower, checked. No ROS."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

from naoqi.errors import NaoError

from ...base.field_checks import number_parameter
from ...base.limits import limit


@dataclass(frozen=True)
class FollowerSettings:
    """How a robot follows targets and paths; the names are those of the parameters.

    Raises NaoError with the first value that will not do.
    """

    controller_frequency: float = 10.0  # rounds a second, Hz
    target_distance_threshold: float = 0.05  # the target is reached this near, m
    target_angle_threshold: float = math.radians(5.0)  # and this well turned, rad
    waypoint_distance_threshold: float = 0.1  # off a path by more, the robot is not on a straight piece, m
    waypoint_angle_threshold: float = math.radians(45.0)  # turned away from a path by more, it first turns, rad
    # Velocity mode: shares of the robot's top speed, above 0 to 1.
    max_vel_x: float = 0.7
    max_vel_y: float = 0.7
    max_vel_yaw: float = 0.7
    # Velocity mode: step frequency that nao_walker walks with (its ~step_frequency), 0 (slow) to 1. By it the robot
    # gets so far in a round, and so has to be so slow to meet its target.
    step_freq: float = 0.5
    use_vel_ctrl: bool = False  # the robot is led by velocities (`cmd_vel`) and not by poses (`cmd_pose`)
    use_foot_contact_protection: bool = True  # a robot that is lifted gives its goal up
    path_next_target_distance: float = 0.1  # how far ahead on a path the robot aims, m
    path_max_start_distance: float = 0.3  # how far from the beginning of a path it may stand, m
    threshold_damp_xy: float = 0.2  # velocity mode: this near to the target it gets slower, m
    threshold_damp_yaw: float = math.radians(60.0)  # likewise for turning, rad
    straight_threshold: float = 0.2  # a piece of a path that is straight for this long is walked at full speed, m
    straight_offset: float = 0.3  # there the robot aims this far ahead, m
    straight_max_path_dev: float = 0.03  # and straight means this near to a line, m
    straight_max_robot_dev: float = 0.05  # with the robot this near to it, m
    straight_max_robot_yaw: float = math.radians(20.0)  # and turned away from it by no more than this, rad
    stuck_time: float = 10.0  # without any progress for so long the robot gives up, s; 0: never

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            _check(name, getattr(self, name))

    @classmethod
    def read(cls, get_param: Callable[[str, Any], Any]) -> FollowerSettings:
        """Settings from private parameters; `get_param` takes name and default."""
        return cls(**{field.name: get_param(f"~{field.name}", field.default) for field in fields(cls)})


_KINDS = {
    **dict.fromkeys(("max_vel_x", "max_vel_y", "max_vel_yaw"), "fraction"),
    "step_freq": "share",
    "stuck_time": "timeout",
    "controller_frequency": "reading rate",
}
_SWITCHES = ("use_vel_ctrl", "use_foot_contact_protection")


def _check(name: str, value: Any) -> None:
    if name in _SWITCHES:
        if not isinstance(value, bool):
            raise NaoError(f"~{name} is {value!r}: true or false")
        return
    kind = _KINDS.get(name, "setting")
    number_parameter(f"~{name}", value, limit(kind))
    if kind == "setting" and value <= 0.0:
        raise NaoError(f"~{name} is {value:g}: above 0")
