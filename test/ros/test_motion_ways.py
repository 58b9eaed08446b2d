"""Two ways of NaoMotion: by the driver where there is one, past it where there is none. Both end alike."""

import os
import sys
from contextlib import ExitStack
from pathlib import Path

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from examples_fixture import start
from move_base_msgs.msg import MoveBaseActionResult
from news import News
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import (
    BodyPoseActionResult,
    BodyPoseWithSpeedActionResult,
    JointAnglesWithSpeedActionResult,
    JointTrajectoryAction,
    JointTrajectoryActionResult,
    JointTrajectoryGoal,
    NaoMotionAction,
)
from nao_sim_bridge.testing import send, wait_until

sys.path.insert(0, str(Path(__file__).parent))
from test_motion import Motion, MotionCase, f, turn  # noqa: E402


class MotionPastTheDriver(Motion):
    """The same cases; in this namespace there is no driver."""

    server = ("direct/NaoMotion", NaoMotionAction)

    @classmethod
    def setUpClass(cls):
        cls.node = start("../nodes/nao_motion", "--pport", os.environ["NAO_PORT"], "__ns:=/direct")
        cls.addClassCleanup(cls.node.communicate)
        cls.addClassCleanup(cls.node.kill)
        super().setUpClass()


class MotionByTheDriver(MotionCase):
    def test_what_nao_robot_has_words_for_goes_through_its_actions(self):
        news, ways = News(), {
            "joint_trajectory": JointTrajectoryActionResult,
            "joint_angles_action": JointAnglesWithSpeedActionResult,
            "joint_stiffness_trajectory": JointTrajectoryActionResult,
            "body_pose": BodyPoseActionResult,
            "body_pose_naoqi": BodyPoseWithSpeedActionResult,
            "walk_target": MoveBaseActionResult,
        }  # fmt: skip
        with ExitStack() as stack:
            ended = {name: stack.enter_context(news.messages(f"{name}/result", ways[name])) for name in ways}
            self.move_in_all_ways()
            news.wait(lambda: all(ended.values()), "results on the driver's topics")
            counts = {name: len(results) for name, results in ended.items()}
            self.assertEqual(counts, {**dict.fromkeys(ways, 1), "body_pose_naoqi": 2, "joint_trajectory": 2})

    def move_in_all_ways(self):
        self.succeed(
            f("goToPosture", str_param="StandInit", speed=0.8),
            f("setPose", str_param="crouch", stiffness=1.0),
            f("goToPosture", str_param="Stand", speed=0.8),
            f("setStiffnesses", names=["LArm"], angles=[0.9]),
            turn(0.3, 0.5),
            f("angleInterpolationWithSpeed", names=["HeadPitch"], angles=[0.1], speed=0.2),
            f("walkTarget", values=[0.1, 0.0, 0.0]),
            f("moveToward", values=[0.5, 0.0, 0.0], duration=1.0),
            f("rest"),
        )

    def test_a_short_way_is_walked_as_well(self):
        before = self.robot.module("ALMotion").getRobotPosition(True)
        self.succeed(f("goToPosture", str_param="Stand", speed=0.8), f("moveTo", values=[0.03, 0.0, 0.0]))
        after = self.robot.module("ALMotion").getRobotPosition(True)
        self.assertAlmostEqual(after[0] - before[0], 0.03, delta=0.01)

    def test_a_target_is_left_when_its_goal_is_cancelled(self):
        slow = f("setAngles", names=["HeadYaw"], angles=[2.0], speed=0.01, stiffness=1.0, time=rospy.Duration(300))
        run = self.send(slow)
        wait_until(lambda: self.angle("HeadYaw") > 0.02, 60.0, "the head on its way")
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        self.robot.advance(0.3)
        stopped = self.angle("HeadYaw")
        self.robot.advance(1.0)
        self.assertAlmostEqual(self.angle("HeadYaw"), stopped, delta=0.01)

    def test_who_takes_joints_over_at_the_driver_is_said(self):
        ours = self.start(turn(2.0, 80.0))
        theirs = JointTrajectoryGoal()
        theirs.trajectory.joint_names = ["HeadYaw"]
        theirs.trajectory.points = [JointTrajectoryPoint(positions=[-0.5], time_from_start=rospy.Duration(5))]
        client = SimpleActionClient("joint_trajectory", JointTrajectoryAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(60)))
        run = send(client, theirs).wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        told = [(each.joint_names, each.desired.positions[0], each.error.positions[0]) for _, each in run.feedback]
        self.assertTrue(told and all(names == ["HeadYaw"] and abs(error) < 0.2 for names, _, error in told), told)
        self.assertLess(told[-1][1], told[0][1])
        self.ends(ours, GoalStatus.ABORTED)
        self.assertRegex(ours.text, "HeadYaw")
        self.assertAlmostEqual(self.angle("HeadYaw"), -0.5, delta=0.03)


del Motion  # its cases run in their own file, by the driver, and in the first class
