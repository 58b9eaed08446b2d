"""Motion functions that tell about the walk, and how the arms take part in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .body import BodyPart
from .facts import ARMS
from .fields import Commanded
from .gait import DEFAULT
from .walk_fields import Enable, SecurityDistance, SwingingArms, WalkLimits


class WalkState(BodyPart):
    def get_robot_position(self, commanded: Commanded) -> list[float]:
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

    def get_move_config(self, str_param: WalkLimits) -> list[list[Any]]:
        """Names and values of the parameters of a walk: Default, Min or Max."""
        return [list(pair) for pair in self.motion("getMoveConfig", str_param.strip() or DEFAULT)]

    def set_orthogonal_security_distance(self, values: SecurityDistance) -> None:
        """How near (m) a walk comes to an obstacle ahead, at full speed."""
        self.motion("setOrthogonalSecurityDistance", values[0])

    def get_orthogonal_security_distance(self) -> float:
        """How near (m) a walk comes to an obstacle ahead, at full speed."""
        return float(self.motion("getOrthogonalSecurityDistance"))

    def set_tangential_security_distance(self, values: SecurityDistance) -> None:
        """How near (m) walk and arms come to any obstacle."""
        self.motion("setTangentialSecurityDistance", values[0])

    def get_tangential_security_distance(self) -> float:
        """How near (m) walk and arms come to any obstacle."""
        return float(self.motion("getTangentialSecurityDistance"))

    def set_move_arms_enabled(self, names: SwingingArms, enable: Enable) -> None:
        """Let arms swing while the robot walks, or stop it; both if none is named."""
        wanted = _arms(names)
        swing = [enable if arm in wanted else bool(self.motion("getMoveArmsEnabled", arm)) for arm in ARMS]
        self.motion("setMoveArmsEnabled", *swing)

    def get_move_arms_enabled(self, names: SwingingArms) -> list[bool]:
        """Whether arms swing while the robot walks; both if none is named."""
        return [bool(self.motion("getMoveArmsEnabled", arm)) for arm in ARMS if arm in _arms(names)]

    functions = {
        "getRobotPosition": get_robot_position,
        "getNextRobotPosition": get_next_robot_position,
        "getRobotVelocity": get_robot_velocity,
        "getFootSteps": get_foot_steps,
        "moveIsActive": move_is_active,
        "getMoveConfig": get_move_config,
        "setOrthogonalSecurityDistance": set_orthogonal_security_distance,
        "getOrthogonalSecurityDistance": get_orthogonal_security_distance,
        "setTangentialSecurityDistance": set_tangential_security_distance,
        "getTangentialSecurityDistance": get_tangential_security_distance,
        "setMoveArmsEnabled": set_move_arms_enabled,
        "getMoveArmsEnabled": get_move_arms_enabled,
    }


def _arms(names: Sequence[str]) -> Sequence[str]:
    return ARMS if not names or "Arms" in names else names
