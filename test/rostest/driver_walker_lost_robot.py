#!/usr/bin/env python3
"""The robot is late, dies while it walks, and comes back: nao_walker says so, and walks again when told to."""

import sys
import threading
import unittest
from pathlib import Path

import rospy
import rostest
from geometry_msgs.msg import Pose2D, Twist
from std_srvs.srv import Empty

from nao_library_msgs.srv import CmdPoseService
from nao_sim_bridge.testing import wait_until
from naoqi import ALProxy
from naoqi.errors import NaoError

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from mortal_simulator import PORT, MortalSimulator  # noqa: E402

LIMIT = 60.0


class DriverWalkerLostRobot(MortalSimulator, unittest.TestCase):
    def setUp(self):
        self.addCleanup(self.kill)
        for name in ("cmd_pose_srv", "stop_walk_srv"):
            rospy.wait_for_service(name, 60.0)
        self.walk_to = rospy.ServiceProxy("cmd_pose_srv", CmdPoseService)
        self.stop = rospy.ServiceProxy("stop_walk_srv", Empty)

    def start(self):
        """Start a simulator, and have its robot stand up."""
        super().start()
        self.motion = ALProxy("ALMotion", "127.0.0.1", PORT, lazy=True)
        self.motion.connection.wait_connected(60.0)
        wait_until(lambda: self.succeeds(self.stop), LIMIT, "nao_walker and the robot")
        wait_until(lambda: self.succeeds(self.motion.wakeUp), LIMIT, "a robot that is awake")

    @staticmethod
    def succeeds(call):
        try:
            call()
        except (rospy.ServiceException, NaoError):
            return False
        return True

    def test_robot_that_is_late_dies_and_comes_back(self):
        with self.assertRaisesRegex(rospy.ServiceException, f"127.0.0.1:{PORT}"):
            self.walk_to(Pose2D(1.0, 0.0, 0.0))

        self.start()
        ends = []

        def walk():
            try:
                self.walk_to(Pose2D(3.0, 0.0, 0.0))
            except rospy.ServiceException as error:
                ends.append(str(error))

        thread = threading.Thread(target=walk, daemon=True)
        thread.start()
        wait_until(self.motion.moveIsActive, LIMIT, "a walk")
        self.kill()
        thread.join(60.0)
        self.assertRegex(ends[0], f"127.0.0.1:{PORT}")

        self.start()
        self.assertFalse(self.motion.moveIsActive())  # nobody walks by what was said before
        cmd_vel = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        wait_until(lambda: cmd_vel.get_num_connections() > 0, LIMIT, "nao_walker")
        twist = Twist()
        twist.linear.x = 0.5
        timer = rospy.Timer(rospy.Duration.from_sec(0.1), lambda _: cmd_vel.publish(twist))
        self.addCleanup(timer.shutdown)
        wait_until(self.motion.moveIsActive, LIMIT, "a walk")
        timer.shutdown()
        wait_until(lambda: not self.motion.moveIsActive(), LIMIT, "the end of the walk")


if __name__ == "__main__":
    rospy.init_node("driver_walker_lost_robot_test")
    rostest.rosrun("nao_library_tests", "driver_walker_lost_robot", DriverWalkerLostRobot)
