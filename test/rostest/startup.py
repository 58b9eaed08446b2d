#!/usr/bin/env python3
"""What a user types first: roslaunch brings all servers up within seconds, and every program explains itself."""

import os
import signal
import socket
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import rospkg
import rospy
import rostest

# All servers are to be ready within 5 s; a machine that does something else meanwhile gets twice that.
LIMIT = 10.0
CLIENT = """
import rospy
from nao_library_actions.msg import NaoLedAction
from nao_sim_bridge.testing import SimulatedRobot
rospy.init_node("startup_client")
SimulatedRobot().action_client("NaoLights", NaoLedAction)
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Startup(unittest.TestCase):
    def test_all_servers_are_ready_soon(self):
        ros_port, nao_port = free_port(), free_port()
        environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{ros_port}"}
        began = time.monotonic()
        launch = subprocess.Popen(
            ["roslaunch", "-p", str(ros_port), "nao_library", "nao_sim.launch", f"nao_port:={nao_port}"],
            env=environment,
            stdout=subprocess.DEVNULL,
        )
        self.addCleanup(self.stop, launch)
        # The client ends when every server has taken a goal that reached the robot.
        client = subprocess.run([sys.executable, "-c", CLIENT], env=environment, timeout=6 * LIMIT)
        took = time.monotonic() - began
        print(f"all servers ready after {took:.1f} s")
        self.assertEqual(client.returncode, 0)
        self.assertLess(took, LIMIT)

    @staticmethod
    def stop(launch):
        launch.send_signal(signal.SIGINT)
        launch.wait(30.0)

    def test_every_program_explains_itself(self):
        for package in ("nao_sim_bridge", "nao_library_modules"):
            for program in sorted((Path(rospkg.RosPack().get_path(package)) / "nodes").iterdir()):
                done = subprocess.run(
                    ["rosrun", package, program.name, "--help"], stdout=subprocess.PIPE, text=True, timeout=30
                )
                self.assertEqual(done.returncode, 0, program)
                self.assertIn("usage", done.stdout, program)

    def test_every_launch_argument_is_documented(self):
        folder = Path(rospkg.RosPack().get_path("nao_library")) / "launch"
        files = sorted(folder.glob("*.launch"))
        self.assertTrue(files)
        for file in files:
            for argument in ElementTree.parse(file).getroot().findall("arg"):
                self.assertTrue(argument.get("doc"), (file.name, argument.get("name")))


if __name__ == "__main__":
    rospy.init_node("startup_test")
    rostest.rosrun("nao_library_tests", "startup", Startup)
