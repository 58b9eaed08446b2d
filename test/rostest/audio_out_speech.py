#!/usr/bin/env python3
"""Speech through the whole stack: how long it lasts, its words, how it is silenced, how it sounds."""

import sys
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutGoal
from nao_library_msgs.msg import AudioOutFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from sound_fixture import Loudspeakers, level, strongest_frequency  # noqa: E402

TEXT = "The quick brown fox jumps over the lazy dog."
WORDS = TEXT.rstrip(".").split()
# Simulated s that a message may take while time passes as fast as on a robot.
MESSAGE = 0.25
# Simulated s without a sound after each goal: the time that a client knows is a little behind, and the end of one text
# must not be taken for the beginning of the next.
SILENCE = 0.6
# Hz, and % of full scale: a tone that a voice drowns.
TONE, QUIET = 500.0, 2
SILENT = 1e-4


def f(function, text="", **fields):
    return AudioOutFunction(function=function, str_param=text, **fields)


class AudioOutSpeech(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("nao_audio_out", NaoAudioOutAction)
        cls.loudspeakers = Loudspeakers(cls.robot)
        # The voice takes a while for its first words.
        ready = send(cls.client, NaoAudioOutGoal([f("say", "Ready.")])).wait()
        assert ready.state == GoalStatus.SUCCEEDED, ready.text

    def setUp(self):
        self.robot.reset()

    def play(self, *functions):
        run = send(self.client, NaoAudioOutGoal(list(functions))).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.robot.advance(SILENCE)
        return run

    def span(self, run):
        """Simulated times of the first and the last sound of a goal that `play` played, s."""
        return self.loudspeakers.span(run.sent, run.ended + 0.5 * SILENCE)

    def until_word(self, run, word):
        wait_until(lambda: self.robot.module("ALMemory").ping() and word in words(run), 20.0, f"the word {word!r}")

    def test_a_goal_ends_when_its_text_is_said(self):
        with self.robot.at_speed(0.3):
            run = self.play(f("say", TEXT))
        first, last = self.span(run)
        self.assertLess(first - run.sent, MESSAGE)
        self.assertLess(run.ended - last, MESSAGE)
        self.assertGreater(last - first, 1.5)
        self.assertAlmostEqual(run.result.results[0].elapsed.to_sec(), last - first, delta=MESSAGE)

    def test_texts_of_a_chain_follow_each_other(self):
        pause = rospy.Duration.from_sec(0.5)
        with self.robot.at_speed(0.3):
            run = self.play(f("say", "One.", time=pause), f("say", "Two."))
        begins = [time for time, feedback in run.feedback if not feedback.word]
        self.assertEqual(len(begins), 2)
        middle = begins[1]
        self.assertLess(self.loudspeakers.level(middle - 0.4, middle - 0.1), SILENT)
        self.assertGreater(self.loudspeakers.level(run.sent, middle - 0.5), 0.01)
        self.assertGreater(self.loudspeakers.level(middle, run.ended), 0.01)

    def test_words_are_fed_back_while_they_are_spoken(self):
        with self.robot.at_speed(0.3):
            run = self.play(f("getVoice"), f("say", TEXT))
        wait_until(lambda: len(words(run)) >= len(WORDS), 10.0, lambda: f"all words; heard {words(run)}")
        told = [(time, feedback) for time, feedback in run.feedback if feedback.word]
        self.assertEqual([feedback.word.strip(".") for _, feedback in told], WORDS)
        self.assertEqual({(feedback.index, feedback.function, feedback.count) for _, feedback in told}, {(1, "say", 2)})
        self.assertEqual({feedback.sentence for _, feedback in told}, {TEXT})
        first, last = self.span(run)
        times = [time for time, _ in told]
        self.assertEqual(times, sorted(times))
        self.assertAlmostEqual(times[0], first, delta=MESSAGE)
        self.assertTrue(last - 1.0 < times[-1] < last + MESSAGE, (times[-1], last))

    def test_a_goal_that_is_cancelled_is_silent_at_once_and_nothing_else_is(self):
        tone = self.robot.module("ALAudioPlayer").playSine(int(TONE), QUIET, 0, 60.0, _async=True)
        with self.robot.at_speed(0.3):
            run = send(self.client, NaoAudioOutGoal([f("say", f"{TEXT} {TEXT}"), f("say", "never")]))
            self.until_word(run, "fox")
            cancelled = self.robot.advance(0.0)
            run.cancel()
            run.wait()
        self.assertEqual((run.state, run.text), (GoalStatus.PREEMPTED, "preempted in function 1 (say)"))
        self.robot.advance(3.0)
        before, _ = self.loudspeakers.played(cancelled - 0.5, cancelled)
        after, rate = self.loudspeakers.played(cancelled + MESSAGE, cancelled + 2.0)
        # A tone alone has one level all the time.
        alone = level(after)
        self.assertGreater(level(before), 2.0 * alone)
        for tenth in np.array_split(after, 10):
            self.assertAlmostEqual(level(tenth), alone, delta=0.02 * alone)
        self.assertAlmostEqual(strongest_frequency(after, rate), TONE, delta=1.0)
        self.assertFalse(tone.isFinished())
        tone.cancel()

    def test_a_new_goal_takes_the_place_of_the_text(self):
        with self.robot.at_speed(1.0):
            first = send(self.client, NaoAudioOutGoal([f("say", f"{TEXT} {TEXT}")]))
            self.until_word(first, "quick")
            second = self.play(f("say", "Stop."))
            first.wait()
        self.assertEqual(first.state, GoalStatus.PREEMPTED)
        self.assertEqual(words(second), ["Stop"])
        self.assertLess(second.ended - second.sent, 1.5)

    def test_how_a_text_is_spoken_is_for_this_text_only(self):
        speech = self.robot.module("ALTextToSpeech")
        before = (speech.getLanguage(), speech.getVoice(), speech.getVolume(), speech.getParameter("speed"))
        normal = self.play(f("say", TEXT))
        fast = self.play(f("say", TEXT, speed=200))
        quiet = self.play(f("say", TEXT, volume=0.25))
        low = self.play(f("say", TEXT, voice="rms"))
        french = self.play(f("say", "Bonjour tout le monde.", language="French"))
        again = self.play(f("say", TEXT))
        after = (speech.getLanguage(), speech.getVoice(), speech.getVolume(), speech.getParameter("speed"))
        self.assertEqual(after, before)
        spans = [self.span(run) for run in (normal, fast, quiet, low, french, again)]
        lengths = [last - first for first, last in spans]
        levels = [self.loudspeakers.level(*span) for span in spans]
        self.assertAlmostEqual(lengths[1] / lengths[0], 0.5, delta=0.1)
        self.assertAlmostEqual(levels[2] / levels[0], 0.25, delta=0.02)
        self.assertGreater(abs(lengths[3] / lengths[0] - 1.0), 0.02)
        self.assertAlmostEqual(lengths[5], lengths[0], delta=0.01)
        self.assertAlmostEqual(levels[5], levels[0], delta=0.02 * levels[0])

    def test_a_text_that_is_cancelled_gives_voice_and_volume_back(self):
        speech = self.robot.module("ALTextToSpeech")
        before = (speech.getVoice(), speech.getVolume())
        run = send(self.client, NaoAudioOutGoal([f("say", f"{TEXT} {TEXT}", voice="kal", volume=0.5)]))
        self.until_word(run, "brown")
        self.assertEqual((speech.getVoice(), speech.getVolume()), ("kal", 0.5))
        run.cancel()
        run.wait()
        self.assertEqual((speech.getVoice(), speech.getVolume()), before)

    def test_a_text_in_a_file_sounds_like_a_text_that_is_said(self):
        said = self.play(f("say", TEXT))
        run = self.play(f("sayToFile", TEXT, file_name="fox.wav"))
        self.assertEqual(run.result.files, ["fox.wav"])
        self.assertLess(self.loudspeakers.level(run.sent, run.ended), SILENT)
        played = self.play(f("playFile", "fox.wav"))
        self.assertAlmostEqual(run.result.durations[0], played.result.durations[0], delta=0.1)
        spans = [self.span(each) for each in (said, played)]
        lengths = [last - first for first, last in spans]
        levels = [self.loudspeakers.level(*span) for span in spans]
        self.assertAlmostEqual(lengths[0], lengths[1], delta=0.02)
        self.assertAlmostEqual(levels[0], levels[1], delta=0.05 * levels[0])

    def test_gestures_go_with_a_text(self):
        self.robot.module("ALMotion").setStiffnesses("Body", 1.0)
        run = send(
            self.client,
            NaoAudioOutGoal([f("animatedSay", f"^start(animations/Stand/Gestures/Hey_1) {TEXT}")]),
        )
        self.until_word(run, "jumps")
        moved = self.robot.module("ALMotion").getAngles("RArm", False)
        run.wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.robot.advance(3.0)
        ended = self.robot.module("ALMotion").getAngles("RArm", False)
        self.assertGreater(max(abs(a - b) for a, b in zip(moved, ended)), 0.1)

    def test_body_language_of_a_text_and_for_good(self):
        animated = self.robot.module("ALAnimatedSpeech")
        before = animated.getBodyLanguageModeToStr()
        run = self.play(
            f("setBodyLanguageMode", body_language="disabled", revert=True),
            f("animatedSay", "Hello.", body_language="random"),
            f("getBodyLanguageMode"),
        )
        self.assertEqual(run.result.memList, [before])
        wait_until(lambda: words(run) == ["Hello"], 10.0, lambda: f"the word; heard {words(run)}")

    def test_gestures_end_when_their_text_is_cancelled(self):
        motion = self.robot.module("ALMotion")
        motion.setStiffnesses("Body", 1.0)
        gesture = "^start(animations/Stand/Gestures/Hey_1)"
        run = send(self.client, NaoAudioOutGoal([f("animatedSay", f"{gesture} {TEXT} {TEXT}")]))
        self.until_word(run, "brown")
        run.cancel()
        self.assertEqual(run.wait().state, GoalStatus.PREEMPTED)
        self.robot.advance(4.0)
        at = motion.getAngles("RArm", False)
        self.robot.advance(1.0)
        self.assertLess(max(abs(a - b) for a, b in zip(at, motion.getAngles("RArm", False))), 0.01)


def words(run):
    """Words of a goal's feedback, in order."""
    return [feedback.word.strip(".") for _, feedback in list(run.feedback) if feedback.word]


if __name__ == "__main__":
    rospy.init_node("audio_out_speech_test")
    rostest.rosrun("nao_library_tests", "audio_out_speech", AudioOutSpeech)
