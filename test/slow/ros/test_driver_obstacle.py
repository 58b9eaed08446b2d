"""A wall in the way of a target: the robot sees it, stops before it, gives the goal up and says why."""

import rospy
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from services import action_client
from walking_fixture import WalkingTest

from nao_library_modules.driver.planar_frames import pose_stamped
from nao_library_modules.places import Place
from nao_sim_bridge.testing import send

WALL_X = 0.96
"""m: the near face of the low wall of the world "obstacles", which is 1 m wide."""


class DriverObstacle(WalkingTest):
    world = "obstacles"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.wait_for_message("odom", Odometry, 60.0)

    def tearDown(self):
        super().tearDown()
        self.assertGreater(self.robot.true_pose().position.z, 0.3, "the robot has fallen")

    def test_a_target_behind_a_wall_is_given_up(self):
        client = action_client("walk_target", MoveBaseAction, 60.0)
        goal = MoveBaseGoal(pose_stamped(Place(1.5, 0.0, 0.0), "base_footprint", rospy.Time()))
        run = send(client, goal).wait(150.0)
        self.assertEqual(run.state, GoalStatus.ABORTED, run.text)
        self.assertRegex(run.text, r"the robot stopped: an obstacle 0\.\d+ m ahead")
        place = self.robot.true_pose().position
        print(f"gave up {WALL_X - place.x:.2f} m before the wall after {run.ended - run.sent:.1f} s")
        self.assertGreater(place.x, 0.3)
        self.assertLess(place.x, WALL_X - 0.25)
