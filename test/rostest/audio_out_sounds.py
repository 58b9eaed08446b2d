#!/usr/bin/env python3
"""Files and tones through the whole stack: how long, how loud, from which side; loops, pauses, the background."""

import sys
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
import soundfile
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutGoal
from nao_library_msgs.msg import AudioOutFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from sound_fixture import SILENT, Loudspeakers, level, recording, strongest_frequency  # noqa: E402

RATE = 48000
LENGTH, TONE, LEVEL = 1.5, 440.0, 0.25
FILE = "tone.wav"
MESSAGE = 0.25
# So far, in simulated s, the time that a client knows may be behind.
BEHIND = 0.2


def f(function, text="", **fields):
    return AudioOutFunction(function=function, str_param=text, **fields)


class AudioOutSounds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("nao_audio_out", NaoAudioOutAction)
        cls.loudspeakers = Loudspeakers(cls.robot)
        recording(FILE).parent.mkdir(parents=True, exist_ok=True)
        time = np.arange(int(LENGTH * RATE)) / RATE
        tone = LEVEL * np.sqrt(2.0) * np.sin(2.0 * np.pi * TONE * time)
        soundfile.write(str(recording(FILE)), tone, RATE, subtype="PCM_16")

    def setUp(self):
        self.robot.reset()

    def send(self, *functions):
        return send(self.client, NaoAudioOutGoal(list(functions)))

    def play(self, *functions):
        run = self.send(*functions).wait()
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.robot.advance(2.0 * BEHIND)
        return run

    def heard(self, run):
        """Samples of what sounded during a goal, from the first sound to the last, and their rate."""
        return self.loudspeakers.played(*self.loudspeakers.span(run.sent, run.ended + BEHIND))

    def until_heard(self, seconds):
        """Let time pass, and tell when that was, s."""
        now = self.robot.advance(seconds)
        return now - seconds, now

    def test_a_file_is_played_to_its_end(self):
        with self.robot.at_speed(1.0):
            run = self.play(f("playFile", FILE))
        samples, rate = self.heard(run)
        self.assertAlmostEqual(len(samples) / rate, LENGTH, delta=0.02)
        self.assertAlmostEqual(strongest_frequency(samples, rate), TONE, delta=1.0)
        self.assertAlmostEqual(level(samples), LEVEL, delta=0.02 * LEVEL)
        self.assertAlmostEqual(run.ended - run.sent, LENGTH, delta=MESSAGE)
        self.assertEqual(run.result.files, [FILE])
        self.assertAlmostEqual(run.result.durations[0], LENGTH, delta=MESSAGE)

    def test_volumes_multiply_and_sides_are_told_apart(self):
        output = self.robot.module("ALAudioDevice")
        before = output.getOutputVolume()
        short = {"duration": 0.5}
        cases = [
            (f("playFile", FILE, volume=0.5, **short), 0.5, 0.5),
            (f("playFile", FILE, pan=-1.0, **short), 1.0, 0.0),
            (f("playFile", FILE, pan=1.0, volume=0.2, **short), 0.0, 0.2),
        ]
        for function, left, right in cases:
            samples, _ = self.heard(self.play(function))
            middle = samples[len(samples) // 4 : -len(samples) // 4]
            self.assertAlmostEqual(level(middle[:, 0]), left * LEVEL, delta=0.02 * LEVEL)
            self.assertAlmostEqual(level(middle[:, 1]), right * LEVEL, delta=0.02 * LEVEL)
        run = self.play(
            f("setOutputVolume", volume=50, revert=True),
            f("setOutputVolume", volume=50),
            f("setMasterVolume", volume=0.5, revert=True, time=rospy.Duration(0)),
            f("playFile", FILE),
            f("getOutputVolume"),
            f("setOutputVolume", volume=before),
        )
        self.assertEqual(run.result.memList, ["50"])
        self.assertEqual(run.result.volume, before)
        samples, _ = self.heard(run)
        self.assertAlmostEqual(level(samples), 0.5 * LEVEL, delta=0.02 * LEVEL)

    def test_a_muted_robot_takes_as_long_and_is_not_heard(self):
        run = self.play(f("muteAudioOut", enable=True), f("playFile", FILE), f("isAudioOutMuted"))
        self.assertEqual(run.result.memList, ["True"])
        self.assertAlmostEqual(run.result.results[1].elapsed.to_sec(), LENGTH, delta=1.0)
        self.assertLess(self.loudspeakers.level(run.sent, run.ended), SILENT)
        run = self.play(f("muteAudioOut", enable=False), f("playFile", FILE))
        self.assertAlmostEqual(level(self.heard(run)[0]), LEVEL, delta=0.02 * LEVEL)

    def test_tones_have_their_frequency_and_their_length(self):
        for frequency in (220, 1000, 4000):
            run = self.play(f("playSine", frequency=frequency, volume=0.5, duration=0.8))
            samples, rate = self.heard(run)
            self.assertAlmostEqual(strongest_frequency(samples, rate), frequency, delta=2.0)
            self.assertAlmostEqual(len(samples) / rate, 0.8, delta=0.05)

    def test_a_loop_sounds_for_its_duration(self):
        run = self.play(f("playFileInLoop", FILE, duration=2 * LENGTH + 0.5))
        samples, rate = self.heard(run)
        self.assertAlmostEqual(len(samples) / rate, 2 * LENGTH + 0.5, delta=0.6)
        self.assertAlmostEqual(level(samples), LEVEL, delta=0.03 * LEVEL)

    def test_a_loop_without_duration_sounds_until_it_is_stopped(self):
        run = self.play(f("playFileInLoop", FILE))
        self.assertLess(run.ended - run.sent, LENGTH)
        span = self.until_heard(2.5 * LENGTH)
        self.assertAlmostEqual(self.loudspeakers.level(*span), LEVEL, delta=0.03 * LEVEL)
        self.play(f("stopAll"))
        self.assertLess(self.loudspeakers.level(*self.until_heard(1.0)), SILENT)

    def test_what_a_goal_began_is_silent_when_it_is_cancelled_or_fails(self):
        waiting = self.send(f("playFileInLoop", FILE), f("waitUntilSilent"))
        waiting.wait_for_function(1)
        self.robot.advance(0.5)
        waiting.cancel()
        self.assertEqual(waiting.wait().state, GoalStatus.PREEMPTED)
        self.assertLess(self.loudspeakers.level(*self.until_heard(1.0)), SILENT)
        failing = self.send(f("playFileInLoop", FILE), f("loadFile", "nowhere.wav")).wait()
        self.assertEqual(failing.state, GoalStatus.ABORTED)
        self.assertIn("nowhere.wav", failing.text)
        self.assertLess(self.loudspeakers.level(*self.until_heard(1.0)), SILENT)

    def test_a_file_is_cut_off_where_it_is_cancelled(self):
        with self.robot.at_speed(1.0):
            run = self.send(f("playFile", FILE))
            run.wait_for_function(0)
            player = self.robot.module("ALAudioPlayer")
            wait_until(lambda: len(player.getLoadedFilesIds()) > 0, 10.0, "the sound")
            cancelled = self.robot.advance(0.4)
            run.cancel()
            run.wait()
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        self.assertEqual(run.result.files, [FILE])
        self.assertLess(run.result.durations[0], LENGTH)
        self.robot.advance(LENGTH)
        first, last = self.loudspeakers.span(run.sent, cancelled + LENGTH)
        self.assertLess(last - cancelled, MESSAGE)
        self.assertLess(last - first, LENGTH - 0.1)

    def test_a_loaded_sound_is_played_paused_and_moved(self):
        run = self.play(
            f("loadFile", FILE),
            f("getFileLength", FILE),
            f("goTo", FILE, position=1.0),
            f("getCurrentPosition", FILE),
            f("play", FILE, volume=0.5),
            f("play", FILE, volume=0.5, background=True, time=rospy.Duration.from_sec(0.3)),
            f("pause", FILE, time=rospy.Duration.from_sec(0.3)),
            f("play", FILE),
            f("getLoadedFilesNames"),
            f("unloadFile", FILE),
            f("getLoadedFilesIds"),
        )
        number, length, position, *names = run.result.memList
        self.assertGreater(int(number), 0)
        self.assertAlmostEqual(float(length), LENGTH, places=3)
        self.assertAlmostEqual(float(position), 1.0, places=3)
        self.assertEqual(names, [FILE])
        elapsed = [result.elapsed.to_sec() for result in run.result.results]
        self.assertAlmostEqual(elapsed[4], LENGTH - 1.0, delta=0.5)
        self.assertLess(elapsed[7], LENGTH - 0.1)

    def test_a_text_over_a_file_in_the_background(self):
        with self.robot.at_speed(1.0):  # words that follow each other closely come in any order
            run = self.play(
                f("playFileInLoop", FILE, volume=0.5),
                f("say", "I sing while I work."),
                f("stopAll"),
            )
        words = lambda: [b.word.strip(".") for _, b in run.feedback if b.word]  # noqa: E731
        wait_until(lambda: words() == "I sing while I work".split(), 10.0, lambda: f"all words; heard {words()}")
        self.assertLess(self.loudspeakers.level(*self.until_heard(1.0)), SILENT)
        samples, rate = self.heard(run)
        self.assertAlmostEqual(strongest_frequency(samples, rate), TONE, delta=2.0)
        self.assertGreater(level(samples), 0.55 * LEVEL)

    def test_sound_sets(self):
        installed = self.play(f("getInstalledSoundSetsList")).result.memList
        self.assertTrue(installed)
        files = self.play(f("getSoundSetFileNames", installed[0])).result.memList
        run = self.play(f("loadSoundSet", installed[0]), f("playSoundSetFile", installed[0], file_name=files[0]))
        self.assertGreater(level(self.heard(run)[0]), 0.005)


if __name__ == "__main__":
    rospy.init_node("audio_out_sounds_test")
    rostest.rosrun("nao_library_tests", "audio_out_sounds", AudioOutSounds)
