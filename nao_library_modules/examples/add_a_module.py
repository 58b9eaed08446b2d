#!/usr/bin/env python3
"""A new module: a class with a function table and an action server. This one speaks to ALSystem.

A goal for it may hold LedFunction(function="setRobotName", str_param="Ada"). A module may define an action
and a function message of its own; the fields `function`, `time` and `str_param` are all that this one needs,
so it borrows those of the lights. The memory functions (getData, ...) come with NaoBasic.
"""

from __future__ import annotations

import sys
from typing import Any

from nao_library_actions.msg import NaoLedAction
from nao_library_modules.errors import BadGoal
from nao_library_modules.function_chain import checked_by
from nao_library_modules.nao_basic import NaoBasic
from nao_library_modules.node import run_module


def check_name(_self: NaoSystem, str_param: str) -> None:
    """Refuses a name before anything of the chain runs."""
    if not str_param.isalnum():
        raise BadGoal("str_param", str_param, "a name of letters and digits")


class NaoSystem(NaoBasic):
    """Names and versions of the robot. ROS API: action `NaoSystem` (nao_library_actions/NaoLedAction)."""

    def __init__(self, ip: str, port: int, **options: Any) -> None:
        """Fill the table, then serve."""
        super().__init__(ip, port, **options)
        self.function_table.update(
            robotName=self.robot_name,
            setRobotName=self.set_robot_name,
            systemVersion=self.system_version,
        )
        self.serve("NaoSystem", NaoLedAction)

    def robot_name(self) -> str:
        """The name of the robot; what a function returns is in memList of the result."""
        return self.call(self.robot.proxy("ALSystem"), "robotName")

    @checked_by(check_name)
    def set_robot_name(self, str_param: str) -> None:
        """Give the robot a name. Parameters are fields of the function message."""
        self.call(self.robot.proxy("ALSystem"), "setRobotName", str_param)

    def system_version(self) -> str:
        """The version of the robot's software."""
        return self.call(self.robot.proxy("ALSystem"), "systemVersion")


if __name__ == "__main__":
    sys.exit(run_module(NaoSystem, "nao_system", __doc__))
