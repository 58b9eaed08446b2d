"""What scenarios of NaoMotion share: goals for a robot that begins each test anew."""

import unittest

from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import MotionFunction
from nao_sim_bridge.testing import SimulatedRobot, send

SENSOR = "Device/SubDeviceList/{}/Position/Sensor/Value"
LIMIT = 60.0


def f(function, **fields):
    return MotionFunction(function=function, **fields)


class MotionTest(unittest.TestCase):
    """Sends goals to NaoMotion, and looks at what the joints measure."""

    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoMotion", NaoMotionAction)

    def setUp(self):
        self.robot.reset()

    def send(self, *functions):
        return send(self.client, NaoMotionGoal(list(functions)))

    def play(self, *functions):
        """The result of a goal that succeeds."""
        run = self.send(*functions).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def angle(self, joint):
        """As the robot measures it, rad."""
        return self.robot.value(SENSOR.format(joint))
