#!/usr/bin/env python3
"""The LED listings of the nao_library paper through the real stack, NAOqi's way and nao_library's.

The paper prints the goal's type as LedGoal; here the action is NaoLed, so it is NaoLedGoal.
"""

import unittest

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from PIL import Image
from rospy import Duration

import nao_library_actions.msg
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send
from naoqi import ALProxy

EYES = [
    f"Face/Led/{color}/{side}/{angle}Deg"
    for color in ("Red", "Green", "Blue")
    for side in ("Left", "Right")
    for angle in range(0, 360, 45)
]
GREEN = {device: float("Green" in device) for device in EYES}
WHITE = {device: 1.0 for device in EYES}
BRAIN0 = "Device/SubDeviceList/Head/Led/Front/Right/1/Actuator/Value"


def green_pixels(path):
    red, green, blue = (np.asarray(Image.open(path).convert("RGB"))[:, :, i].astype(int) for i in range(3))
    return int(((green > 150) & (green > 1.6 * red) & (green > 1.6 * blue)).sum())


class PaperListings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.led_client = cls.robot.action_client("NaoLights", nao_library_actions.msg.NaoLedAction)
        cls.leds_proxy = ALProxy("ALLeds", "127.0.0.1", cls.robot.port)
        cls.memory_proxy = ALProxy("ALMemory", "127.0.0.1", cls.robot.port)

    def setUp(self):
        self.robot.reset()

    def test_one_light_at_half_intensity(self):
        brain_half = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])
        run = send(self.led_client, nao_library_actions.msg.NaoLedGoal([brain_half])).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED)
        self.assertEqual(self.memory_proxy.getData(BRAIN0), 0.5)
        self.assertEqual(list(zip(run.result.lights, run.result.intensities)), [("Brain0", 0.5)])

    def test_one_light_at_half_intensity_by_naoqi(self):
        self.leds_proxy.setIntensity("Brain0", 0.5)
        self.assertEqual(self.memory_proxy.getData(BRAIN0), 0.5)

    def test_both_eyes_green_by_naoqi(self):
        self.leds_proxy.setIntensity("LeftFaceLedsRed", 0)
        self.leds_proxy.setIntensity("RightFaceLedsRed", 0)
        self.leds_proxy.setIntensity("LeftFaceLedsGreen", 1)
        self.leds_proxy.setIntensity("RightFaceLedsGreen", 1)
        self.leds_proxy.setIntensity("LeftFaceLedsBlue", 0)
        self.leds_proxy.setIntensity("RightFaceLedsBlue", 0)
        self.assertEqual(self.robot.leds(GREEN), GREEN)

    def test_both_eyes_green(self):
        self.assertLess(green_pixels(self.robot.picture("front", "white_eyes.png")), 20)
        green_eyes = LedFunction(function="setColor", lights=["LeftFaceLeds", "RightFaceLeds"], i_values=[0, 1, 0])
        led_goal = nao_library_actions.msg.NaoLedGoal([green_eyes])
        self.led_client.send_goal(led_goal)
        self.assertTrue(self.led_client.wait_for_result(Duration(60)))
        self.assertEqual(self.led_client.get_state(), GoalStatus.SUCCEEDED)
        self.assertEqual(self.robot.leds(GREEN), GREEN)
        self.assertGreater(green_pixels(self.robot.picture("front", "green_eyes.png")), 150)

    def test_green_eyes_go_back_after_two_seconds(self):
        green_eyes = LedFunction(
            function="setColor",
            lights=["LeftFaceLeds", "RightFaceLeds"],
            i_values=[0, 1, 0],
            time=Duration(2),
            revert=True,
        )
        with self.robot.at_speed(0.5):
            run = send(self.led_client, nao_library_actions.msg.NaoLedGoal([green_eyes]))
            self.robot.wait_for_leds(GREEN)
            run.wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED)
        self.assertEqual(self.robot.leds(WHITE), WHITE)
        self.assertAlmostEqual(run.ended - run.sent, 2.0, delta=0.3)

    def test_clients_wait_for_the_server_as_in_the_paper(self):
        lights = actionlib.SimpleActionClient("NaoLights", nao_library_actions.msg.NaoLedAction)
        self.assertTrue(lights.wait_for_server(Duration(60)))


if __name__ == "__main__":
    rospy.init_node("paper_listings_test")
    rostest.rosrun("nao_library_tests", "paper_listings", PaperListings)
