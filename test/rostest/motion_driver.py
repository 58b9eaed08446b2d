#!/usr/bin/env python3
"""NaoMotion brings its driver, and goes through it."""

import os
import signal
import sys
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import (
    JointTrajectoryActionGoal,
    JointTrajectoryActionResult,
    NaoMotionAction,
    NaoMotionGoal,
)
from nao_library_modules.core.processes import launched_nodes
from nao_library_modules.motion.motion_server import DRIVER
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from examples_fixture import start  # noqa: E402
from goal_functions import motion  # noqa: E402
from news import News  # noqa: E402

LIMIT = 90.0


class MotionDriver(unittest.TestCase):
    def test_a_module_that_is_started_with_true_brings_its_driver(self):
        robot = SimulatedRobot()
        server = start("../nodes/nao_motion", "--pport", os.environ["NAO_PORT"], "__ns:=/own", "_autostart:=true")
        self.addCleanup(server.communicate, timeout=LIMIT)
        self.addCleanup(server.send_signal, signal.SIGINT)
        client = robot.action_client("own/NaoMotion", NaoMotionAction, limit=LIMIT)
        brought = launched_nodes(DRIVER, "", 0, "/own/")
        wait_until(lambda: brought <= set(rosnode.get_node_names()), LIMIT, "all nodes of the driver")
        rospy.wait_for_service("/own/wakeup", LIMIT)  # of the part that moves joints
        news = News()
        with news.messages("/own/joint_trajectory/result", JointTrajectoryActionResult) as ends:
            turn = motion("angleInterpolation", names=["HeadYaw"], angles=[0.3], times=[0.5], stiffness=1.0)
            run = send(client, NaoMotionGoal([turn])).wait(LIMIT)
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
            news.wait(lambda: ends, "the end of a goal at the driver that was brought")
        with news.messages("/own/joint_trajectory/goal", JointTrajectoryActionGoal) as goals:
            # Who listens to goals, as we do, is no driver.
            turn.angles, turn.times = [-1.0], [30.0]
            run = send(client, NaoMotionGoal([turn]))
            news.wait(lambda: goals, "a goal at the driver")
            controller = ServerProxy(rosgraph.Master("").lookupNode("/own/nao_driver"))
            os.kill(controller.getPid("")[2], signal.SIGKILL)
            run.wait(LIMIT)
            self.assertEqual(run.state, GoalStatus.ABORTED)
            self.assertIn("the driver has gone, and the goal with it", run.text)
            robot.module("ALMotion").killAll()
            turn.angles, turn.times = [0.2], [0.5]
            run = send(client, NaoMotionGoal([turn])).wait(LIMIT)
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)


if __name__ == "__main__":
    rospy.init_node("motion_driver_test")
    rostest.rosrun("nao_library_tests", "motion_driver", MotionDriver)
