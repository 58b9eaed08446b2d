#!/usr/bin/env python3
"""The robot is late, dies while joints move, and comes back: the driver says so, and goes on."""

import sys
import unittest
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import BodyPoseAction, BodyPoseGoal, JointTrajectoryAction, JointTrajectoryGoal
from nao_library_modules.ros.simple_action_client import SimpleActionClient
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from mortal_simulator import PORT, MortalSimulator  # noqa: E402


def trajectory(time_from_start, angle):
    goal = JointTrajectoryGoal()
    goal.trajectory.joint_names = ["HeadYaw"]
    goal.trajectory.points = [JointTrajectoryPoint(time_from_start=Duration(time_from_start), positions=[angle])]
    return goal


class DriverLostRobot(MortalSimulator, unittest.TestCase):
    def setUp(self):
        self.addCleanup(self.kill)
        self.trajectories = self.client("joint_trajectory", JointTrajectoryAction)
        self.poses = self.client("body_pose", BodyPoseAction)

    def client(self, name, action):
        client = SimpleActionClient(name, action)
        self.assertTrue(client.wait_for_server(Duration(60)), name)
        return client

    def wait_until_it_works(self):
        easy = trajectory(0.1, 0.0)
        wait_until(
            lambda: send(self.trajectories, easy).wait().state == GoalStatus.SUCCEEDED, 60.0, "a goal that succeeds"
        )
        began = rospy.Time.now()
        wait_until(
            lambda: rospy.wait_for_message("joint_states", JointState, 60.0).header.stamp > began, 60.0, "joint_states"
        )

    def test_robot_that_is_late_dies_and_comes_back(self):
        early = send(self.trajectories, trajectory(1.0, 0.5)).wait()
        self.assertEqual(early.state, GoalStatus.ABORTED)
        self.assertIn(str(PORT), early.text)

        self.start()
        self.wait_until_it_works()
        for client, goal in ((self.trajectories, trajectory(30.0, 1.5)), (self.poses, BodyPoseGoal("slow"))):
            rospy.set_param(
                "pose_manager/poses",
                {"slow": {"joint_names": "HeadYaw", "positions": [1.5], "time_from_start": 30.0}},
            )
            run = send(client, goal)
            motion = ALProxy("ALMotion", "127.0.0.1", PORT)
            wait_until(lambda motion=motion: motion.getAngles("HeadYaw", False)[0] > 0.001, 60.0, "the motion")
            self.kill()
            run.wait(60.0)
            self.assertEqual(run.state, GoalStatus.ABORTED, run.text)
            self.assertRegex(run.text, rf"127.0.0.1:{PORT}.*(connection broke|went away)")
            self.start()
            self.wait_until_it_works()


if __name__ == "__main__":
    rospy.init_node("driver_lost_robot_test")
    rostest.rosrun("nao_library_tests", "driver_lost_robot", DriverLostRobot)
