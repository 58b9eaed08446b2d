#!/usr/bin/env python3
"""NaoLights through actionlib: end states, feedback and results over the wire, preemption from other clients."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedActionGoal, NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import RobotTestCase, wait_until

RED_EYE = "Face/Led/Red/Left/0Deg"
BRAIN = {"Brain0": "Head/Led/Front/Right/1", "Brain1": "Head/Led/Front/Right/0", "Brain2": "Head/Led/Middle/Right/0"}


def intensity(light, value, wait=0.0, **fields):
    time = rospy.Duration.from_sec(wait)
    return LedFunction(function="setIntensity", lights=[light], i_values=[value], time=time, **fields)


class Lights(RobotTestCase):
    server = ("NaoLights", NaoLedAction)

    def brain(self, light):
        return self.robot.led(BRAIN[light])

    def test_a_chain_succeeds_with_feedback_of_each_function_and_its_results(self):
        run = self.play(intensity("Brain0", 0.25), intensity("Brain1", 0.5), LedFunction(function="ping"))
        self.ends(run, GoalStatus.SUCCEEDED)
        wait_until(lambda: len(run.feedback) == 3, 60.0, "the feedback, which has a topic of its own")
        steps = [(feedback.index, feedback.function, feedback.count) for _, feedback in run.feedback]
        self.assertEqual(steps, [(0, "setIntensity", 3), (1, "setIntensity", 3), (2, "ping", 3)])
        self.assertEqual([result.function for result in run.result.results], ["setIntensity", "setIntensity", "ping"])
        self.assertEqual(dict(zip(run.result.lights, run.result.intensities)), {"Brain0": 0.25, "Brain1": 0.5})
        self.assertEqual(run.result.memList, ["True"])
        self.assertEqual((self.brain("Brain0"), self.brain("Brain1")), (0.25, 0.5))

    def test_a_bad_chain_aborts_before_it_begins_and_the_server_takes_the_next(self):
        text = self.refused(intensity("Brain0", 0.5), intensity("Brain1", 1.5))
        self.assertRegex(text, r"function 2 \(setIntensity\): field i_values: 1.5 is not allowed")
        self.assertEqual(self.brain("Brain0"), 1.0)
        self.succeed(intensity("Brain0", 0.5))

    def test_a_cancel_ends_the_wait_and_reverts(self):
        green = LedFunction(
            function="setColor", lights=["FaceLeds"], str_param="green", time=rospy.Duration(1000), revert=True
        )
        run = self.send(intensity("Brain0", 0.25), green)
        self.robot.wait_for_leds({RED_EYE: 0.0})
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        self.assertEqual(run.text, "preempted in function 2 (setColor)")
        self.assertEqual(run.result.results[0].function, "setIntensity")
        self.assertEqual((self.robot.led(RED_EYE), self.brain("Brain0")), (1.0, 0.25))

    def test_a_newer_goal_takes_over_after_the_revert_of_the_older(self):
        older = self.send(intensity("Brain0", 0.5, wait=1000.0, revert=True))
        self.robot.wait_for_leds({BRAIN["Brain0"]: 0.5})
        result = self.succeed(LedFunction(function="getIntensity", lights=["Brain0"]))
        self.ends(older, GoalStatus.PREEMPTED)
        self.assertEqual(result.results[0].values, ["1.0"])

    def test_a_client_whose_clock_is_ahead_locks_nobody_out(self):
        publisher = rospy.Publisher("NaoLights/goal", NaoLedActionGoal, queue_size=1)
        self.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0, 60.0, "NaoLights")
        early = NaoLedActionGoal(goal=NaoLedGoal([intensity("Brain0", 0.25)]))
        early.goal_id.stamp = rospy.Time.now() + rospy.Duration(10000)
        publisher.publish(early)
        self.robot.wait_for_leds({BRAIN["Brain0"]: 0.25})
        self.succeed(intensity("Brain0", 0.5))

    def test_goals_and_cancels_that_chase_each_other_all_end_and_leave_the_server_alive(self):
        runs = [self.send(intensity("Brain0", 0.5, wait=1000.0)) for _ in range(20)]
        for position in range(10):
            runs.append(self.send(intensity("Brain1", 0.5, wait=1000.0 * (position % 2))))
            runs[-1].cancel()
        self.succeed(intensity("Brain2", 0.75))
        ends = {run.wait().state for run in runs}
        self.assertLessEqual(ends, {GoalStatus.PREEMPTED, GoalStatus.RECALLED, GoalStatus.SUCCEEDED})
        self.assertEqual(self.brain("Brain2"), 0.75)


if __name__ == "__main__":
    rospy.init_node("lights_test")
    rostest.rosrun("nao_library_tests", "lights", Lights)
