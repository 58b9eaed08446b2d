"""Motion functions that tell about the walk, and how the arms take part in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..functions.chain import checked_by
from .gait import DEFAULT
from .walk_checks import WalkBase, check_arms, check_config, check_distance
from .walk_plan import ARMS


class WalkState(WalkBase):
    """Functions of ALMotion about the walk. Parameters are fields of MotionFunction."""

    def walk_state_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "getRobotPosition": self.get_robot_position,
            "getNextRobotPosition": self.get_next_robot_position,
            "getRobotVelocity": self.get_robot_velocity,
            "getFootSteps": self.get_foot_steps,
            "moveIsActive": self.move_is_active,
            "getMoveConfig": self.get_move_config,
            "setOrthogonalSecurityDistance": self.set_orthogonal_security_distance,
            "getOrthogonalSecurityDistance": self.get_orthogonal_security_distance,
            "setTangentialSecurityDistance": self.set_tangential_security_distance,
            "getTangentialSecurityDistance": self.get_tangential_security_distance,
            "setMoveArmsEnabled": self.set_move_arms_enabled,
            "getMoveArmsEnabled": self.get_move_arms_enabled,
        }

    def get_robot_position(self, commanded: bool) -> list[float]:
        """Where the robot is in the world by its odometry: x, y (m), theta (rad)."""
        return list(self.motion("getRobotPosition", not commanded))

    def get_next_robot_position(self) -> list[float]:
        """Where the robot will be when the steps are done that can change no more: x, y (m), theta (rad)."""
        return list(self.motion("getNextRobotPosition"))

    def get_robot_velocity(self) -> list[float]:
        """How fast the robot walks: x, y (m/s), theta (rad/s)."""
        return list(self.motion("getRobotVelocity"))

    def get_foot_steps(self) -> list[Any]:
        """Where the feet are in the world, and the steps that are planned: those that are begun, then the others."""
        return list(self.motion("getFootSteps"))

    def move_is_active(self) -> bool:
        """Whether the robot walks."""
        return bool(self.motion("moveIsActive"))

    @checked_by(check_config)
    def get_move_config(self, str_param: str) -> list[list[Any]]:
        """Names and values of the parameters of a walk: Default, Min or Max."""
        return [list(pair) for pair in self.motion("getMoveConfig", str_param or DEFAULT)]

    @checked_by(check_distance)
    def set_orthogonal_security_distance(self, values: Sequence[float]) -> None:
        """How near (m) a walk comes to an obstacle ahead, at full speed."""
        self.motion("setOrthogonalSecurityDistance", values[0])

    def get_orthogonal_security_distance(self) -> float:
        """How near (m) a walk comes to an obstacle ahead, at full speed."""
        return float(self.motion("getOrthogonalSecurityDistance"))

    @checked_by(check_distance)
    def set_tangential_security_distance(self, values: Sequence[float]) -> None:
        """How near (m) walk and arms come to any obstacle."""
        self.motion("setTangentialSecurityDistance", values[0])

    def get_tangential_security_distance(self) -> float:
        """How near (m) walk and arms come to any obstacle."""
        return float(self.motion("getTangentialSecurityDistance"))

    @checked_by(check_arms)
    def set_move_arms_enabled(self, names: Sequence[str], enable: bool) -> None:
        """Let arms swing while the robot walks, or stop it; both if none is named."""
        wanted = _arms(names)
        swing = [enable if arm in wanted else bool(self.motion("getMoveArmsEnabled", arm)) for arm in ARMS]
        self.motion("setMoveArmsEnabled", *swing)

    @checked_by(check_arms)
    def get_move_arms_enabled(self, names: Sequence[str]) -> list[bool]:
        """Whether arms swing while the robot walks; both if none is named."""
        return [bool(self.motion("getMoveArmsEnabled", arm)) for arm in ARMS if arm in _arms(names)]


def _arms(names: Sequence[str]) -> Sequence[str]:
    return ARMS if not names or "Arms" in names else names
