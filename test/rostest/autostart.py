#!/usr/bin/env python3
"""A module with `launchpath` and `autostart` starts what it needs by itself, and takes it along when it ends."""

import os
import signal
import subprocess
import sys
import unittest

import actionlib
import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import send, wait_until

PORT = os.environ.get("NAO_PORT", "9559")
MODULE = """
import rospy
import rostest
from nao_library_modules.lights import NaoLights
rospy.init_node("self_starter")
NaoLights("127.0.0.1", {port}, autostart=True, launchpath=("nao_library_tests", "simulator_only.launch"))
rospy.spin()
"""
HALF = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])


class Autostart(unittest.TestCase):
    def test_the_module_starts_its_launch_file_and_stops_it(self):
        module = subprocess.Popen([sys.executable, "-c", MODULE.format(port=PORT)])
        self.addCleanup(module.kill)
        client = actionlib.SimpleActionClient("NaoLights", NaoLedAction)
        self.assertTrue(client.wait_for_server(Duration(60)))
        wait_until(lambda: send(client, NaoLedGoal([HALF])).wait().state == GoalStatus.SUCCEEDED, 60.0, "a simulator")
        self.assertIn("/nao_sim", rosnode.get_node_names())
        module.send_signal(signal.SIGINT)
        self.assertEqual(module.wait(60.0), 0)
        wait_until(lambda: not rosnode.rosnode_ping("/nao_sim", max_count=1), 60.0, "the end of the simulator")


if __name__ == "__main__":
    rospy.init_node("autostart_test")
    rostest.rosrun("nao_library_tests", "autostart", Autostart)
