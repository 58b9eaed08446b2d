#!/usr/bin/env python3
"""A module with an action server and an execute_cb of its own, as the example has them."""

import os
import subprocess
import sys
from pathlib import Path

import rospkg
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import RobotTestCase, wait_until

MODULE = Path(rospkg.RosPack().get_path("nao_library_modules")) / "examples" / "add_a_module.py"


def f(function, text="", **fields):
    return LedFunction(function=function, str_param=text, **fields)


class OwnModule(RobotTestCase):
    server = ("NaoSystem", NaoLedAction)

    @classmethod
    def setUpClass(cls):
        module = subprocess.Popen([sys.executable, str(MODULE), "--pport", os.environ["NAO_PORT"]])
        cls.addClassCleanup(module.wait)
        cls.addClassCleanup(module.terminate)
        super().setUpClass()

    def test_a_goal_runs_its_functions_and_those_of_the_memory_until_one_is_refused(self):
        names = self.succeed(f("setRobotName", "Ada"), f("robotName"), f("insertData", "Mine=1"), f("getData", "Mine"))
        self.assertEqual(names.memList, ["Ada", "1"])
        run = self.ends(self.play(f("robotName"), f("setRobotName", "no name")), GoalStatus.ABORTED)
        self.assertIn("field str_param: 'no name' is not allowed: a name of letters and digits", run.text)
        self.assertEqual(run.result.memList, ["Ada"])
        self.assertIn("did you mean 'robotName'", self.refused(f("robotname")))

    def test_a_cancel_and_a_newer_goal_end_the_wait_of_the_one_before(self):
        run = self.send(f("robotName", time=Duration(10000)))
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        name = "Mine/Begun"
        run = self.send(f("insertData", f"{name}=1"), f("robotName", time=Duration(10000)))
        wait_until(lambda: self.robot.module("ALMemory").getDataList(name), 30.0, "the goal")
        self.succeed(f("systemVersion"))
        self.ends(run, GoalStatus.PREEMPTED)
