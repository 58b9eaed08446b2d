"""What nao_joint_states publishes: an even rate, and facts about the robot."""

import math
import threading
import unittest

import rospy
import tf2_ros
from actionlib_msgs.msg import GoalStatus
from nav_msgs.msg import Odometry
from rospy import Duration, Time
from sensor_msgs.msg import Imu, JointState
from services import action_client, measured_now, publisher, service
from std_srvs.srv import Empty
from trajectory_msgs.msg import JointTrajectoryPoint

from nao_library_actions.msg import JointTrajectoryAction, JointTrajectoryGoal
from nao_library_msgs.msg import JointAnglesWithSpeed
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

PERIOD = 0.02
WINDOW = 3.0
LIMIT = 120.0
LONG_GAP = 0.03
SLOWLY = 0.25
"""Speed at which rates are measured: what a busy machine does to the nodes counts a quarter."""


def trajectory(joint, *points):
    goal = JointTrajectoryGoal()
    goal.trajectory.joint_names = [joint]
    goal.trajectory.points = [JointTrajectoryPoint(time_from_start=Duration(t), positions=[p]) for t, p in points]
    return goal


class Collector:
    """Messages of a topic, until `seconds` of their own time have passed."""

    def __init__(self, topic, kind, seconds):
        self.messages = []
        self._seconds = seconds
        self._full = threading.Event()
        self._subscriber = rospy.Subscriber(topic, kind, self._add, queue_size=100, tcp_nodelay=True)

    def _add(self, message):
        self.messages.append(message)
        if (message.header.stamp - self.messages[0].header.stamp).to_sec() >= self._seconds:
            self._full.set()

    def wait(self):
        full = self._full.wait(LIMIT)
        self._subscriber.unregister()
        assert full, f"only {len(self.messages)} messages"
        return self.messages


