"""The robot dies while joints move, and comes back: the driver says so, and goes on."""

import rospy
from actionlib_msgs.msg import GoalStatus
from mortal_simulator import PORT, LostRobotCase
from news import LIMIT
from rospy import Duration
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import BodyPoseAction, BodyPoseGoal, JointTrajectoryAction, JointTrajectoryGoal
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy


def trajectory(joint, time_from_start, angle):
    goal = JointTrajectoryGoal()
    goal.trajectory.joint_names = [joint]
    goal.trajectory.points = [JointTrajectoryPoint(time_from_start=Duration(time_from_start), positions=[angle])]
    return goal


class LostJoints(LostRobotCase):
    def setUp(self):
        super().setUp()
        self.trajectories = self.client("joint_trajectory", JointTrajectoryAction)
        self.poses = self.client("body_pose", BodyPoseAction)
        self.wait_until_it_works()

    def client(self, name, action):
        client = SimpleActionClient(name, action)
        self.assertTrue(client.wait_for_server(Duration(LIMIT)), name)
        return client

    def wait_until_it_works(self):
        easy = trajectory("HeadYaw", 0.1, 0.0)
        wait_until(
            lambda: send(self.trajectories, easy).wait().state == GoalStatus.SUCCEEDED, LIMIT, "a goal that succeeds"
        )
        began = rospy.Time.now()
        wait_until(
            lambda: rospy.wait_for_message("joint_states", JointState, LIMIT).header.stamp > began,
            LIMIT,
            "joint_states",
        )

    def test_robot_that_dies_and_comes_back(self):
        slow = {"joint_names": "HeadPitch", "positions": [0.4], "time_from_start": 30.0}
        rospy.set_param("pose_manager/poses", {"slow": slow})
        runs = [
            send(self.trajectories, trajectory("HeadYaw", 30.0, 1.5)),
            send(self.poses, BodyPoseGoal("slow")),
        ]
        motion = ALProxy("ALMotion", "127.0.0.1", PORT)
        for joint in ("HeadYaw", "HeadPitch"):
            wait_until(lambda name=joint: motion.getAngles(name, False)[0] > 0.001, LIMIT, f"the motion of {joint}")
        self.assertTrue(all(run.running for run in runs))
        self.kill()
        for run in runs:
            run.wait(LIMIT)
            self.assertEqual(run.state, GoalStatus.ABORTED, run.text)
            self.assertRegex(run.text, rf"127.0.0.1:{PORT}.*(connection broke|went away)")
        self.start()
        self.wait_until_it_works()
