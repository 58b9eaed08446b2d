#!/usr/bin/env python3
"""Motion that is cancelled or replaced ends at once, and the robot holds its pose; lights go on beside it."""

import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from motion_fixture import MotionTest, f  # noqa: E402

COMMAND = "Device/SubDeviceList/{}/Position/Actuator/Value"
BRAIN0 = "Head/Led/Front/Right/1"


def trajectory(target, seconds):
    point = JointTrajectoryPoint(positions=[target], velocities=[0.0], time_from_start=Duration.from_sec(seconds))
    return JointTrajectory(joint_names=["HeadYaw"], points=[point])


class MotionPreemption(MotionTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lights = cls.robot.action_client("NaoLights", NaoLedAction)

    def start(self, *functions):
        """Send a chain and wait until the head is on its way."""
        run = self.send(*functions)
        wait_until(lambda: self.angle("HeadYaw") > 0.1, 20.0, "the head on its way")
        return run

    def assert_holds(self, joint="HeadYaw"):
        """The joint stays where it is, away from its target."""
        self.robot.advance(0.3)
        at = self.angle(joint)
        self.robot.advance(1.5)
        self.assertAlmostEqual(self.angle(joint), at, delta=0.02)
        self.assertLess(at, 1.8)

    def test_every_kind_of_motion_ends_when_it_is_cancelled(self):
        for function in (
            f("angleInterpolation", names=["HeadYaw"], angles=[2.0], times=[8.0], stiffness=1.0),
            f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[2.0], speed=0.02, stiffness=1.0),
            f("setTrajectory", trajectory=trajectory(2.0, 8.0), stiffness=1.0),
            f("setPose", names=["HeadYaw"], angles=[2.0], duration=8.0, stiffness=1.0),
            f("setAngles", names=["HeadYaw"], angles=[2.0], speed=0.02, stiffness=1.0, time=Duration(30)),
            f("lookAt", values=[0.0, 1.0, 0.1], duration=8.0, stiffness=1.0),
        ):
            self.robot.reset()
            run = self.start(function)
            run.cancel()
            run.wait(5.0)
            self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
            self.assertIn("HeadYaw", run.result.name)
            self.assert_holds()
            self.assertEqual(self.robot.module("ALMotion").getTaskList(), [], function.function)

    def test_a_posture_is_interrupted_and_the_robot_stays_up(self):
        self.send(f("wakeUp")).wait(60.0)
        run = self.send(f("goToPosture", str_param="Crouch", speed=0.3))
        before = self.angle("LKneePitch")
        wait_until(lambda: abs(self.angle("LKneePitch") - before) > 0.05, 20.0, "the knee on its way")
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
        self.robot.advance(0.3)
        knee = self.angle("LKneePitch")
        self.robot.advance(2.0)
        self.assertAlmostEqual(self.angle("LKneePitch"), knee, delta=0.03)
        self.assertGreater(self.robot.true_pose().position.z, 0.2)

    def test_a_new_goal_takes_over_where_the_old_one_was(self):
        old = self.start(f("angleInterpolation", names=["HeadYaw"], angles=[2.0], times=[8.0], stiffness=1.0))
        new = self.send(f("angleInterpolation", names=["HeadYaw"], angles=[-0.5], times=[2.0]))
        old.wait(5.0)
        new.wait()
        self.assertEqual((old.state, new.state), (GoalStatus.PREEMPTED, GoalStatus.SUCCEEDED), new.text)
        self.assertAlmostEqual(self.angle("HeadYaw"), -0.5, delta=0.03)

    def test_the_functions_before_the_cancelled_one_are_in_the_result(self):
        run = self.start(
            f("setStiffnesses", names=["Head"], angles=[1.0]),
            f("getAngles", names=["HeadPitch"]),
            f("angleInterpolation", names=["HeadYaw"], angles=[2.0], times=[8.0]),
            f("rest"),
        )
        run.cancel()
        run.wait(5.0)
        self.assertEqual([entry.function for entry in run.result.results], ["setStiffnesses", "getAngles"])
        self.assertEqual(run.text, "preempted in function 3 (angleInterpolation)")

    def test_lights_and_motion_run_at_the_same_time(self):
        motion = self.send(f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[8.0], stiffness=1.0))
        fade = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=1.0)
        lights = send(self.lights, NaoLedGoal([fade])).wait()
        motion.wait()
        self.assertEqual((motion.state, lights.state), (GoalStatus.SUCCEEDED,) * 2, motion.text + lights.text)
        self.assertLess(lights.ended, motion.ended)
        self.assertEqual(self.robot.led(BRAIN0), 0.0)


if __name__ == "__main__":
    rospy.init_node("motion_preemption_test")
    rostest.rosrun("nao_library_tests", "motion_preemption", MotionPreemption)
