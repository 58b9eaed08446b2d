#!/usr/bin/env python3
"""A new module: a function table, an action server and execute_cb. This one speaks to ALSystem.

A goal for it may hold LedFunction(function="setRobotName", str_param="Ada"). A module may define an action and a
function message of its own; this one borrows those of the lights. The memory functions (getData, ...) come with
NaoBasic, and so do `autostart` and `launchpath`.

With `self.serve("NaoSystem", NaoLedAction)` in place of the server and of execute_cb, goals are also checked as a whole
before anything runs, and have feedback, results of each function, failure policies, and a description.
"""

from __future__ import annotations

import sys
from typing import Any

import actionlib

from nao_library_actions.msg import NaoLedAction, NaoLedGoal, NaoLedResult
from nao_library_modules.answers import values_of
from nao_library_modules.errors import BadGoal, Preempted
from nao_library_modules.nao_basic import NaoBasic
from nao_library_modules.node import run_module
from naoqi.errors import NaoError


class NaoSystem(NaoBasic):
    """Names and versions of the robot. ROS API: action `NaoSystem` (nao_library_actions/NaoLedAction)."""

    def __init__(self, ip: str, port: int, *more: Any, **options: Any) -> None:
        """Fill the table, then start the server."""
        super().__init__(ip, port, *more, **options)
        self.function_table = {
            "robotName": self.robot_name,
            "setRobotName": self.set_robot_name,
            "systemVersion": self.system_version,
        }
        self.server = actionlib.SimpleActionServer("NaoSystem", NaoLedAction, self.execute_cb, auto_start=False)
        self.server.start()

    def execute_cb(self, goal: NaoLedGoal) -> None:
        """Carry out a goal: run its functions one after the other; a new goal or a cancel ends the one that runs."""
        result = NaoLedResult()
        try:
            for message in goal.functions:
                answer = self.run(message.function, self.args_of(message), message.time)
                result.memList += values_of(answer)
        except Preempted:
            self.server.set_preempted(result)
        except NaoError as error:
            self.server.set_aborted(result, str(error))
        else:
            self.server.set_succeeded(result)

    def robot_name(self) -> str:
        """The name of the robot."""
        return self.call(self.robot.proxy("ALSystem"), "robotName")

    def set_robot_name(self, str_param: str) -> None:
        """Give the robot a name. A parameter is a field of the message; `*args` stands for all in their order."""
        if not str_param.isalnum():
            raise BadGoal("str_param", str_param, "a name of letters and digits")
        self.call(self.robot.proxy("ALSystem"), "setRobotName", str_param)

    def system_version(self) -> str:
        """The version of the robot's software."""
        return self.call(self.robot.proxy("ALSystem"), "systemVersion")


if __name__ == "__main__":
    sys.exit(run_module(NaoSystem, "nao_system", __doc__))
