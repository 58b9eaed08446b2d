"""A driver that speaks the types of the older packages, and programs that know no others."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rosbag
import rosgraph
import rospy
import rosservice
from actionlib_msgs.msg import GoalStatus
from genpy import Time
from older_packages import make_older_packages
from ros_stack import start_program
from rospy import Duration
from services import action_client, publisher, service
from std_srvs.srv import Empty, EmptyResponse
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import JointTrajectoryAction, JointTrajectoryGoal
from nao_library_modules.ros.driver_types import PARAMETER, spoken
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

LIMIT = 60.0
SPACE = "/older/"
NODE = ("rosrun", "nao_library_modules", "nao_driver")


def turning(goal, angle):
    """A goal of joint_trajectory that turns the head; `goal`: an empty one."""
    goal.trajectory.joint_names = ["HeadYaw"]
    goal.trajectory.points = [JointTrajectoryPoint(time_from_start=Duration(0.5), positions=[angle])]
    return goal


class OlderTypes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.folder = Path(tempfile.mkdtemp(prefix="nao_older_"))
        cls.packages = make_older_packages(cls.folder)
        sys.path.insert(0, str(cls.packages))
        cls.environment = {**os.environ, "PYTHONPATH": f"{cls.packages}:{os.environ['PYTHONPATH']}"}
        hidden = cls.folder / "hidden"  # packages of these names without types, before those that may be installed
        for name in os.listdir(cls.packages):
            (hidden / name).mkdir(parents=True)
            (hidden / name / "__init__.py").touch()
        cls.without = {**os.environ, "PYTHONPATH": f"{hidden}:{os.environ['PYTHONPATH']}"}
        rospy.set_param(SPACE + PARAMETER, "naoqi_bridge")
        cls.teleop = rospy.Service(f"{SPACE}inhibit_walk", Empty, lambda _: EmptyResponse())
        words = ("__ns:=older", "_parts:=controller walker", "--pport", os.environ["NAO_PORT"])
        cls.driver = start_program(*NODE, *words, env=cls.environment)

    @classmethod
    def tearDownClass(cls):
        cls.driver.terminate()
        cls.driver.wait(LIMIT)
        cls.teleop.shutdown()
        rospy.delete_param("/older")
        sys.path.remove(str(cls.packages))
        for name in [name for name in sys.modules if name.partition(".")[0] in os.listdir(cls.packages)]:
            del sys.modules[name]
        shutil.rmtree(cls.folder)

    def setUp(self):
        self.robot.reset()
        self.robot.module("ALMotion").setStiffnesses("Head", 1.0)

    def looks(self, angle):
        motion = self.robot.module("ALMotion")
        wait_until(lambda: abs(motion.getAngles("HeadYaw", True)[0] - angle) < 0.02, LIMIT, f"HeadYaw at {angle}")

    def test_their_message_is_taken_also_from_an_old_bag(self):
        from naoqi_bridge_msgs.msg import JointAnglesWithSpeed

        topic = f"{SPACE}joint_angles"
        publisher(self, topic, JointAnglesWithSpeed).publish(
            JointAnglesWithSpeed(joint_names=["HeadYaw"], joint_angles=[0.3], speed=0.5)
        )
        self.looks(0.3)
        self.assertIn([topic, JointAnglesWithSpeed._type], rosgraph.Master("/test").getTopicTypes())
        bag = self.folder / "old.bag"
        with rosbag.Bag(str(bag), "w") as old:
            message = JointAnglesWithSpeed(joint_names=["HeadYaw"], joint_angles=[-0.3], speed=0.5)
            old.write("joint_angles", message, Time(1))
        play = ("rosbag", "play", "-q", "--wait-for-subscribers", str(bag), f"joint_angles:={topic}")
        subprocess.run(play, check=True, timeout=LIMIT)
        self.looks(-0.3)

    def test_their_service_is_answered_and_known_by_their_name(self):
        from naoqi_bridge_msgs.srv import SetArmsEnabled

        name = f"{SPACE}enable_arms_walking_srv"
        service(name, SetArmsEnabled)(left_arm=True, right_arm=True)
        self.assertEqual(rosservice.get_service_type(name), "naoqi_bridge_msgs/SetArmsEnabled")

    def test_a_walker_leaves_inhibition_to_nao_teleop_where_that_offers_it(self):
        rospy.wait_for_service(f"{SPACE}enable_arms_walking_srv", LIMIT)  # the last that it offers
        self.assertEqual(rosservice.get_service_node(f"{SPACE}inhibit_walk"), rospy.get_name())

    def test_their_action_is_served_to_them_and_to_our_clients(self):
        from naoqi_bridge_msgs.msg import JointTrajectoryAction as Theirs
        from naoqi_bridge_msgs.msg import JointTrajectoryGoal as TheirGoal

        name = f"{SPACE}joint_trajectory"
        ours = spoken(JointTrajectoryAction, SPACE)
        for action, goal, angle in ((Theirs, TheirGoal(), 0.4), (ours, JointTrajectoryGoal(), -0.4)):
            run = send(action_client(name, action), turning(goal, angle)).wait()
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
            self.looks(angle)

    def test_packages_that_are_not_there_are_refused_by_node_and_launch_file(self):
        rospy.set_param(f"/refused/{PARAMETER}", "naoqi_bridge")
        self.addCleanup(rospy.delete_param, "/refused")
        launch = ("roslaunch", "--dump-params", "nao_library", "nao_driver.launch", "messages:=naoqi_bridge")
        for command in ((*NODE, "__ns:=refused"), launch):
            ended = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, env=self.without)
            self.assertIn("naoqi_bridge_msgs cannot be imported", ended.stdout + ended.stderr)
            self.assertNotIn("/nao_driver/messages:", ended.stdout)
        dumped = subprocess.run(launch, capture_output=True, text=True, timeout=LIMIT, env=self.environment)
        self.assertIn("/nao_driver/messages: naoqi_bridge", dumped.stdout)
