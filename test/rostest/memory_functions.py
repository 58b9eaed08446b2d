#!/usr/bin/env python3
"""The memory functions that every module has, through NaoLights, against the robot's ALMemory."""

import json
import threading
import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction, MemoryEvent
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

ACCELEROMETER = "Device/SubDeviceList/InertialSensor/AccelerometerZ/Sensor/Value"


class MemoryFunctions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoLights", NaoLedAction)

    def ask(self, *calls):
        chain = [LedFunction(function=function, str_param=parameter) for function, parameter in calls]
        run = send(self.client, NaoLedGoal(chain)).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result.memList

    def test_data_goes_in_and_out(self):
        answers = self.ask(("insertData", 'Test/Answer=[1, 2.5, "three"]'), ("getData", "Test/Answer"))
        self.assertEqual(json.loads(answers[-1]), [1, 2.5, "three"])
        self.assertEqual(self.robot.value("Test/Answer"), [1, 2.5, "three"])
        self.assertIn("Test/Answer", self.ask(("getDataList", "Test/")))
        self.assertEqual(self.ask(("getType", "Test/Answer"))[-1], "Data")
        self.assertEqual(len(self.ask(("getTimestamp", "Test/Answer"))), 3)
        self.ask(("removeData", "Test/Answer"))
        self.assertNotIn("Test/Answer", self.ask(("getDataList", "Test/")))

    def test_sensors_of_the_robot(self):
        self.assertAlmostEqual(float(self.ask(("getData", ACCELEROMETER))[-1]), 9.81, delta=0.4)
        values = self.ask(("getListData", f"{ACCELEROMETER},RobotConfig/Body/Type"))
        self.assertEqual(values[1], "Nao")

    def test_events_of_the_robot_come_as_a_topic(self):
        arrived, messages = threading.Event(), []

        def on_event(message):
            messages.append(message)
            arrived.set()

        topic = rospy.Subscriber("memory_events", MemoryEvent, on_event)
        self.ask(("subscribeToEvent", "Test/Hello"), ("subscribeToEvent", "Test/Event"))

        def heard():
            self.robot.module("ALMemory").raiseEvent("Test/Hello", 0)
            return arrived.wait(0.5)

        # A publisher may take up a connection a moment after its subscriber counts it.
        wait_until(heard, 10.0, "the connection to memory_events")
        self.ask(("unsubscribeToEvent", "Test/Hello"))
        self.robot.module("ALMemory").raiseEvent("Test/Event", [1, "a"])
        told = lambda: [m for m in list(messages) if m.name != "Test/Hello"]  # noqa: E731
        wait_until(told, 10.0, "the event")
        self.assertEqual([(m.name, json.loads(m.value)) for m in told()], [("Test/Event", [1, "a"])])
        self.assertIn("Test/Event", self.ask(("getEventList", "")))
        self.assertEqual(json.loads(self.ask(("getEventHistory", "Test/Event"))[-1])[0], [1, "a"])
        # The first event must not come any more; the second, raised after it, shows that it would have.
        self.ask(("unsubscribeToEvent", "Test/Event"), ("subscribeToEvent", "Test/Later"))
        self.robot.module("ALMemory").raiseEvent("Test/Event", [2, "b"])
        self.robot.module("ALMemory").raiseEvent("Test/Later", None)
        wait_until(lambda: told()[-1].name == "Test/Later", 10.0, "the later event")
        self.assertEqual([message.name for message in told()], ["Test/Event", "Test/Later"])
        self.ask(("unsubscribeToEvent", "Test/Later"))
        topic.unregister()

    def test_events_raised_through_a_goal_reach_the_robot(self):
        self.ask(("raiseEvent", "Test/FromGoal=42"), ("raiseMicroEvent", "Test/Micro=true"))
        self.assertEqual(self.robot.value("Test/FromGoal"), 42)
        self.assertIn("Test/Micro", self.ask(("getMicroEventList", "")))

    def test_ping(self):
        self.assertEqual(self.ask(("ping", ""))[-1], "True")


if __name__ == "__main__":
    rospy.init_node("memory_functions_test")
    rostest.rosrun("nao_library_tests", "memory_functions", MemoryFunctions)
