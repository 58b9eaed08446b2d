#!/usr/bin/env python3
"""Chains in simulated time, and preemption and cancel at every point of them."""

import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send

BRAIN = {f"Brain{i}": device for i, device in enumerate(("Front/Right/1", "Front/Right/0", "Middle/Right/0"))}
RED_EYE = "Face/Led/Red/Left/0Deg"


def led(name):
    return f"Head/Led/{BRAIN[name]}"


def intensity(light, value, seconds=0.0, revert=False):
    return LedFunction(
        function="setIntensity", lights=[light], i_values=[value], time=Duration.from_sec(seconds), revert=revert
    )


class ChainsAndPreemption(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoLights", NaoLedAction)

    def setUp(self):
        self.robot.reset()

    def test_functions_run_in_order_with_their_waits(self):
        waits = (0.5, 1.0, 0.75)
        chain = [intensity(f"Brain{i}", 0.1 * i, wait) for i, wait in enumerate(waits)]
        run = send(self.client, NaoLedGoal(chain)).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED)
        steps = [(f.index, f.function, f.count) for _, f in run.feedback]
        self.assertEqual(steps, [(i, "setIntensity", 3) for i in range(3)])
        times = [time for time, _ in run.feedback] + [run.ended]
        for wait, begin, end in zip(waits, times, times[1:]):
            self.assertAlmostEqual(end - begin, wait, delta=0.15)
        self.assertEqual([r.function for r in run.result.results], ["setIntensity"] * 3)

    def test_cancel_in_the_middle_of_a_wait(self):
        run = send(self.client, NaoLedGoal([intensity("Brain0", 0.3, 1000.0), intensity("Brain1", 0.3)]))
        self.robot.wait_for_leds({led("Brain0"): 0.3})
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertEqual([r.function for r in run.result.results], ["setIntensity"])
        self.assertEqual(self.robot.led(led("Brain1")), 1.0)

    def test_cancel_in_the_middle_of_a_fade_stops_it_there(self):
        fade = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=8.0)
        run = send(self.client, NaoLedGoal([fade]))
        run.wait_for_function(0)
        self.robot.wait_for_leds({led("Brain1"): 1.0})
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        stopped = self.robot.led(led("Brain0"))
        self.robot.advance(1.0)
        self.assertEqual(self.robot.led(led("Brain0")), stopped)
        self.assertGreater(stopped, 0.0)

    def test_revert_is_carried_out_when_cancelled(self):
        red = LedFunction(
            function="setColor", lights=["FaceLeds"], i_values=[0, 1, 0], time=Duration(1000), revert=True
        )
        run = send(self.client, NaoLedGoal([red]))
        self.robot.wait_for_leds({RED_EYE: 0.0})
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertEqual(self.robot.led(RED_EYE), 1.0)

    def test_a_new_goal_takes_over(self):
        first = send(self.client, NaoLedGoal([intensity("Brain0", 0.2, 1000.0)]))
        first.wait_for_function(0)
        second = send(self.client, NaoLedGoal([intensity("Brain1", 0.6)])).wait(10.0)
        first.wait(5.0)
        self.assertEqual((first.state, second.state), (GoalStatus.PREEMPTED, GoalStatus.SUCCEEDED))
        self.assertAlmostEqual(self.robot.led(led("Brain1")), 0.6)

    def test_cancel_between_functions_of_a_long_chain(self):
        run = send(self.client, NaoLedGoal([intensity("Brain0", (k % 10) / 10.0, 0.01) for k in range(2000)]))
        run.wait_for_function(5)
        run.cancel()
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertGreaterEqual(len(run.result.results), 5)
        self.assertLess(len(run.result.results), 2000)

    def test_races_of_goals_and_cancels_leave_the_server_alive(self):
        for k in range(30):
            run = send(self.client, NaoLedGoal([intensity("Brain0", 0.5, 1000.0 if k % 2 else 0.0)]))
            if k % 3 == 0:
                run.wait_for_function(0)
            run.cancel()
        last = send(self.client, NaoLedGoal([intensity("Brain2", 0.7)])).wait(10.0)
        self.assertEqual(last.state, GoalStatus.SUCCEEDED)


if __name__ == "__main__":
    rospy.init_node("chains_and_preemption_test")
    rostest.rosrun("nao_library_tests", "chains_and_preemption", ChainsAndPreemption)
