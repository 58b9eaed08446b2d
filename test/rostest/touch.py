#!/usr/bin/env python3
"""A hand, a click, a stroke and a wall, as a program hears of them that is written for the robot maker's SDK."""

import os
import queue
import sys
import unittest
from pathlib import Path

import rospy
import rostest

from nao_library_msgs.srv import ReleaseSensors, TouchSensors
from nao_sim_bridge.testing import SimulatedRobot
from naoqi import ALBroker, ALModule, ALProxy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from services import service  # noqa: E402

PORT = int(os.environ.get("NAO_PORT", "9559"))
PATIENCE = 20.0
HEAD = ["Head/Touch/Front", "Head/Touch/Middle", "Head/Touch/Rear"]
WALL = "{name: wall, box: [0.1, 3, 2], position: [0.45, 0, 1]}"
LEFT = "Device/SubDeviceList/US/Left/Sensor/Value"
heard = queue.Queue()


class Listener(ALModule):
    """Hands what it hears to the test."""

    def on_event(self, name, value, _message):
        """Any event."""
        heard.put((name, value))


class Touch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.robot.pause()
        cls.broker = ALBroker("touch_test", "127.0.0.1", 0, "127.0.0.1", PORT)
        global touch_listener  # the SDK looks for a global variable of the module's name
        touch_listener = Listener("touch_listener")
        cls.memory = ALProxy("ALMemory", "127.0.0.1", PORT)
        cls.touch = service("nao_sim/touch", TouchSensors, PATIENCE)
        cls.release = service("nao_sim/release", ReleaseSensors, PATIENCE)

    @classmethod
    def tearDownClass(cls):
        cls.broker.shutdown()

    def setUp(self):
        self.robot.reset()
        self.robot.module("ALMotion").setStiffnesses("Body", 1.0)
        self.robot.advance(0.3)
        self.subscribed = []

    def tearDown(self):
        self.leave()

    def listen(self, *events):
        for event in events:
            self.memory.subscribeToEvent(event, "touch_listener", "on_event")
            self.subscribed.append(event)

    def leave(self):
        while self.subscribed:
            self.memory.unsubscribeToEvent(self.subscribed.pop(), "touch_listener")

    def hear(self, count):
        """The next events."""
        return [heard.get(timeout=PATIENCE) for _ in range(count)]

    def good(self, answer):
        self.assertEqual((answer.success, answer.message), (True, ""))

    def test_a_hand_touches_the_head_until_it_is_released(self):
        self.listen("FrontTactilTouched", "TouchChanged")
        height = self.robot.true_pose().position.z
        self.good(self.touch(sensors=["FrontTactilTouched"]))
        self.robot.advance(1.0)
        self.assertEqual(
            dict(self.hear(2)), {"FrontTactilTouched": 1.0, "TouchChanged": [["Head", True], [HEAD[0], True]]}
        )
        self.assertEqual(self.robot.module("ALTouch").getStatus()[0], ["Head", True])
        self.good(self.release())
        self.robot.advance(0.5)
        self.assertEqual(dict(self.hear(2))["FrontTactilTouched"], 0.0)
        self.assertAlmostEqual(self.robot.true_pose().position.z, height, delta=0.005)

    def test_two_clicks_of_the_chest_button_are_a_double_click(self):
        self.listen("ALChestButton/DoubleClickOccurred", "ALChestButton/SimpleClickOccurred")
        for _ in range(2):
            self.robot.press(["ChestBoard/Button"])
            self.robot.advance(0.1)
            self.robot.press([])
            self.robot.advance(0.2)
        self.robot.advance(0.5)
        self.assertEqual(self.hear(1), [("ALChestButton/DoubleClickOccurred", None)])

    def test_a_stroke_over_the_head_is_a_caress(self):
        self.listen("ALTactileGesture/Gesture", "ALTactileGesture/Release")
        self.good(self.touch(sensors=HEAD, time=rospy.Duration(0.6)))
        self.robot.advance(1.5)
        self.assertEqual(self.hear(2), [("ALTactileGesture/Gesture", "CaressFtoR"), ("ALTactileGesture/Release", 1)])

    def test_a_service_that_waits_answers_when_the_hand_has_gone(self):
        self.robot.resume()
        try:
            self.good(self.touch(sensors=["LFoot/Bumper/Left"], time=rospy.Duration(0.2), wait=True))
        finally:
            self.robot.pause()
        self.assertEqual(self.robot.value("LeftBumperPressed"), 0.0)
        self.assertEqual([v for v, _, _ in self.memory.getEventHistory("LeftBumperPressed")][-2:], [1.0, 0.0])

    def test_a_wall_is_detected_on_both_sides_while_somebody_listens(self):
        self.robot.module("NaoSimulation").placeObject(WALL)
        self.listen("SonarLeftDetected", "SonarRightDetected")  # which has the sonars fire, too
        self.robot.advance(0.12)
        for name, distance in self.hear(2):
            self.assertIn(name, ("SonarLeftDetected", "SonarRightDetected"))
            self.assertAlmostEqual(distance, 0.4, delta=0.02)
        self.leave()
        self.robot.module("NaoSimulation").removeObject("wall")
        self.robot.advance(1.0)
        self.assertAlmostEqual(self.robot.value(LEFT), 0.4, delta=0.02, msg="it keeps what was measured last")
        sonar = ALProxy("ALSonar", "127.0.0.1", PORT)
        sonar.subscribe("touch_test")
        self.robot.advance(0.12)
        sonar.unsubscribe("touch_test")
        self.assertEqual(self.robot.value(LEFT), 5.0, "there is nothing")
        self.assertTrue(heard.empty())

    def test_errors_say_what_is_wrong(self):
        for request, text in (
            (dict(sensors=["nose"]), "unknown touch sensor 'nose'"),
            (dict(sensors=[HEAD[0], "ChestBoard/Button"], time=rospy.Duration(1)), "sensors of one part of the robot"),
            (dict(sensors=HEAD), "above 0 for a stroke"),
        ):
            answer = self.touch(**request)
            self.assertFalse(answer.success)
            self.assertIn(text, answer.message)


if __name__ == "__main__":
    rospy.init_node("touch_test")
    rostest.rosrun("nao_library_tests", "touch", Touch)
