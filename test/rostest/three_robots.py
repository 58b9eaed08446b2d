#!/usr/bin/env python3
"""Three robots in one simulated world: names, nodes and time; each server has its robot."""

import subprocess
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
import yaml
from actionlib_msgs.msg import GoalStatus
from nav_msgs.msg import Odometry

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send

LIMIT = 60.0


class ThreeRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robots = [SimulatedRobot(f"/nao{number}", world="") for number in (1, 2, 3)]

    def setUp(self):
        self.robots[0].reset()

    def test_each_has_its_port_its_true_pose_and_its_services_and_one_node_tells_the_time(self):
        ports = [robot.port for robot in self.robots]
        self.assertEqual(ports, [ports[0], ports[0] + 1, ports[0] + 2])
        places = [robot.true_pose().position for robot in self.robots]
        np.testing.assert_allclose([(p.x, p.y) for p in places], [(0, 0), (0.9, 0.35), (0.42, -0.12)], atol=0.03)
        message = rospy.wait_for_message("/nao3/ground_truth/odom", Odometry, timeout=LIMIT)
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("world", "nao3/torso"))
        publishers, _, services = rosgraph.Master("/three_robots_test").getSystemState()
        clocks = [nodes for topic, nodes in publishers if topic == "/clock"]
        self.assertEqual(clocks, [["/nao_sim"]])
        names = {name for name, _ in services}
        self.assertLessEqual({"/nao_sim/place_object", "/nao_sim/reset", "/nao2/nao_sim/push"}, names)
        self.assertNotIn("/nao2/nao_sim/place_object", names)

    def test_the_launch_file_starts_the_whole_stack_for_each_robot(self):
        nodes = set(launched("--nodes", "robots:=3").split()) - {"/nao_sim"}
        stack = {node[len("/nao1") :] for node in nodes if node.startswith("/nao1/")}
        self.assertEqual(nodes, {f"/nao{number}{node}" for number in (1, 2, 3) for node in stack})
        self.assertLessEqual({"/NaoLights", "/NaoMotion", "/nao_driver", "/robot_state_publisher"}, stack)
        parameters = yaml.safe_load(launched("--dump-params", "robots:=3", "nao_port:=4000"))
        for number in (1, 2, 3):
            ports = {v for n, v in parameters.items() if n.startswith(f"/nao{number}/") and n.endswith("/pport")}
            self.assertEqual(ports, {4000 + number - 1})
            self.assertEqual(parameters[f"/nao{number}/tf_prefix"], f"nao{number}")

    def test_each_server_has_the_robot_of_its_namespace(self):
        lights = self.robots[1].action_client("NaoLights", NaoLedAction)
        goal = NaoLedGoal([LedFunction(function="setColor", lights=["FaceLeds"], str_param="red")])
        run = send(lights, goal).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        green = "Face/Led/Green/Left/0Deg"
        self.assertEqual([robot.led(green) for robot in self.robots], [1.0, 0.0, 1.0])


def launched(question, *arguments):
    """What roslaunch answers about the launch file."""
    command = ["roslaunch", question, "nao_library", "nao_sim.launch", *arguments]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, timeout=LIMIT).stdout


if __name__ == "__main__":
    rospy.init_node("three_robots_test")
    rostest.rosrun("nao_library_tests", "three_robots", ThreeRobots)
