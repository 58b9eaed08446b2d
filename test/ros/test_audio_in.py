#!/usr/bin/env python3
"""nao_audio_in through actionlib: the robot hears what it says itself."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioInAction, NaoAudioOutAction, NaoAudioOutGoal
from nao_library_msgs.msg import AudioInFunction, AudioOutFunction
from nao_sim_bridge.testing import RobotTestCase, send, wait_until


def f(function, **fields):
    return AudioInFunction(function=function, **fields)


class AudioIn(RobotTestCase):
    server = ("nao_audio_in", NaoAudioInAction)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.voice = cls.robot.action_client("nao_audio_out", NaoAudioOutAction)

    def listen(self, **fields):
        """Send a goal, and come back when the robot hears for it."""
        run = self.send(f("listen", **fields))
        wait_until(lambda: any(told.status == "listening" for _, told in run.feedback), 60.0, "feedback: listening")
        return run

    def test_listening_ends_with_the_word_that_was_said(self):
        run = self.listen(vocabulary=["hello", "goodbye"], timeout=60.0)
        spoken = send(self.voice, NaoAudioOutGoal([AudioOutFunction(function="say", str_param="hello")]))
        spoken.wait()
        self.ends(run, GoalStatus.SUCCEEDED)
        self.assertEqual((run.result.words, run.result.memList), (["hello"], []))
        self.assertGreater(run.result.confidences[0], 0.3)
        (said,) = spoken.result.results
        self.assertAlmostEqual(run.result.onsets[0].to_sec(), said.onset.to_sec(), delta=0.06)
        self.assertAlmostEqual(run.result.ends[0].to_sec(), said.offset.to_sec(), delta=0.06)

    def test_a_cancel_ends_the_listening_and_its_subscription(self):
        run = self.listen(vocabulary=["hello"], timeout=1000.0)
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        self.assertEqual(self.robot.module("ALSpeechRecognition").getSubscribersInfo(), [])

    def test_a_wrong_goal_opens_no_ear(self):
        self.assertRegex(self.refused(f("listen", vocabulary=[], timeout=1.0)), "field vocabulary")
        self.assertEqual(self.robot.module("ALSpeechRecognition").getSubscribersInfo(), [])


if __name__ == "__main__":
    rospy.init_node("audio_in_test")
    rostest.rosrun("nao_library_tests", "audio_in", AudioIn)
