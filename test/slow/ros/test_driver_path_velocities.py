"""Walking to a target and along a path when the path follower leads by velocities."""

import math
import os
import subprocess

import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from services import action_client
from walking_fixture import WalkingTest

from nao_library_actions.msg import FollowPathAction, FollowPathGoal
from nao_library_modules.core.geometry import Place
from nao_library_modules.driver.joints.planar_frames import pose_stamped
from nao_sim_bridge.testing import send

FRAME = "base_footprint"
NEAR = 0.08
"""m: the threshold of the node, and what odometry is off."""


class DriverPathVelocities(WalkingTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.wait_for_message("odom", Odometry, 60.0)
        # A path follower with settings of its own beside the stack's, which has nothing to do meanwhile.
        remaps = [f"{name}:=/{name}" for name in ("cmd_pose", "cmd_vel", "stop_walk_srv", "foot_contact")]
        cls.node = subprocess.Popen(
            ["rosrun", "nao_library_modules", "nao_path_follower", "--pport", os.environ["NAO_PORT"]]
            + ["__ns:=by_velocities", "_use_vel_ctrl:=true", *remaps]
        )
        cls.addClassCleanup(cls.node.wait, 30.0)
        cls.addClassCleanup(cls.node.terminate)
        cls.poses = []
        cls.velocities = []
        cls.subscribers = [
            rospy.Subscriber("cmd_pose", Pose2D, cls.poses.append),
            rospy.Subscriber("cmd_vel", Twist, cls.velocities.append),
        ]

    def setUp(self):
        super().setUp()
        self.velocities.clear()

    def walk(self, name, action, goal, way):
        client = action_client(f"by_velocities/{name}", action, 60.0)
        before = self.truth()
        with self.robot.at_speed(1.0):  # what the machine delays a command by counts as so much less of the way
            run = send(client, goal).wait(150.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        off = before.then(way).seen_from(self.truth())
        self.assertLess(off.distance, NEAR)
        self.assertLess(abs(off.yaw), math.radians(10.0))
        self.assertEqual(self.poses, [])
        self.assertGreater(len(self.velocities), 20)
        self.assertLessEqual(max(abs(twist.linear.x) for twist in self.velocities), 0.7)
        last = self.velocities[-1]
        self.assertEqual((last.linear.x, last.linear.y, last.angular.z), (0.0, 0.0, 0.0))

    def test_a_target(self):
        way = Place(0.3, 0.1, 0.5)
        self.walk("walk_target", MoveBaseAction, MoveBaseGoal(pose_stamped(way, FRAME, rospy.Time())), way)

    def test_a_path(self):
        places = [Place(0, 0, 0), Place(0.2, 0, 0), Place(0.35, 0.15, 0.8)]
        goal = FollowPathGoal()
        goal.path.header.frame_id = FRAME
        goal.path.poses = [pose_stamped(place, FRAME, rospy.Time()) for place in places]
        self.walk("walk_path", FollowPathAction, goal, places[-1])
