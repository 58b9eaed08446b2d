#!/usr/bin/env python3
"""The example of docs/testing.md: a suite as users of nao_library write it for their own experiment."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoTactileAction, NaoTactileGoal
from nao_library_msgs.msg import LedFunction, TactileFunction
from nao_sim_bridge.testing import RobotTestCase, send, wait_until


class ExampleSuite(RobotTestCase):
    server = ("NaoLights", NaoLedAction)

    def test_eyes_are_red_while_the_robot_waits(self):
        red = LedFunction(
            function="setColor", lights=["FaceLeds"], str_param="red", time=rospy.Duration(3), revert=True
        )
        run = self.send(red)
        self.robot.wait_for_leds({"Face/Led/Red/Left/0Deg": 1.0, "Face/Led/Green/Left/0Deg": 0.0})
        self.ends(run, GoalStatus.SUCCEEDED)
        self.assertEqual(self.robot.led("Face/Led/Green/Left/0Deg"), 1.0)

    def test_a_touch_of_the_head_is_waited_for(self):
        tactile = self.robot.action_client("NaoTactile", NaoTactileAction)
        run = send(tactile, NaoTactileGoal([TactileFunction(function="waitForTouch", sensors=["head"], timeout=60.0)]))
        wait_until(lambda: any(told.status == "waiting" for _, told in run.feedback), 60.0, "the robot waits")
        self.robot.press(["Head/Touch/Front"])
        self.assertEqual(run.wait().result.touched, ["front head"])

    def test_it_still_stands_after_a_push(self):
        self.robot.module("ALMotion").wakeUp()
        self.robot.push((10.0, 0.0, 0.0), 0.1)
        self.robot.advance(2.0)
        self.assertGreater(self.robot.true_pose().position.z, 0.32)


if __name__ == "__main__":
    rospy.init_node("example_suite_test")
    rostest.rosrun("nao_library_tests", "example_suite", ExampleSuite)
