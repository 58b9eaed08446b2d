#!/usr/bin/env python3
"""The public test fixture itself: what `reset` brings back, and what it says when something is missing."""

import unittest

import rospy
import rostest
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, StackNotReady, send, wait_until

BRAIN0 = "Head/Led/Front/Right/1"
HEAD = "Device/SubDeviceList/Head/Touch/Front/Sensor/Value"
WAIT = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5], time=Duration(1000))


class Fixture(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoLights", NaoLedAction)

    def setUp(self):
        self.robot.reset()

    def test_reset_brings_back_robot_lights_and_memory(self):
        start = self.robot.true_pose().position
        self.robot.module("ALMotion").wakeUp()
        self.assertTrue(self.robot.value("robotIsWakeUp"))
        self.robot.module("ALLeds").off("AllLeds")
        self.robot.press(["Head/Touch/Front"])
        self.robot.push((60.0, 0.0, 0.0), 0.1)
        self.robot.advance(1.0)
        self.assertEqual((self.robot.led(BRAIN0), self.robot.value(HEAD)), (0.0, 1.0))
        moved = self.robot.true_pose().position
        self.assertGreater(abs(moved.x - start.x) + abs(moved.z - start.z), 0.05)

        before = rospy.get_time()
        self.robot.reset()
        self.robot.advance(0.1)
        self.assertFalse(self.robot.value("robotIsWakeUp"))
        self.assertEqual((self.robot.led(BRAIN0), self.robot.value(HEAD)), (1.0, 0.0))
        again = self.robot.true_pose().position
        for axis in "xyz":
            self.assertAlmostEqual(getattr(again, axis), getattr(start, axis), delta=0.005)
        wait_until(lambda: rospy.get_time() > before, 10.0, "the time after the reset")

    def test_reset_in_the_middle_of_a_fade_ends_it(self):
        fade = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=100.0)
        run = send(self.client, NaoLedGoal([fade]))
        wait_until(lambda: self.robot.led(BRAIN0) < 1.0, 10.0, "the fade")
        self.robot.reset()
        run.wait(5.0)
        self.robot.advance(1.0)
        self.assertEqual(self.robot.led(BRAIN0), 1.0)

    def test_what_is_missing_is_named(self):
        with self.assertRaisesRegex(StackNotReady, "service /nowhere/nao_sim/advance"):
            SimulatedRobot("/nowhere", limit=0.3)
        with self.assertRaisesRegex(StackNotReady, "action server NaoLigths"):
            self.robot.action_client("NaoLigths", NaoLedAction, limit=0.3)
        with self.assertRaisesRegex(StackNotReady, f"LEDs: {BRAIN0} is 1.0, not 0.25"):
            self.robot.wait_for_leds({BRAIN0: 0.25}, limit=0.3)
        with self.assertRaisesRegex(ValueError, "torsoo"):
            self.robot.push((1.0, 0.0, 0.0), 0.1, link="torsoo")

    def test_a_goal_that_goes_on_or_ends_too_soon_is_told(self):
        run = send(self.client, NaoLedGoal([WAIT]))
        with self.assertRaisesRegex(StackNotReady, "result of the goal"):
            run.wait(0.3)
        run.cancel()
        run.wait(5.0)
        with self.assertRaisesRegex(StackNotReady, "ended before function 1 began: PREEMPTED"):
            run.wait_for_function(1)


if __name__ == "__main__":
    rospy.init_node("fixture_test")
    rostest.rosrun("nao_library_tests", "fixture", Fixture)
