#!/usr/bin/env python3
"""The robot is late, dies in the middle of a goal, and comes back: goals abort clearly, the node goes on."""

import signal
import sys
import unittest
from pathlib import Path

import actionlib
import rosgraph
import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from mortal_simulator import PORT, MortalSimulator  # noqa: E402

HALF = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])
BRAIN0 = "Device/SubDeviceList/Head/Led/Front/Right/1/Actuator/Value"
LONG = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=100.0)


class LostRobot(MortalSimulator, unittest.TestCase):
    def setUp(self):
        self.addCleanup(self.kill)
        self.level = None
        # One subscriber that stays: a new one each time would see whichever of the many nodes speaks first.
        diagnostics = rospy.Subscriber("/diagnostics", DiagnosticArray, self.read_level)
        self.addCleanup(diagnostics.unregister)
        self.client = actionlib.SimpleActionClient("NaoLights", NaoLedAction)
        self.assertTrue(self.client.wait_for_server(Duration(60)))

    def play(self, *functions):
        return send(self.client, NaoLedGoal(list(functions)))

    def wait_until_it_works(self):
        wait_until(lambda: self.play(HALF).wait().state == GoalStatus.SUCCEEDED, 60.0, "a goal that succeeds")

    def wait_for_the_fade(self):
        """Until the robot has begun to fade: the light is a little darker than HALF."""
        memory = ALProxy("ALMemory", "127.0.0.1", PORT)
        wait_until(lambda: 0.4 < memory.getData(BRAIN0) < 0.4999, 60.0, "the fade")

    def read_level(self, message):
        for status in message.status:
            if status.name.endswith("NaoLights robot"):
                self.level = status.level

    def wait_for_level(self, level):
        self.level = None
        wait_until(lambda: self.level == level, 60.0, f"level {level!r} on /diagnostics")

    def test_robot_that_is_late_dies_and_comes_back(self):
        early = self.play(HALF).wait()
        self.assertEqual(early.state, GoalStatus.ABORTED)
        self.assertIn(str(PORT), early.text)
        node = rosnode.get_api_uri(rosgraph.Master("/lost_robot_test"), "/NaoLights")
        self.wait_for_level(DiagnosticStatus.ERROR)

        self.start()
        self.wait_until_it_works()
        self.wait_for_level(DiagnosticStatus.OK)

        for stop in (signal.SIGKILL, signal.SIGSTOP):
            run = self.play(HALF, LONG)
            self.wait_for_the_fade()
            self.simulator.send_signal(stop)
            if stop == signal.SIGSTOP:  # the robot is silent, and only then lost
                self.wait_for_level(DiagnosticStatus.WARN)
                self.assertTrue(run.running)
            run.wait(60.0)
            self.assertEqual("silent" in run.text, stop == signal.SIGSTOP, run.text)
            self.assertEqual(run.state, GoalStatus.ABORTED, stop)
            # Of the waiting call and of the connection, whichever notices first says it.
            self.assertRegex(run.text, rf"function 2 \(fade\): .*127.0.0.1:{PORT}.*(connection broke|went away)")
            done, lost = run.result.results
            self.assertEqual((done.function, done.error, lost.function), ("setIntensity", "", "fade"))
            self.assertIn(lost.error, run.text)
            if stop == signal.SIGSTOP:  # the dead one is started again at once
                self.wait_for_level(DiagnosticStatus.ERROR)
            self.kill()
            self.start()
            self.wait_until_it_works()
            self.wait_for_level(DiagnosticStatus.OK)
        self.assertEqual(rosnode.get_api_uri(rosgraph.Master("/lost_robot_test"), "/NaoLights"), node)


if __name__ == "__main__":
    rospy.init_node("lost_robot_test")
    rostest.rosrun("nao_library_tests", "lost_robot", LostRobot)
