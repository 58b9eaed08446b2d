#!/usr/bin/env python3
"""Two robots in two namespaces: what one is told does not touch the other, and one clock serves both."""

import unittest

import rosgraph
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send

BRAIN0 = "Head/Led/Front/Right/1"


class TwoRobots(unittest.TestCase):
    def test_goals_side_by_side_touch_their_own_robot_only(self):
        robots = [SimulatedRobot(f"/robot{i}") for i in (1, 2)]
        clients = [robot.action_client("NaoLights", NaoLedAction) for robot in robots]
        values = (0.25, 0.75)
        runs = [
            send(client, NaoLedGoal([LedFunction(function="fade", lights=["Brain0"], i_values=[v], duration=0.5)]))
            for client, v in zip(clients, values)
        ]
        for robot, run, value in zip(robots, runs, values):
            self.assertEqual(run.wait().state, GoalStatus.SUCCEEDED)
            self.assertAlmostEqual(robot.led(BRAIN0), value, delta=0.01)
        robots[0].module("ALMotion").wakeUp()
        heights = [robot.module("NaoSimulation").torsoPose()[2] for robot in robots]
        self.assertGreater(heights[0], 0.32)
        self.assertLess(heights[1], 0.25)

    def test_one_simulator_tells_the_time(self):
        SimulatedRobot("/robot2")
        publishers, _, _ = rosgraph.Master("/two_robots_test").getSystemState()
        clocks = [nodes for topic, nodes in publishers if topic == "/clock"]
        self.assertEqual(clocks, [["/robot1/nao_sim"]])


if __name__ == "__main__":
    rospy.init_node("two_robots_test")
    rostest.rosrun("nao_library_tests", "two_robots", TwoRobots)