class DriverState(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = action_client("joint_trajectory", JointTrajectoryAction)
        cls.frames = tf2_ros.Buffer(Duration(600))
        cls.listener = tf2_ros.TransformListener(cls.frames)
        rospy.wait_for_message("joint_states", JointState, 60.0)
        easy = trajectory("HeadYaw", (0.1, 0.0))  # succeeds as soon as nao_controller has reached the robot as well
        wait_until(lambda: send(cls.client, easy).wait().state == GoalStatus.SUCCEEDED, 60.0, "nao_controller")
        service("wakeup", Empty)()
        cls.robot.advance(1.0)

    def setUp(self):
        slowly = self.robot.at_speed(SLOWLY)
        slowly.__enter__()
        self.addCleanup(slowly.__exit__, None, None, None)

    def frame(self, parent, child):
        """Pose of `child` in `parent`: a transform of after now, for the world has changed before."""
        transform = self.frames.lookup_transform(parent, child, Time.now(), Duration(30)).transform
        return transform.translation, transform.rotation

    def test_the_rate_is_even_while_three_clients_send_goals(self):
        stop, ended = threading.Event(), []

        def send_goals(joint):
            while not stop.is_set():
                run = send(self.client, trajectory(joint, (0.2, 0.3), (0.4, -0.3))).wait()
                ended.append((run.state, run.text))

        clients = [
            threading.Thread(target=send_goals, args=(joint,)) for joint in ("HeadYaw", "LElbowYaw", "RElbowYaw")
        ]
        for client in clients:
            client.start()
        try:
            stamps = [m.header.stamp.to_sec() for m in Collector("joint_states", JointState, WINDOW).wait()]
        finally:
            stop.set()
            for client in clients:
                client.join()
        gaps = [b - a for a, b in zip(stamps, stamps[1:])]
        # A busy computer leaves some out; none comes too soon, and those that follow each other are a period apart.
        self.assertGreater((stamps[-1] - stamps[0]) / len(gaps), 0.98 * PERIOD)
        self.assertLess(min(gaps), LONG_GAP)
        self.assertGreater(len(ended), 2)
        self.assertEqual({state for state, _ in ended}, {GoalStatus.SUCCEEDED}, ended)

    def test_joint_states_are_what_the_robot_measures(self):
        state = measured_now("joint_states", JointState)
        motion = self.robot.module("ALMotion")
        self.assertEqual(state.name, motion.getBodyNames("Body"))
        for name, found, wanted in zip(state.name, state.position, motion.getAngles("Body", True)):
            self.assertAlmostEqual(found, wanted, delta=0.02, msg=name)
        self.assertEqual({len(state.velocity), len(state.effort)}, {26})

    def test_bent_knees_carry_the_body_and_hands_nothing(self):
        effort = {}

        def knees():
            state = measured_now("joint_states", JointState)
            effort.update(zip(state.name, state.effort))
            return abs(effort["LKneePitch"]) + abs(effort["RKneePitch"])

        wait_until(lambda: knees() > 0.1, 60.0, lambda: f"load on the knees: {effort}")
        self.assertLess(abs(effort["LHand"]), 0.05)

    def test_stiffnesses_are_told_under_the_name_of_the_node(self):
        state = measured_now("nao_joint_states/joint_stiffness", JointState)
        stiffnesses = dict(zip(state.name, state.effort))
        self.assertEqual(len(stiffnesses), 26)
        self.assertAlmostEqual(stiffnesses["LKneePitch"], 1.0, delta=1e-6)  # awake since the beginning

    def test_velocities_are_those_of_the_motion(self):
        angles = publisher(self, "joint_angles", JointAnglesWithSpeed)
        motion = self.robot.module("ALMotion")
        speed = 0.1 * motion.getLimits("HeadYaw")[0][2]
        collector = Collector("joint_states", JointState, 2.0)
        sign = -1.0 if motion.getAngles("HeadYaw", True)[0] > 0.0 else 1.0
        angles.publish(JointAnglesWithSpeed(joint_names=["HeadYaw"], joint_angles=[sign * 1.5], speed=0.1))
        messages = collector.wait()
        index = messages[0].name.index("HeadYaw")
        fastest = sorted(sign * message.velocity[index] for message in messages)
        # The upper half of them is of the time when the joint turns evenly.
        self.assertAlmostEqual(fastest[len(fastest) * 3 // 4], speed, delta=0.15 * speed)

    def test_the_inertial_unit_feels_gravity_and_knows_the_tilt(self):
        imu, odometry = measured_now("imu", Imu), measured_now("odom", Odometry)
        felt = imu.linear_acceleration
        self.assertAlmostEqual(math.sqrt(felt.x**2 + felt.y**2 + felt.z**2), 9.81, delta=0.5)
        self.assertGreater(felt.z, 9.0)
        self.assertEqual(imu.header.frame_id, "base_link")
        for axis in "xyzw":
            tilt = getattr(imu.orientation, axis)
            self.assertAlmostEqual(tilt, getattr(odometry.pose.pose.orientation, axis), delta=0.02)

    def test_odometry_and_its_frame_agree_with_the_world(self):
        odometry, truth = measured_now("odom", Odometry), self.robot.true_pose()
        self.assertEqual((odometry.header.frame_id, odometry.child_frame_id), ("odom", "base_link"))
        self.assertAlmostEqual(odometry.pose.pose.position.z, truth.position.z, delta=0.01)
        self.assertAlmostEqual(odometry.twist.twist.linear.x, 0.0, delta=0.02)
        place, _ = self.frame("odom", "base_link")
        for axis in "xyz":
            self.assertAlmostEqual(getattr(place, axis), getattr(odometry.pose.pose.position, axis), delta=0.01)

    def test_the_footprint_lies_on_the_ground_between_the_feet(self):
        place, turn = self.frame("odom", "base_footprint")
        self.assertAlmostEqual(place.z, 0.0, delta=0.01)
        self.assertAlmostEqual(abs(turn.x) + abs(turn.y), 0.0, delta=0.005)
        # Of other frames the state publisher knows, by the model: an independent way to the same feet.
        (left, _), (right, _) = (self.frame("base_footprint", sole) for sole in ("l_sole", "r_sole"))
        for axis in "xy":
            self.assertAlmostEqual(getattr(left, axis) + getattr(right, axis), 0.0, delta=0.005)
        self.assertGreater(left.y, 0.04)
        self.assertAlmostEqual(min(left.z, right.z), 0.0, delta=0.005)
        self.frame("odom", "CameraTop_optical_frame")
