"""The robot dies while it walks, and comes back: nao_walker says so, and walks again when told to."""

import threading

import rospy
from geometry_msgs.msg import Pose2D, Twist
from mortal_simulator import PORT, LostRobotCase
from news import LIMIT
from std_srvs.srv import Empty

from nao_library_msgs.srv import CmdPoseService
from nao_sim_bridge.testing import wait_until
from naoqi import ALProxy
from naoqi.errors import NaoError


class LostWalker(LostRobotCase):
    def setUp(self):
        super().setUp()
        for name in ("cmd_pose_srv", "stop_walk_srv"):
            rospy.wait_for_service(name, LIMIT)
        self.walk_to = rospy.ServiceProxy("cmd_pose_srv", CmdPoseService)
        self.stop = rospy.ServiceProxy("stop_walk_srv", Empty)

    def stand_up(self):
        """Wait for a robot, and have it stand up."""
        self.motion = ALProxy("ALMotion", "127.0.0.1", PORT, lazy=True)
        self.motion.connection.wait_connected(LIMIT)
        wait_until(lambda: self.succeeds(self.stop), LIMIT, "nao_walker and the robot")
        wait_until(lambda: self.succeeds(self.motion.wakeUp), LIMIT, "a robot that is awake")

    @staticmethod
    def succeeds(call):
        try:
            call()
        except (rospy.ServiceException, NaoError):
            return False
        return True

    def test_robot_that_dies_and_comes_back(self):
        self.stand_up()
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
        thread.join(LIMIT)
        self.assertRegex(ends[0], f"127.0.0.1:{PORT}")

        self.start()
        self.stand_up()
        self.assertFalse(self.motion.moveIsActive())  # nobody walks by what was said before
        cmd_vel = self.kept(rospy.Publisher("cmd_vel", Twist, queue_size=1))
        wait_until(lambda: cmd_vel.get_num_connections() > 0, LIMIT, "nao_walker")
        twist = Twist()
        twist.linear.x = 0.5
        timer = rospy.Timer(rospy.Duration.from_sec(0.1), lambda _: cmd_vel.publish(twist))
        self.addCleanup(timer.shutdown)
        wait_until(self.motion.moveIsActive, LIMIT, "a walk")
        timer.shutdown()
        wait_until(lambda: not self.motion.moveIsActive(), LIMIT, "the end of the walk")
