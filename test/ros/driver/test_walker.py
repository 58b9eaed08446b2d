"""Walking under the names of nao_robot: velocities and their watchdog, targets, steps, stop, inhibition, the end."""

import math
import os
import signal
import subprocess
import sys
import unittest

import rospkg
import rospy
from geometry_msgs.msg import Pose2D, Twist
from news import Reports
from rosgraph_msgs.msg import Log
from rospy import Duration
from services import answer, service
from std_msgs.msg import Empty as EmptyMessage
from std_srvs.srv import Empty
from waits import PATIENCE

from nao_library_modules.ros.node import call_for
from nao_library_msgs.msg import StepTarget
from nao_library_msgs.srv import (
    CmdPoseService,
    CmdVelService,
    SetArmsEnabled,
    StepTargetService,
)
from nao_sim_bridge.testing import SimulatedRobot, wait_until

LIMIT = 60.0
"""Wall time to wait for something, s."""
TIMEOUT = 0.5
"""The driver's ~cmd_vel_timeout, s."""


def velocity(x=0.0, y=0.0, turn=0.0):
    twist = Twist()
    twist.linear.x, twist.linear.y, twist.angular.z = x, y, turn
    return twist


class DriverWalker(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.motion = cls.robot.module("ALMotion")
        cls.cmd_vel = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        cls.cmd_pose = rospy.Publisher("cmd_pose", Pose2D, queue_size=1, tcp_nodelay=True)
        cls.cmd_step = rospy.Publisher("cmd_step", StepTarget, queue_size=10, tcp_nodelay=True)
        for publisher in (cls.cmd_vel, cls.cmd_pose, cls.cmd_step):
            wait_until(lambda p=publisher: p.get_num_connections() > 0, LIMIT, f"subscriber of {publisher.name}")
        cls.stop = service("stop_walk_srv", Empty)
        cls.walk_to = service("cmd_pose_srv", CmdPoseService)
        wait_until(lambda: answer(cls.stop) == "", LIMIT, "nao_walker and the robot")

    def setUp(self):
        self.stop()
        self.robot.reset()
        self.motion.wakeUp()

    def where(self):
        """x, y (m) and heading (rad) of the torso, in world, as they really are."""
        pose = self.robot.true_pose()
        turn = pose.orientation
        heading = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
        return pose.position.x, pose.position.y, heading

    def forward(self):
        return self.where()[0]

    def upright(self):
        return self.robot.true_pose().position.z > 0.28

    def publishing(self, twist, period=0.1):
        """Send a velocity again and again, in simulated time, until the returned timer is shut down."""
        timer = rospy.Timer(Duration.from_sec(period), lambda _: self.cmd_vel.publish(twist))
        self.addCleanup(timer.shutdown)
        return timer

    def wait_for_walk(self, active=True):
        wait_until(lambda: self.motion.moveIsActive() is active, LIMIT, "a walk" if active else "the end of the walk")

    def wait_for_report(self, commanded):
        """Until /diagnostics has that the robot walks, as it was commanded."""

        def told(status):
            values = {pair.key: pair.value for pair in status.values}
            return values.get("robot") == "walks" and values["commanded"].startswith(commanded)

        reports = Reports()
        try:
            reports.wait("nao_walker: walk", told)
        finally:
            reports.subscriber.unregister()

    # --- velocities -----------------------------------------------------------------------------------------------

    def test_an_obstacle_ends_a_stream_of_velocities_for_good_and_the_log_says_so(self):
        simulation = self.robot.module("NaoSimulation")
        simulation.placeObject("{name: wall, box: [0.1, 2.0, 1.0], position: [0.7, 0.0, 0.5]}")
        self.addCleanup(simulation.removeObject, "wall")
        told = []
        log = rospy.Subscriber("/rosout", Log, lambda line: told.append(line.msg))
        self.addCleanup(log.unregister)
        self.publishing(velocity(x=1.0))
        wait_until(lambda: any("does not walk on: an obstacle" in text for text in told), LIMIT, "the line in the log")
        self.robot.advance(15.0)
        self.assertLess(self.forward(), 0.4)

    def test_a_velocity_walks_and_the_watchdog_stops_it(self):
        timer = self.publishing(velocity(x=0.8))
        wait_until(lambda: self.forward() > 0.15, LIMIT, "15 cm of walk")
        timer.shutdown()
        self.robot.pause()  # the last command comes now, and none of those before comes later
        self.addCleanup(self.robot.resume)
        ceased = self.robot.advance(0.0)
        self.wait_for_report("walking at (0.80")
        self.cmd_vel.publish(velocity(x=0.6))
        self.wait_for_report("walking at (0.60")
        self.wait_for_walk()
        self.robot.resume()
        self.wait_for_walk(active=False)
        self.assertGreater(self.robot.advance(0.0) - ceased, TIMEOUT - 0.05)
        x, y, _ = self.where()
        self.robot.advance(2.0)
        self.assertAlmostEqual(self.where()[0], x, delta=0.01)
        self.assertAlmostEqual(y, 0.0, delta=0.08)
        self.assertTrue(self.upright())

    def test_bad_velocities(self):
        self.cmd_vel.publish(velocity(x=float("nan")))
        with self.assertRaisesRegex(rospy.ServiceException, "linear.y: inf is not allowed: -1 to 1"):
            service("cmd_vel_srv", CmdVelService)(velocity(y=float("inf")))
        self.robot.advance(1.0)
        self.assertFalse(self.motion.moveIsActive())
        timer = self.publishing(velocity(x=7.0))  # taken as 1
        self.wait_for_walk()
        timer.shutdown()

    def test_gait_parameters_and_the_pose_for_walking(self):
        read, needs_pose = service("read_foot_gait_config_srv", Empty), "needs_start_walk_pose_srv"
        for name, value in (
            ("use_foot_gait_config", True),
            ("foot_gait_config", {"MaxStepX": 0.03}),
            ("use_walk_pose", True),
        ):
            rospy.set_param(f"nao_walker/{name}", value)
            self.addCleanup(rospy.delete_param, f"nao_walker/{name}")
        read()
        service(needs_pose, Empty)()
        self.walk_to(Pose2D(0.1, 0.0, 0.0))
        self.assertAlmostEqual(self.forward(), 0.1, delta=0.03)
        rospy.set_param("nao_walker/foot_gait_config", {"MaxStepsX": 0.03})
        self.addCleanup(read)
        self.addCleanup(rospy.set_param, "nao_walker/foot_gait_config", {})
        read()
        with self.assertRaisesRegex(rospy.ServiceException, "MaxStepsX.*MaxStepX"):
            self.walk_to(Pose2D(0.1, 0.0, 0.0))
        rospy.set_param("nao_walker/foot_gait_config", "fast")
        with self.assertRaisesRegex(rospy.ServiceException, "foot_gait_config is 'fast'"):
            read()

    # --- targets and steps ----------------------------------------------------------------------------------------

    def test_bad_targets_move_nothing(self):
        with self.assertRaisesRegex(rospy.ServiceException, r"pose.x: nan is not allowed: -100\.\.100 m"):
            self.walk_to(Pose2D(float("nan"), 0.0, 0.0))
        with self.assertRaisesRegex(rospy.ServiceException, "leg"):
            service("cmd_step_srv", StepTargetService)(StepTarget(Pose2D(0.0, 0.1, 0.0), 2))
        self.assertFalse(self.motion.moveIsActive())

    def test_arms_swing_as_asked(self):
        service("enable_arms_walking_srv", SetArmsEnabled)(False, True)
        self.addCleanup(self.motion.setMoveArmsEnabled, True, True)
        self.assertEqual([self.motion.getMoveArmsEnabled(arm) for arm in ("LArm", "RArm")], [False, True])

    def test_the_robot_stands_while_its_head_scans(self):
        scan = rospy.Publisher("start_scan", EmptyMessage, queue_size=1)
        wait_until(lambda: scan.get_num_connections() > 0, LIMIT, "subscriber of start_scan")
        self.cmd_pose.publish(Pose2D(5.0, 0.0, 0.0))
        self.wait_for_walk()
        with self.robot.at_speed(0.5):
            scan.publish()
            wait_until(lambda: self.motion.getAngles("HeadPitch", True)[0] > 0.45, LIMIT, "the head looking down")
            self.robot.pause()
            self.addCleanup(self.robot.resume)
            self.assertFalse(self.motion.moveIsActive())
            with self.assertRaisesRegex(rospy.ServiceException, "a head scan is under way"):
                self.walk_to(Pose2D(0.1, 0.0, 0.0))
            self.robot.resume()
        wait_until(lambda: answer(lambda: self.walk_to(Pose2D(0.0, 0.0, 0.0))) == "", LIMIT, "the end of the scan")
        self.assertAlmostEqual(self.motion.getAngles("HeadPitch", True)[0], 0.38, delta=0.03)

    # --- inhibition -----------------------------------------------------------------------------------------------

    def call_as_another(self, name):
        subprocess.run(["rosservice", "call", rospy.resolve_name(name)], check=True, timeout=PATIENCE)

    def test_inhibition_stops_the_walk_and_refuses_commands(self):
        self.publishing(velocity(x=0.8))
        self.wait_for_walk()
        self.call_as_another("inhibit_walk")
        self.assertFalse(self.motion.moveIsActive())
        self.robot.advance(1.0)  # with velocities coming all the time
        self.assertFalse(self.motion.moveIsActive())
        for name in ("inhibit_walk", "uninhibit_walk"):  # the second as it is called for a node that has died
            call_for(rospy.resolve_name(name), "/path")
        with self.assertRaisesRegex(rospy.ServiceException, "walking is inhibited by /rosservice"):
            self.walk_to(Pose2D(0.3, 0.0, 0.0))
        service("uninhibit_walk", Empty)()
        self.wait_for_walk()

    # --- the node -------------------------------------------------------------------------------------------------

    def test_diagnostics_tell_what_it_does(self):
        self.publishing(velocity(x=0.5))
        self.wait_for_walk()

        with self.robot.at_speed(0.5):  # commands that come too late have it stand for a moment
            self.wait_for_report("walking at (0.50")

    def test_the_end_of_the_node_stops_the_walk(self):
        program = rospkg.RosPack().get_path("nao_library_modules") + "/nodes/nao_walker"
        command = [sys.executable, program, "--pport", str(self.robot.port), "__ns:=second", "_cmd_vel_timeout:=0"]
        node = subprocess.Popen(command, env=dict(os.environ))
        self.addCleanup(node.kill)
        rospy.wait_for_service("second/cmd_vel_srv", 60.0)
        walk = rospy.ServiceProxy("second/cmd_vel_srv", CmdVelService)
        wait_until(lambda: self.in_reach(walk), LIMIT, "the second node and the robot")
        self.wait_for_walk()
        wait_until(lambda: self.forward() > 0.05, LIMIT, "5 cm of walk")
        node.send_signal(signal.SIGINT)
        node.wait(LIMIT)
        self.assertFalse(self.motion.moveIsActive())
        self.assertTrue(self.upright())

    @staticmethod
    def in_reach(walk):
        try:
            walk(velocity(x=0.6))
        except rospy.ServiceException:
            return False
        return True
