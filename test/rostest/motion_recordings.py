#!/usr/bin/env python3
"""Motions recorded from the robot's joints, replayed, mirrored, kept under names; nod, stand and wave as one goal."""

import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_sim_bridge.testing import wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from motion_fixture import MotionTest, f  # noqa: E402

NAME = "rostest_turn"
COPY = "rostest_turn_2"


class MotionRecordings(MotionTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.motion = cls.robot.module("ALMotion")

    def setUp(self):
        super().setUp()
        for name in self.play(f("listMotions")).memList:
            if name in (NAME, COPY):
                self.play(f("deleteMotion", str_param=name))

    def record_a_turn(self, until=0.6):
        """Record while another client turns the head to the left."""
        self.motion.setStiffnesses("Head", 1.0)
        recording = self.send(
            f("recordMotion", str_param=NAME, names=["Head"], duration=60.0, rate=20.0)
        ).wait_for_function(0)
        self.motion.angleInterpolation(["HeadYaw"], [until], [1.5], True)
        self.robot.advance(0.5)
        recording.cancel()
        recording.wait(5.0)
        self.assertEqual(recording.state, GoalStatus.PREEMPTED, recording.text)

    def test_a_recording_that_is_cancelled_is_kept_and_replayed_and_mirrored(self):
        self.record_a_turn()
        self.assertIn(NAME, self.play(f("listMotions")).memList)
        self.play(f("playMotion", str_param=NAME, speed=2.0))
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.6, delta=0.06)
        self.play(f("playMotion", str_param=NAME, mirror=True))
        self.assertAlmostEqual(self.angle("HeadYaw"), -0.6, delta=0.06)

    def test_a_recording_for_a_time_has_its_length_and_leaves_stiffness_as_it_was(self):
        self.motion.setStiffnesses("Head", 1.0)
        result = self.play(
            f("recordMotion", str_param=NAME, names=["Head"], duration=1.0, limp=True),
            f("getStiffnesses", names=["Head"]),
        )
        self.assertGreaterEqual(result.results[0].elapsed.to_sec(), 1.0)
        self.assertEqual([float(v) for v in result.results[1].values], [1.0, 1.0])

    def test_joints_that_are_taught_by_hand_are_stiff_again_after_a_cancel(self):
        self.motion.setStiffnesses("Head", 0.8)
        run = self.send(f("recordMotion", str_param=NAME, names=["Head"], duration=60.0, limp=True))
        wait_until(lambda: self.motion.getStiffnesses("Head") == [0.0, 0.0], 10.0, "a limp head")
        self.robot.advance(0.5)
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
        for stiffness in self.motion.getStiffnesses("Head"):
            self.assertAlmostEqual(stiffness, 0.8, delta=0.01)
        self.assertIn(NAME, self.play(f("listMotions")).memList)

    def test_motions_are_renamed_and_deleted(self):
        self.record_a_turn()
        self.play(f("renameMotion", str_param=NAME, texts=[COPY]))
        names = self.play(f("listMotions")).memList
        self.assertIn(COPY, names)
        self.assertNotIn(NAME, names)
        self.play(f("deleteMotion", str_param=COPY))
        run = self.send(f("playMotion", str_param=COPY)).wait()
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn(COPY, run.text)

    def test_names_stay_in_the_folder(self):
        for name in ("../turn", "a/b", ".hidden", ""):
            run = self.send(f("recordMotion", str_param=name, duration=0.1)).wait()
            self.assertEqual(run.state, GoalStatus.ABORTED, name)

    def test_a_replay_is_cancelled_and_the_head_stays(self):
        self.record_a_turn(1.2)
        run = self.send(f("playMotion", str_param=NAME, speed=0.2))
        wait_until(lambda: 0.1 < self.angle("HeadYaw") < 0.9, 20.0, "the head on its way")
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
        self.robot.advance(0.3)
        at = self.angle("HeadYaw")
        self.robot.advance(2.0)
        self.assertAlmostEqual(self.angle("HeadYaw"), at, delta=0.02)
        self.assertLess(at, 1.1)

    def test_nod_stand_and_wave_as_one_goal(self):
        nod = f(
            "angleInterpolation", names=["HeadPitch"], angles=[0.3, -0.2, 0.0], times=[0.5, 1.0, 1.5], stiffness=1.0
        )
        stand = f("goToPosture", str_param="Stand")
        raised = f("setPose", names=["RArm"], angles=[-1.0, -0.3, 1.2, 0.8, 0.0, 1.0], duration=1.5)
        wave = f("angleInterpolation", names=["RElbowRoll"], angles=[0.4, 1.2, 0.4, 1.2], times=[0.5, 1.0, 1.5, 2.0])
        run = self.send(nod, stand, raised, wave).wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertEqual([feedback.index for _, feedback in run.feedback], [0, 1, 2, 3])
        self.assertAlmostEqual(self.angle("RElbowRoll"), 1.2, delta=0.05)
        self.assertGreater(self.robot.true_pose().position.z, 0.28)


if __name__ == "__main__":
    rospy.init_node("motion_recordings_test")
    rostest.rosrun("nao_library_tests", "motion_recordings", MotionRecordings)
