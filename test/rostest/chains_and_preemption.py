#!/usr/bin/env python3
"""Chains in simulated time, and preemption and cancel at every point of them."""

import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

BRAIN = {f"Brain{i}": device for i, device in enumerate(("Front/Right/1", "Front/Right/0", "Middle/Right/0"))}
RED_EYE = "Face/Led/Red/Left/0Deg"


def led(name):
    return f"Head/Led/{BRAIN[name]}"


def intensity(light, value, seconds=0.0, revert=False):
    return LedFunction(
        function="setIntensity", lights=[light], i_values=[value], time=Duration.from_sec(seconds), revert=revert
    )


def fade_out(light, seconds):
    return LedFunction(function="fade", lights=[light], i_values=[0.0], duration=seconds)


class ChainsAndPreemption(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoLights", NaoLedAction)

    def setUp(self):
        self.robot.reset()

    def assert_preempted(self, run, done, interrupted=None):
        """It ends at once, and its result tells what was done.

        The function in whose wait it was interrupted may have taken effect on the robot without its answer being there
        yet: then it counts as not done.
        """
        run.wait(5.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
        self.assertIn([r.function for r in run.result.results], (done, [*done, interrupted]))

    def wait_for_the_middle_of_the_fade(self, light):
        wait_until(lambda: self.robot.led(led(light)) < 0.95, 10.0, "the fade")

    def test_functions_run_in_order_with_their_waits(self):
        waits = (0.2, 0.6, 0.4)
        chain = [intensity(f"Brain{i}", 0.1 * i, wait) for i, wait in enumerate(waits)]
        with self.robot.at_speed(0.2):
            run = send(self.client, NaoLedGoal(chain)).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED)
        steps = [(f.index, f.function, f.count) for _, f in run.feedback]
        self.assertEqual(steps, [(i, "setIntensity", 3) for i in range(3)])
        times = [time for time, _ in run.feedback] + [run.ended]
        for wait, begin, end in zip(waits, times, times[1:]):
            self.assertAlmostEqual(end - begin, wait, delta=0.15)
        self.assertEqual([r.function for r in run.result.results], ["setIntensity"] * 3)

    def test_cancel_in_the_middle_of_a_wait(self):
        lit = LedFunction(function="on", lights=["ChestLeds"])
        run = send(self.client, NaoLedGoal([lit, intensity("Brain0", 0.3, 1000.0), intensity("Brain1", 0.3)]))
        self.robot.wait_for_leds({led("Brain0"): 0.3})
        run.cancel()
        self.assert_preempted(run, ["on"], interrupted="setIntensity")
        self.assertEqual(self.robot.led(led("Brain1")), 1.0)

    def test_cancel_in_the_middle_of_a_fade_stops_it_there(self):
        run = send(self.client, NaoLedGoal([intensity("Brain1", 0.4), fade_out("Brain0", 20.0)]))
        self.wait_for_the_middle_of_the_fade("Brain0")
        run.cancel()
        self.assert_preempted(run, ["setIntensity"])
        stopped = self.robot.led(led("Brain0"))
        self.robot.advance(1.0)
        self.assertEqual(self.robot.led(led("Brain0")), stopped)
        self.assertGreater(stopped, 0.0)

    def test_a_new_goal_in_the_middle_of_a_fade_stops_it_there(self):
        first = send(self.client, NaoLedGoal([fade_out("Brain0", 20.0), intensity("Brain1", 0.4)]))
        self.wait_for_the_middle_of_the_fade("Brain0")
        second = send(self.client, NaoLedGoal([intensity("Brain2", 0.5)])).wait(10.0)
        self.assert_preempted(first, [])
        self.assertEqual(second.state, GoalStatus.SUCCEEDED)
        stopped = self.robot.led(led("Brain0"))
        self.robot.advance(1.0)
        found = self.robot.leds(led(f"Brain{i}") for i in range(3))
        self.assertEqual(found, {led("Brain0"): stopped, led("Brain1"): 1.0, led("Brain2"): 0.5})
        self.assertGreater(stopped, 0.0)

    def test_revert_is_carried_out_when_cancelled(self):
        green = LedFunction(
            function="setColor", lights=["FaceLeds"], i_values=[0, 1, 0], time=Duration(1000), revert=True
        )
        run = send(self.client, NaoLedGoal([green]))
        self.robot.wait_for_leds({RED_EYE: 0.0})
        run.cancel()
        self.assert_preempted(run, [], interrupted="setColor")
        self.assertEqual(self.robot.led(RED_EYE), 1.0)

    def test_revert_is_carried_out_before_a_new_goal_begins(self):
        half = intensity("Brain0", 0.5, 1000.0, revert=True)
        first = send(self.client, NaoLedGoal([intensity("Brain0", 0.8), half]))
        self.robot.wait_for_leds({led("Brain0"): 0.5})
        look = LedFunction(function="getIntensity", lights=["Brain0"])
        second = send(self.client, NaoLedGoal([look])).wait(10.0)
        self.assert_preempted(first, ["setIntensity"], interrupted="setIntensity")
        self.assertEqual(second.state, GoalStatus.SUCCEEDED)
        self.assertAlmostEqual(float(second.result.results[0].values[0]), 0.8)

    def test_a_new_goal_takes_over(self):
        first = send(self.client, NaoLedGoal([intensity("Brain0", 0.2, 1000.0)]))
        self.robot.wait_for_leds({led("Brain0"): 0.2})
        second = send(self.client, NaoLedGoal([intensity("Brain1", 0.6)])).wait(10.0)
        self.assert_preempted(first, [], interrupted="setIntensity")
        self.assertEqual(second.state, GoalStatus.SUCCEEDED)
        self.assertAlmostEqual(self.robot.led(led("Brain1")), 0.6)

    def test_a_chain_is_preempted_between_its_functions(self):
        chain = NaoLedGoal([intensity("Brain0", (k % 10) / 10.0, 0.01) for k in range(2000)])
        for how in ("a cancel", "a new goal"):
            run = send(self.client, chain).wait_for_function(5)
            if how == "a cancel":
                run.cancel()
            else:
                send(self.client, NaoLedGoal([intensity("Brain1", 0.6)])).wait(10.0)
            run.wait(5.0)
            self.assertEqual(run.state, GoalStatus.PREEMPTED, how)
            self.assertGreaterEqual(len(run.result.results), 5, how)
            self.assertLess(len(run.result.results), 2000, how)

    def test_races_of_goals_and_cancels_leave_the_server_alive(self):
        for k in range(30):
            run = send(self.client, NaoLedGoal([intensity("Brain0", 0.5, 1000.0 if k % 2 else 0.0)]))
            if k % 3 == 0:
                run.wait_for_function(0)
            run.cancel()
        self.assert_takes_goals()

    def test_goals_that_chase_each_other_leave_the_server_alive(self):
        runs = [send(self.client, NaoLedGoal([intensity("Brain0", 0.5, 1000.0)])) for _ in range(30)]
        self.assert_takes_goals()
        ends = {run.wait(10.0).state for run in runs}
        self.assertLessEqual(ends, {GoalStatus.PREEMPTED, GoalStatus.RECALLED})

    def assert_takes_goals(self):
        last = send(self.client, NaoLedGoal([intensity("Brain2", 0.7)])).wait(10.0)
        self.assertEqual(last.state, GoalStatus.SUCCEEDED)


if __name__ == "__main__":
    rospy.init_node("chains_and_preemption_test")
    rostest.rosrun("nao_library_tests", "chains_and_preemption", ChainsAndPreemption)
