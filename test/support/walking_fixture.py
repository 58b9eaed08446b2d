"""What scenarios share in which nodes let the robot walk: it begins each test on its feet, and ends it at rest."""

import unittest

from nao_library_modules.core.geometry import Place, yaw_of_quaternion
from nao_sim_bridge.testing import SimulatedRobot


def seen_from_above(position, orientation):
    """A position and a quaternion of messages, on the floor."""
    return Place(position.x, position.y, yaw_of_quaternion(orientation.x, orientation.y, orientation.z, orientation.w))


def of_pose(pose):
    return seen_from_above(pose.position, pose.orientation)


class WalkingTest(unittest.TestCase):
    """Lets the robot walk."""

    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.motion = cls.robot.module("ALMotion")

    def setUp(self):
        self.robot.reset()
        self.motion.wakeUp()
        self.robot.advance(0.5)

    def tearDown(self):
        self.assertFalse(self.motion.moveIsActive(), "the robot still walks")

    def truth(self):
        """Where the torso really is, in world."""
        return of_pose(self.robot.true_pose())
