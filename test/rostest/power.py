#!/usr/bin/env python3
"""Battery and heat of the robot: it drains, is charged, gets hot, and goals are refused with what is wrong."""

import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from std_srvs.srv import SetBool

from nao_library_msgs.srv import SetFloat
from nao_sim_bridge.testing import wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from motion_fixture import MotionTest, f  # noqa: E402
from services import service  # noqa: E402

BATTERY = "Device/SubDeviceList/Battery/"
CHARGE, CURRENT = f"{BATTERY}Charge/Sensor/Value", f"{BATTERY}Current/Sensor/Value"
PATIENCE = 20.0
# The boards tell something new ten times a second.
SOON = 0.3


NOD = f("angleInterpolationWithSpeed", names=["HeadPitch"], angles=[0.2], speed=0.5)
STEP = f("moveTo", values=[0.05, 0.0, 0.0])


class Power(MotionTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.simulation = cls.robot.module("NaoSimulation")
        cls.plug = service("nao_sim/plug_charger", SetBool, PATIENCE)
        cls.charge = service("nao_sim/set_battery", SetFloat, PATIENCE)

    def setUp(self):
        super().setUp()
        self.play(f("wakeUp"))

    def refused(self, *functions):
        run = self.send(*functions).wait()
        self.assertEqual(run.state, GoalStatus.ABORTED)
        return run.text

    def set_charge(self, value):
        answer = self.charge(value)
        self.assertTrue(answer.success, answer.message)
        self.robot.advance(SOON)

    def plug_in(self, plugged):
        self.assertTrue(self.plug(plugged).success)
        self.robot.advance(SOON)

    def value(self, key):
        return self.robot.value(key)

    def test_the_battery_drains_and_is_charged(self):
        self.set_charge(0.5)
        before = self.value(CHARGE)
        self.robot.advance(5.0)
        self.assertLess(self.value(CHARGE), before)
        self.assertLess(self.value(CURRENT), 0.0)
        self.assertEqual(self.robot.module("ALBattery").getBatteryCharge(), 50)
        self.plug_in(True)
        before = self.value(CHARGE)
        self.robot.advance(5.0)
        self.assertGreater(self.value(CHARGE), before)
        self.assertGreater(self.value(CURRENT), 0.0)
        self.assertTrue(self.value("BatteryChargingFlagChanged"))
        self.plug_in(False)
        self.assertFalse(self.value("BatteryChargingFlagChanged"))

    def test_a_walk_is_refused_with_a_low_battery_and_other_motion_is_not(self):
        self.set_charge(0.04)
        self.assertIn("the battery is too low to walk (4% left): plug the charger in", self.refused(STEP))
        self.play(NOD)
        self.plug_in(True)
        self.play(STEP)

    def test_an_empty_battery_brings_the_robot_to_rest_until_it_is_charged(self):
        self.set_charge(0.01)
        wait_until(lambda: not self.value("robotIsWakeUp"), PATIENCE, "the robot to rest")
        self.assertIn("is empty", self.value("BatteryEmpty"))
        self.assertIn("the battery is empty (1% left): plug the charger in", self.refused(f("wakeUp")))
        self.assertIn("no stiffness in", self.play_limp())
        self.plug_in(True)
        self.set_charge(0.3)
        self.play(f("wakeUp"), NOD)

    def play_limp(self):
        """What a goal says that would move limp joints of a robot that rests."""
        self.plug_in(True)
        return self.refused(NOD)

    def test_a_hot_joint_is_moved_slowly_a_very_hot_one_not_at_all(self):
        self.simulation.setTemperature("HeadPitch", 71.0)
        self.robot.advance(SOON)
        self.assertEqual(self.value("HotJointDetected"), ["HeadPitch"])
        fast = f("angleInterpolationWithSpeed", names=["HeadPitch"], angles=[0.3], speed=1.0)
        self.play(fast)
        self.simulation.setTemperature("HeadPitch", 79.0)
        self.robot.advance(SOON)
        self.assertEqual(self.robot.module("ALBodyTemperature").getTemperatureDiagnosis(), [1, ["Head"]])
        self.assertIn("too hot to move: HeadPitch", self.refused(fast))
        self.play(f("setAngles", names=["LShoulderPitch"], angles=[1.0]))

    def test_a_motion_whose_joints_get_too_hot_ends_and_says_so(self):
        turn = f("angleInterpolation", names=["LShoulderPitch"], angles=[0.5], times=[20.0])
        run = self.send(turn).wait_for_function(0)
        self.simulation.setTemperature("LShoulderPitch", 79.0)
        run.wait(PATIENCE)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("the robot put LArm to rest: a motor is too hot or broken, or the battery is empty", run.text)

    def test_wrong_charges_are_refused(self):
        answer = self.charge(1.5)
        self.assertFalse(answer.success)
        self.assertIn("charge is 1.5, allowed is 0 to 1", answer.message)


if __name__ == "__main__":
    rospy.init_node("power_test")
    rostest.rosrun("nao_library_tests", "power", Power)
