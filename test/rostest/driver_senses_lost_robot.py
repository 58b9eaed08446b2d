#!/usr/bin/env python3
"""The robot is late, dies and comes back: what its senses say begins again, once, and everybody is told meanwhile."""

import sys
import unittest
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import Range

from nao_library_actions.msg import BlinkAction, BlinkGoal, RunBehaviorAction, RunBehaviorGoal
from nao_library_modules.ros.simple_action_client import SimpleActionClient
from nao_library_msgs.msg import ConnectionState, FloatStamped, TactileTouch
from nao_library_msgs.srv import GetMemory
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from mortal_simulator import LIMIT, PORT, MortalSimulator  # noqa: E402
from news import News, Reports  # noqa: E402

FRONT, CHARGE = "FrontTactilTouched", "Device/SubDeviceList/Battery/Charge/Sensor/Value"
ENDLESS = "nao_library/breathe"


class DriverSensesLostRobot(MortalSimulator, unittest.TestCase):
    def setUp(self):
        self.addCleanup(self.kill)
        self.news = News()
        self.states, self.touches, self.events, self.charges, self.ranges = [], [], [], [], []
        self.reports = Reports()
        self.news.subscribe("connection", ConnectionState, self.states.append)
        self.news.subscribe("tactile_touch", TactileTouch, lambda message: self.touches.append(message.state))
        self.news.subscribe(f"nao_memory/{FRONT}", FloatStamped, lambda message: self.events.append(message.data))
        self.news.subscribe(f"nao_memory/{CHARGE}", FloatStamped, self.charges.append)
        self.news.subscribe("nao_robot/sonar/left", Range, self.ranges.append)
        self.behaviors = SimpleActionClient("run_behavior", RunBehaviorAction)
        self.blink = SimpleActionClient("blink", BlinkAction)
        for client in (self.behaviors, self.blink):
            self.assertTrue(client.wait_for_server(rospy.Duration(LIMIT)))

    def wait_for_level(self, name, level):
        self.reports.wait(name, lambda status: status.level == level)

    def press(self, *sensors):
        ALProxy("NaoSimulation", "127.0.0.1", PORT).press(list(sensors))

    def wait_until_it_works(self):
        self.news.wait(lambda: self.states and self.states[-1].state == ConnectionState.CONNECTED, "a connection")
        for name in ("nao_tactile: touch", "nao_memory: memory", "nao_joint: HeadYaw"):
            self.wait_for_level(name, DiagnosticStatus.OK)
        for values in (self.charges, self.ranges):
            count = len(values)
            self.news.wait(lambda count=count, values=values: len(values) > count, "readings")
        self.news.wait(lambda: self.events[-1:] == [0.0], "how the head's sensor stands")
        self.touches.clear()
        self.events.clear()
        self.press("Head/Touch/Front")
        self.news.wait(lambda: self.touches and self.events, "a touch")
        self.press()
        self.news.wait(lambda: len(self.touches) == len(self.events) == 2, "the end of the touch")
        self.assertEqual((self.touches, self.events), ([1, 0], [1.0, 0.0]))

    def test_robot_that_is_late_dies_and_comes_back(self):
        early = send(self.behaviors, RunBehaviorGoal(ENDLESS)).wait(LIMIT)
        self.assertEqual(early.state, GoalStatus.ABORTED)
        self.assertIn(str(PORT), early.text)
        rospy.wait_for_service("nao_memory/get", LIMIT)
        self.assertIn(str(PORT), rospy.ServiceProxy("nao_memory/get", GetMemory)(CHARGE).message)
        for _ in range(2):
            self.start()
            self.wait_until_it_works()
            self.die_in_the_middle()

    def die_in_the_middle(self):
        motion = ALProxy("ALMotion", "127.0.0.1", PORT)
        motion.wakeUp()
        behavior = send(self.behaviors, RunBehaviorGoal(ENDLESS))
        manager = ALProxy("ALBehaviorManager", "127.0.0.1", PORT)
        wait_until(lambda: manager.isBehaviorRunning(ENDLESS), LIMIT, ENDLESS)
        blinking = BlinkGoal(blink_duration=rospy.Duration(0.2), blink_rate_mean=0.2)
        blinking.colors.append(blinking.bg_color)
        blinks = send(self.blink, blinking)
        wait_until(lambda: blinks.feedback and manager.ping(), LIMIT, "blinks")
        self.events.clear()
        self.kill()
        for run in (behavior, blinks):
            self.assertEqual(run.wait(LIMIT).state, GoalStatus.ABORTED)
            self.assertIn(f"127.0.0.1:{PORT}", run.text)
        self.news.wait(lambda: self.states[-1].state == ConnectionState.LOST, "the loss")
        self.assertTrue(self.states[-1].last_error)
        self.wait_for_level("nao_joint: HeadYaw", DiagnosticStatus.STALE)
        for name in ("nao_tactile: touch", "nao_sonar: sonars", "nao_memory: memory"):
            self.wait_for_level(name, DiagnosticStatus.ERROR)


if __name__ == "__main__":
    rospy.init_node("driver_senses_lost_robot_test")
    rostest.rosrun("nao_library_tests", "driver_senses_lost_robot", DriverSensesLostRobot)
