#!/usr/bin/env python3
"""NaoMotion through actionlib, beside goals to another server."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedGoal, NaoMotionAction
from nao_library_msgs.msg import LedFunction, MotionFunction
from nao_sim_bridge.testing import RobotTestCase, send, wait_until

BRAIN0 = "Head/Led/Front/Right/1"


def f(function, **fields):
    return MotionFunction(function=function, **fields)


def turn(angle, seconds):
    return f("angleInterpolation", names=["HeadYaw"], angles=[angle], times=[seconds], stiffness=1.0)


class MotionCase(RobotTestCase):
    server = ("NaoMotion", NaoMotionAction)

    def angle(self, joint):
        return self.robot.value(f"Device/SubDeviceList/{joint}/Position/Sensor/Value")

    def start(self, *functions):
        run = self.send(*functions)
        wait_until(lambda: self.angle("HeadYaw") > 0.03, 60.0, "the head on its way")
        return run


class Motion(MotionCase):
    def test_the_result_names_the_joints_and_where_they_are(self):
        result = self.succeed(turn(0.5, 0.5), f("getAngles", names=["Head"]))
        positions = dict(zip(result.name, result.position))
        self.assertEqual(list(positions), ["HeadYaw", "HeadPitch"])
        self.assertAlmostEqual(positions["HeadYaw"], 0.5, delta=0.02)
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.5, delta=0.02)

    def test_a_cancel_stops_the_joint_where_it_is(self):
        run = self.start(f("getAngles", names=["HeadPitch"]), turn(2.0, 80.0), f("rest"))
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        self.assertEqual(run.text, "preempted in function 2 (angleInterpolation)")
        self.assertEqual([done.function for done in run.result.results], ["getAngles"])
        self.robot.advance(0.3)
        stopped = self.angle("HeadYaw")
        self.robot.advance(1.0)
        self.assertAlmostEqual(self.angle("HeadYaw"), stopped, delta=0.01)
        self.assertLess(stopped, 1.8)

    def test_a_newer_goal_takes_the_joint_over_where_it_is(self):
        older = self.start(turn(2.0, 80.0))
        self.succeed(turn(-0.5, 1.0))
        self.ends(older, GoalStatus.PREEMPTED)
        self.assertAlmostEqual(self.angle("HeadYaw"), -0.5, delta=0.03)

    def test_lights_and_motion_run_at_the_same_time(self):
        lights = self.robot.action_client("NaoLights", NaoLedAction)
        motion = self.start(turn(1.0, 60.0))
        fade = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=0.5)
        faded = send(lights, NaoLedGoal([fade])).wait()
        self.assertTrue(motion.running)
        self.assertEqual((faded.state, self.robot.led(BRAIN0)), (GoalStatus.SUCCEEDED, 0.0))
        motion.cancel()
        self.ends(motion, GoalStatus.PREEMPTED)

    def test_a_walk_ends_where_it_was_sent_and_a_bad_one_moves_nothing(self):
        self.assertRegex(self.refused(f("moveTo", values=[0.1, float("nan"), 0.0])), "field values")
        start = self.robot.true_pose().position
        self.succeed(f("wakeUp"), f("moveTo", values=[0.15, 0.0, 0.0]))
        end = self.robot.true_pose().position
        self.assertAlmostEqual(end.x - start.x, 0.15, delta=0.03)
        self.assertAlmostEqual(end.y, start.y, delta=0.02)


if __name__ == "__main__":
    rospy.init_node("motion_test")
    rostest.rosrun("nao_library_tests", "motion", Motion)
