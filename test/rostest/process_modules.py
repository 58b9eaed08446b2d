#!/usr/bin/env python3
"""Process modules as a launch file starts them: designators come by the action and by the topic."""

import sys
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from std_msgs.msg import String

from nao_library_actions.msg import PerformDesignatorAction, PerformDesignatorGoal
from nao_sim_bridge.testing import RobotTestCase, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from services import action_client  # noqa: E402

LIMIT = 60.0


class ProcessModules(RobotTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.client = action_client("perform_designator", PerformDesignatorAction)

    def setUp(self):
        super().setUp()
        self.robot.module("ALMotion").wakeUp()

    def perform(self, text, state):
        return self.ends(send(self.client, PerformDesignatorGoal(text, "", [])), state)

    def test_the_gripper_is_opened_and_closed_by_designators_of_the_thesis(self):
        for word, opening in (("open", 1.0), ("close", 0.0)):
            self.perform(f"(type: action(name:(to {word})) (side :left))", GoalStatus.SUCCEEDED)
            self.assertAlmostEqual(self.robot.module("ALMotion").getAngles("LHand", True)[0], opening, delta=0.1)

    def test_a_hand_that_cannot_get_there_is_a_failure_with_a_name(self):
        run = self.perform("{type: reaching, side: left, target: [0.6, 0.13, 0.08]}", GoalStatus.ABORTED)
        self.assertEqual(run.result.failure, "ManipulationPoseUnreachable")

    def test_a_sentence_by_the_topic_is_said(self):
        said = []
        subscriber = self.robot.module("ALMemory").subscriber("ALTextToSpeech/CurrentSentence")
        self.addCleanup(subscriber.signal.disconnect, subscriber.signal.connect(said.append))
        self.publisher("designators", String).publish("{type: saying, text: Here I am.}")
        wait_until(lambda: "Here I am." in said, LIMIT, "the sentence on the robot")


if __name__ == "__main__":
    rospy.init_node("designators_test")
    rostest.rosrun("nao_library_tests", "designators", ProcessModules)
