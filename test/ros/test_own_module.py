#!/usr/bin/env python3
"""A module with an action server and an execute_cb of its own, as the example has them."""

import os
import subprocess
import sys
from pathlib import Path

import rospkg
import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal, NaoLedAction
from nao_library_msgs.msg import BehaviorFunction, LedFunction
from nao_library_msgs.srv import DescribeFunctions, DescribeFunctionsRequest
from nao_sim_bridge.testing import RobotTestCase, send, wait_until

MODULE = Path(rospkg.RosPack().get_path("nao_library_modules")) / "examples" / "add_a_module.py"


def f(function, text="", **fields):
    return LedFunction(function=function, str_param=text, **fields)


FUNCTION = MODULE.with_name("add_a_function.py")


class OwnFunction(RobotTestCase):
    server = ("NaoLights", NaoLedAction)
    respawned = ("NaoLights",)

    def test_a_server_of_ones_own_takes_the_place_of_ours_and_ours_comes_back_afterwards(self):
        own = subprocess.Popen([sys.executable, str(FUNCTION), "--pport", os.environ["NAO_PORT"]])
        self.addCleanup(own.kill)
        wait_until(lambda: self.knows_blink() is True, 60.0, "the server with one function more")
        ran = self.behave("{NaoLights.blink: {lights: [FaceLeds], times: [0.1, 0.1]}}").wait()
        self.assertEqual((ran.state, ran.text), (GoalStatus.SUCCEEDED, ""))
        refused = self.behave("{NaoLights.blink: {lights: [Eyes], times: [-1]}}").wait()
        self.assertIn("field times", refused.text)
        own.terminate()
        own.wait()
        wait_until(lambda: self.knows_blink() is False, 60.0, "the server of the launch file")
        self.client = self.robot.action_client(*self.server)  # one that knows the server that has just come
        self.succeed(f("on", lights=["Eyes"]))

    def behave(self, step):
        goal = NaoBehaviorGoal([BehaviorFunction(function="runBehavior", text=f"help: x\ndo: [{step}]")])
        client = SimpleActionClient("NaoBehavior", NaoBehaviorAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(60)))
        return send(client, goal)

    def knows_blink(self):
        """Whether the server that runs has the function; None while there is none."""
        try:
            service = rospy.ServiceProxy("NaoLights/describe", DescribeFunctions)
            return not service(DescribeFunctionsRequest(functions=["blink"])).unknown
        except rospy.ServiceException:
            return None


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
        wait_until(lambda: self.robot.module("ALMemory").getDataList(name), 60.0, "the goal")
        self.succeed(f("systemVersion"))
        self.ends(run, GoalStatus.PREEMPTED)
