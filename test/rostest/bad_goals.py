#!/usr/bin/env python3
"""Bad goals: each ends that goal with a text that says what is wrong, changes nothing, and leaves the server ready."""

import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import SimulatedRobot, send

HALF = {"function": "setIntensity", "lights": ["Brain0"], "i_values": [0.5]}
BRAIN0 = "Head/Led/Front/Right/1"


class BadGoals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("NaoLights", NaoLedAction)

    def setUp(self):
        self.robot.reset()

    def play(self, *functions):
        return send(self.client, NaoLedGoal([LedFunction(**fields) for fields in functions])).wait()

    def assert_refused(self, words, *functions):
        run = self.play(*functions)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        for word in words:
            self.assertIn(word, run.text)
        self.assertEqual(self.robot.led(BRAIN0), 1.0, "a refused goal changed a light")
        good = self.play({"function": "listGroups"})
        self.assertEqual(good.state, GoalStatus.SUCCEEDED, "the server takes no goals any more")

    def test_unknown_function_names_the_closest(self):
        self.assert_refused(["setIntensty", "setIntensity"], {**HALF, "function": "setIntensty"})

    def test_unknown_light_names_the_closest(self):
        self.assert_refused(["LeftFaceLed", "LeftFaceLeds"], {**HALF, "lights": ["LeftFaceLed"]})

    def test_value_out_of_range_names_value_and_range(self):
        self.assert_refused(["i_values", "1.5", "1"], {**HALF, "i_values": [1.5]})

    def test_wrong_count_tells_how_many(self):
        self.assert_refused(["i_values", "3", "2"], {**HALF, "lights": ["Brain0", "Brain1"], "i_values": [0, 0, 0]})

    def test_negative_time(self):
        self.assert_refused(["time", "-1"], {**HALF, "time": Duration(-1)})

    def test_no_lights(self):
        self.assert_refused(["lights"], {**HALF, "lights": []})

    def test_colour_for_a_light_that_has_none(self):
        self.assert_refused(["Brain0"], {"function": "setColor", "lights": ["Brain0"], "i_values": [1, 0, 0]})

    def test_empty_chain(self):
        self.assert_refused(["empty"])

    def test_a_mistake_in_the_third_function_keeps_the_first_from_running(self):
        bad = {**HALF, "i_values": [-1]}
        run = self.play(HALF, HALF, bad)
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("function 3", run.text)
        self.assertEqual(self.robot.led(BRAIN0), 1.0)
        self.assertEqual(run.result.results, [])

    def test_an_error_of_the_robot_keeps_the_results_before_it(self):
        run = self.play(HALF, {"function": "getData", "str_param": "no/such/key"}, {**HALF, "i_values": [0.1]})
        self.assertEqual(run.state, GoalStatus.ABORTED)
        for word in ("function 2", "getData", "no/such/key"):
            self.assertIn(word, run.text)
        self.assertEqual([done.function for done in run.result.results], ["setIntensity", "getData"])
        self.assertEqual(run.result.results[0].error, "")
        self.assertIn("no/such/key", run.result.results[1].error)
        self.assertEqual(self.robot.led(BRAIN0), 0.5)

    def test_a_function_that_fails_is_skipped_when_the_goal_says_so(self):
        missing = {"function": "getData", "str_param": "no/such/key", "on_error": "skip"}
        run = self.play(HALF, missing, {**HALF, "i_values": [0.25]})
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertEqual([bool(done.error) for done in run.result.results], [False, True, False])
        self.assertEqual(self.robot.led(BRAIN0), 0.25)


if __name__ == "__main__":
    rospy.init_node("bad_goals_test")
    rostest.rosrun("nao_library_tests", "bad_goals", BadGoals)
