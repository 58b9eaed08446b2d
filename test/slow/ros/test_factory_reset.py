"""A simulator that begins anew under a running stack: the clock goes on, and modules and driver come back."""

import pytest
import rospy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from nao_library_actions.msg import NaoLedAction
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import RobotTestCase, wait_until

HALF = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])


class FactoryReset(RobotTestCase):
    server = ("NaoLights", NaoLedAction)

    @pytest.fixture(autouse=True)
    def _leave_the_usual_world(self, stack):
        yield
        stack.broken = True  # the next case is not to meet nodes that are about to come back

    def test_the_robots_time_begins_anew_the_clock_goes_on_and_nodes_come_back(self):
        simulation = self.robot.module("NaoSimulation")
        self.robot.module("ALLeds").createGroup("Mine", ["Brain0"])
        before = self.robot.advance(100.0)
        self.robot.factory_reset(world="lab")
        self.assertIn("ball", simulation.objectPoses())
        self.assertLess(simulation.time(), 50.0)
        self.assertNotIn("Mine", self.robot.module("ALLeds").listGroups())
        self.assertGreaterEqual(rospy.wait_for_message("/clock", Clock, 60.0).clock.to_sec(), before)
        # A goal that meets the moment in which its server notices is aborted; those after it are not.
        wait_until(lambda: self.play(HALF).text == "", 60.0, "NaoLights and the robot")
        wait_until(lambda: self.robot.led("Head/Led/Front/Right/1") == 0.5, 60.0, "the light")
        state = rospy.wait_for_message("joint_states", JointState, 60.0)
        self.assertGreaterEqual(state.header.stamp.to_sec(), before)
        with self.assertRaisesRegex(ValueError, "labb"):
            self.robot.factory_reset(world="labb")
        self.assertIn("ball", simulation.objectPoses())
