#!/usr/bin/env python3
"""The robot is pushed over in the middle of a motion; a goal gets it up again, also after one that was cancelled."""

import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_sim_bridge.testing import wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from motion_fixture import MotionTest, f  # noqa: E402

# More than the robot can balance: 1.7 m/s for its centre of mass.
PUSH_FORCE, PUSH_TIME = 60.0, 0.15
STANDING_HEIGHT, LYING_HEIGHT = 0.28, 0.2
# A motion that is not over when the robot falls, s.
LONG = 20.0


GET_UP = f("goToPosture", str_param="Stand")


class MotionFalling(MotionTest):
    def setUp(self):
        super().setUp()
        self.play(f("wakeUp"))

    def height(self):
        return self.robot.true_pose().position.z

    def push_over(self, x, y):
        """Push in a direction of the world, and wait until the robot lies; it lets its joints go when it fell."""
        self.robot.push((x * PUSH_FORCE, y * PUSH_FORCE, 0.0), PUSH_TIME)
        wait_until(lambda: not self.robot.value("robotIsWakeUp"), 20.0, "the robot to notice that it has fallen")
        self.robot.advance(2.0)
        self.assertLess(self.height(), LYING_HEIGHT)

    def fall_in_a_motion(self, x, y):
        turn = f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[LONG])
        run = self.send(turn).wait_for_function(0)
        self.push_over(x, y)
        run.wait()
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("the robot fell", run.text)
        self.assertLess(run.ended - run.sent, LONG / 2)
        answers = self.play(f("robotIsWakeUp"), f("getStiffnesses", names=["LLeg"])).memList
        self.assertEqual(answers[0], "False")
        self.assertEqual([float(value) for value in answers[1:]], [0.0] * 6)
        refused = self.send(f("setAngles", names=["HeadYaw"], angles=[0.1])).wait()
        self.assertEqual(refused.state, GoalStatus.ABORTED)
        self.assertIn("no stiffness in HeadYaw", refused.text)

    def get_up(self):
        self.assertEqual(self.play(GET_UP, f("getPosture")).memList[-1], "Stand")
        self.assertGreater(self.height(), STANDING_HEIGHT)

    def test_a_fall_forwards_ends_the_motion_and_leaves_the_robot_limp_until_it_gets_up(self):
        self.fall_in_a_motion(1.0, 0.0)
        self.get_up()

    def test_a_fall_backwards_ends_the_motion_and_leaves_the_robot_limp_until_it_gets_up(self):
        self.fall_in_a_motion(-1.0, 0.0)
        self.get_up()

    def test_a_fall_to_the_side_ends_the_motion_and_leaves_the_robot_limp_until_it_gets_up(self):
        self.fall_in_a_motion(0.0, 1.0)
        self.get_up()

    def test_getting_up_is_cancelled_on_the_way_and_done_by_the_next_goal(self):
        self.push_over(1.0, 0.0)
        run = self.send(GET_UP).wait_for_function(0)
        self.robot.advance(1.5)
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
        self.robot.advance(0.5)
        self.assertLess(self.height(), STANDING_HEIGHT)
        self.assertEqual(self.robot.module("ALMotion").getTaskList(), [])
        self.get_up()


if __name__ == "__main__":
    rospy.init_node("motion_falling_test")
    rostest.rosrun("nao_library_tests", "motion_falling", MotionFalling)
