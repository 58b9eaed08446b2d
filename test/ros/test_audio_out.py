#!/usr/bin/env python3
"""nao_audio_out through actionlib: words as feedback, silence after a cancel, settings that go back."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction
from nao_library_msgs.msg import AudioOutFunction
from nao_sim_bridge.testing import RobotTestCase, wait_until

TEXT = "The quick brown fox jumps over the lazy dog."
LONG = f"{10 * (TEXT + ' ')}And so the zebra sleeps."
"""Nobody is so late that the robot has said it all."""


def f(function, text="", **fields):
    return AudioOutFunction(function=function, str_param=text, **fields)


def words(run):
    return [feedback.word.strip(".") for _, feedback in run.feedback if feedback.word]


class AudioOut(RobotTestCase):
    server = ("nao_audio_out", NaoAudioOutAction)

    def until_word(self, run, word):
        wait_until(lambda: word in words(run), 60.0, f"the word {word!r}")

    def test_words_are_fed_back_while_they_are_spoken(self):
        with self.robot.at_speed(1.0):
            run = self.ends(self.send(f("getVoice"), f("say", TEXT)), GoalStatus.SUCCEEDED)
        wait_until(lambda: words(run) == TEXT.strip(".").split(), 60.0, lambda: f"all words; heard {words(run)}")
        told = {(feedback.index, feedback.function, feedback.count) for _, feedback in run.feedback if feedback.word}
        self.assertEqual(told, {(1, "say", 2)})
        self.assertEqual(run.result.memList, ["naoenu"])

    def test_a_cancel_in_the_middle_of_a_text_ends_it(self):
        with self.robot.at_speed(1.0):
            run = self.send(f("say", LONG), f("say", "never"))
            self.until_word(run, "fox")
            run.cancel()
            self.ends(run, GoalStatus.PREEMPTED)
        self.assertEqual(run.text, "preempted in function 1 (say)")
        self.assertNotIn("zebra", words(run))

    def test_a_newer_text_takes_the_place_of_the_older(self):
        older = self.send(f("say", LONG))
        self.until_word(older, "quick")
        newer = self.send(f("say", "Hello there."))
        self.ends(older, GoalStatus.PREEMPTED)
        self.ends(newer, GoalStatus.SUCCEEDED)
        self.assertEqual(words(newer), ["Hello", "there"])

    def test_settings_go_back_when_the_wait_is_cancelled(self):
        output = self.robot.module("ALAudioDevice")
        before = output.getOutputVolume()
        run = self.send(f("setOutputVolume", volume=10, revert=True, time=rospy.Duration(1000)))
        wait_until(lambda: output.getOutputVolume() == 10, 60.0, "the low volume")
        run.cancel()
        self.ends(run, GoalStatus.PREEMPTED)
        self.assertEqual(output.getOutputVolume(), before)

    def test_what_was_done_before_an_error_is_in_the_result(self):
        run = self.play(f("sayToFile", "Hello", file_name="hello.wav"), f("loadFile", "nowhere.wav"), f("say", "never"))
        self.ends(run, GoalStatus.ABORTED)
        self.assertRegex(run.text, r"function 2 \(loadFile\).*nowhere.wav")
        self.assertEqual(
            [(done.function, bool(done.error)) for done in run.result.results],
            [("sayToFile", False), ("loadFile", True)],
        )
        self.assertEqual(run.result.files, ["hello.wav"])
        self.assertRegex(self.refused(f("sayToFile", "a", file_name="../a.wav")), "leads out of the folder")


if __name__ == "__main__":
    rospy.init_node("audio_out_test")
    rostest.rosrun("nao_library_tests", "audio_out", AudioOut)
