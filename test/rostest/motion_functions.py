#!/usr/bin/env python3
"""Functions of NaoMotion through the real stack, with what the robot's joints then measure."""

import math
import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from motion_fixture import MotionTest, f  # noqa: E402

ARM = ["RShoulderPitch", "RShoulderRoll", "RElbowYaw", "RElbowRoll", "RWristYaw", "RHand"]
# What a joint under load may be off its target, rad.
NEAR = 0.03


def point(seconds, positions, velocities=()):
    return JointTrajectoryPoint(positions=positions, velocities=velocities, time_from_start=Duration.from_sec(seconds))


class MotionFunctions(MotionTest):
    def refused(self, *functions):
        """The text with which a goal is aborted."""
        run = self.send(*functions).wait()
        self.assertEqual(run.state, GoalStatus.ABORTED, run.text)
        self.assertEqual(run.result.results, [])
        return run.text

    def head_stiff(self):
        return f("setStiffnesses", names=["Head"], angles=[1.0])

    def assert_at(self, result, **angles):
        found = dict(zip(result.name, result.position))
        for joint, angle in angles.items():
            self.assertAlmostEqual(found[joint], angle, delta=NEAR, msg=joint)
            self.assertAlmostEqual(self.angle(joint), angle, delta=NEAR, msg=joint)

    # Angles

    def test_get_angles_tells_names_and_angles_of_chains(self):
        self.play(f("wakeUp"))  # limp joints would sink meanwhile
        result = self.play(f("getAngles", names=["RArm", "HeadYaw"]))
        self.assertEqual(result.name, [*ARM, "HeadYaw"])
        for joint, angle in zip(result.name, result.position):
            self.assertAlmostEqual(angle, self.angle(joint), delta=0.01, msg=joint)

    def test_angles_go_out_change_and_come_back(self):
        self.play(self.head_stiff(), f("setAngles", names=["Head"], angles=[0.5, 0.2], time=Duration(1)))
        result = self.play(f("changeAngles", names=["HeadYaw"], angles=[-0.2], time=Duration(1)))
        self.assert_at(result, HeadYaw=0.3)
        self.assertAlmostEqual(self.angle("HeadPitch"), 0.2, delta=NEAR)

    def test_interpolations_take_their_time_and_end_where_asked(self):
        with self.robot.at_speed(0.25):
            result = self.play(
                f("angleInterpolation", names=["Head"], angles=[0.4, 0.0, 0.2, 0.1], times=[0.5, 1.0], stiffness=1.0)
            )
        self.assertAlmostEqual(result.results[0].elapsed.to_sec(), 1.0, delta=0.15)
        self.assert_at(result, HeadYaw=0.0, HeadPitch=0.1)
        self.assert_at(self.play(f("angleInterpolationWithSpeed", names=["HeadYaw"], angles=[-0.6])), HeadYaw=-0.6)

    def test_trajectories_with_and_without_velocities(self):
        points = [point(0.6, [0.5], [0.0]), point(1.2, [0.2], [0.0])]
        curve = JointTrajectory(joint_names=["HeadYaw"], points=points)
        for function in ("setTrajectory", "angleInterpolationBezier"):
            result = self.play(f(function, trajectory=curve, stiffness=1.0))
            self.assert_at(result, HeadYaw=0.2)
        line = JointTrajectory(joint_names=["Head"], points=[point(0.6, [0.0, 0.1]), point(1.2, [-0.4, 0.2])])
        self.assert_at(self.play(f("setTrajectory", trajectory=line, stiffness=1.0)), HeadYaw=-0.4, HeadPitch=0.2)

    def test_poses_of_several_chains_combine(self):
        left, right = [1.0, 0.3, -1.0, -0.5, 0.2, 0.5], [1.2, -0.4, 1.1, 0.6, -0.2, 0.3]
        pose = f("setPose", names=["LArm"] + ["RArm"], angles=left + right, duration=1.5)
        result = self.play(f("wakeUp"), pose)
        wanted = dict(zip(["LShoulderPitch", "LShoulderRoll", "LElbowYaw", "LElbowRoll"], left), RElbowRoll=0.6)
        self.assert_at(result, **wanted)

    def test_a_pose_of_the_library(self):
        result = self.play(f("wakeUp"), f("setPose", str_param="ArmsForward", names=["LArm"], duration=1.5))
        self.assert_at(result, LShoulderPitch=0.2, LElbowYaw=-1.2)

    def test_the_arm_a_little_further_as_in_the_paper(self):
        time_from_start = Duration(1.0)
        get_angles = f("getAngles", names=["RArm"])
        self.play(f("wakeUp"))
        before = self.play(get_angles)
        new_pose = []
        for name, angle in zip(before.name, before.position):
            if name == "RShoulderRoll":
                new_pose.append(angle)
            else:
                new_pose.append(min(angle + 0.5, 1))
        point_1 = JointTrajectoryPoint(time_from_start=time_from_start, positions=new_pose)
        result = self.play(
            f("setPose", names=before.name, trajectory=JointTrajectory(joint_names=before.name, points=[point_1]))
        )
        self.assertEqual(result.name, before.name)
        self.assert_at(result, **dict(zip(before.name, new_pose)))

    def test_hands_open_and_close(self):
        self.play(f("openHand", names=["LHand", "RHand"]))
        self.assertGreater(min(self.angle("LHand"), self.angle("RHand")), 0.9)
        self.play(f("closeHand", names=["LHand"]))
        self.assertLess(self.angle("LHand"), 0.1)

    # Stiffness and postures

    def test_stiffness_at_once_and_along_time(self):
        result = self.play(
            f("setStiffnesses", names=["Head"], angles=[0.2, 0.6]),
            f("getStiffnesses", names=["Head"]),
            f("stiffnessInterpolation", names=["Head"], angles=[0.5, 0.0], times=[0.2, 0.4]),
            f("getStiffnesses", names=["Head"]),
        )
        values = [round(float(value), 3) for value in result.memList]
        self.assertEqual(values, [0.2, 0.6, 0.0, 0.0])

    def test_wake_up_postures_and_rest(self):
        names = self.play(f("getPostureList")).memList
        self.assertIn("Stand", names)
        result = self.play(
            f("wakeUp"),
            f("robotIsWakeUp"),
            f("goToPosture", str_param="StandInit", speed=0.8),
            f("getPosture"),
            f("getPostureFamily"),
            f("rest"),
            f("robotIsWakeUp"),
        )
        self.assertEqual([v for v in result.memList if v in ("True", "False")][0], "True")
        self.assertIn("StandInit", result.memList)
        self.assertIn("Standing", result.memList)
        self.assertEqual(result.memList[-1], "False")

    # Effectors and gaze

    def test_an_effector_goes_along_a_path_and_tells_where_it_is(self):
        self.play(f("wakeUp"))
        place = f("getPosition", names=["LArm"])
        before = [float(v) for v in self.play(place).memList[0].strip("[]").split(",")]
        self.play(f("positionInterpolation", names=["LArm"], values=[0.03, 0, 0, 0, 0, 0], times=[1.0], relative=True))
        after = [float(v) for v in self.play(place).memList[0].strip("[]").split(",")]
        for i, moved in enumerate((0.03, 0.0, 0.0)):
            self.assertAlmostEqual(after[i] - before[i], moved, delta=0.01)

    def test_the_head_looks_at_a_point(self):
        result = self.play(f("lookAt", values=[1.0, 1.0, 0.2], stiffness=1.0))
        yaw, _, missing = (float(value) for value in result.memList)
        self.assertAlmostEqual(yaw, math.pi / 4, delta=1e-3)
        self.assertAlmostEqual(missing, 0.0, delta=1e-4)
        self.assert_at(result, HeadYaw=yaw)

    # Facts and switches

    def test_facts_of_the_robot(self):
        result = self.play(
            f("getBodyNames", names=["Head"]),
            f("getMass"),
            f("getCOM", frame=0),
            f("getLimits", names=["HeadYaw"]),
            f("getRobotConfig"),
            f("getSummary"),
            f("getTaskList"),
        )
        answers = {entry.function: entry.values for entry in result.results}
        self.assertEqual(answers["getBodyNames"], ["HeadYaw", "HeadPitch"])
        self.assertAlmostEqual(float(answers["getMass"][0]), 5.3, delta=0.6)
        self.assertEqual(len(answers["getCOM"][0].split(",")), 3)
        self.assertAlmostEqual(float(answers["getLimits"][0].strip("[").split(",")[0]), -2.0857, delta=1e-3)
        self.assertIn("HeadYaw", answers["getSummary"][0])
        self.assertEqual(answers["getTaskList"], [])

    def test_switches_and_balance(self):
        result = self.play(
            f("wakeUp"),
            f("setPushRecoveryEnabled", enable=False),
            f("getPushRecoveryEnabled"),
            f("setPushRecoveryEnabled", enable=True),
            f("wbEnable", enable=True),
            f("wbFootState", texts=["Fixed"], str_param="Legs"),
            f("wbEnableBalanceConstraint", enable=True, str_param="Legs"),
            f("wbGoToBalance", str_param="LLeg", duration=1.5),
            f("wbEnable", enable=False),
        )
        answers = {entry.function: entry.values for entry in result.results}
        self.assertEqual(answers["getPushRecoveryEnabled"], ["False"])

    # What is refused before anything moves

    def test_what_is_wrong_is_refused_before_anything_moves(self):
        stiff, turn = self.head_stiff(), f("setAngles", names=["HeadYaw"], angles=[0.5])
        for function, text in (
            (f("setAngles", names=["HeadYow"], angles=[0.1]), "did you mean 'HeadYaw'"),
            (f("setAngles", names=["HeadYaw"], angles=[3.0]), "HeadYaw cannot go to 3.0000: -2.0857 to 2.0857"),
            (f("setAngles", names=["Head"], angles=[0.1, 0.2, 0.3]), "3 values for 2 joints"),
            (f("angleInterpolation", names=["HeadYaw"], angles=[-2.0], times=[0.1]), "at least 0.3"),
            (f("setAngles", names=["RArm"], angles=[0.1]), "no stiffness in RShoulderPitch"),
            (f("goToPosture", str_param="Standd"), "did you mean 'Stand'"),
        ):
            refusal = self.refused(stiff, turn, function)
            self.assertIn("function 3", refusal)
            self.assertIn(text, refusal)
        self.robot.advance(1.0)
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.0, delta=NEAR)

    def test_a_dry_run_moves_nothing_and_tells_the_time(self):
        result = self.play(
            self.head_stiff(),
            f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[2.0], dry_run=True),
        )
        self.assertEqual(result.results[1].values, ["2.000"])
        self.assertEqual(list(result.position), [1.0])
        self.robot.advance(0.5)
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.0, delta=NEAR)


if __name__ == "__main__":
    rospy.init_node("motion_functions_test")
    rostest.rosrun("nao_library_tests", "motion_functions", MotionFunctions)
