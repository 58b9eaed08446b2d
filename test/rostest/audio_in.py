#!/usr/bin/env python3
"""Hearing through the whole stack: words, recordings, directions of sounds in the room, and what ends when."""

import sys
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
import soundfile
from actionlib_msgs.msg import GoalStatus
from rospy import Duration

from nao_library_actions.msg import (
    NaoAudioInAction,
    NaoAudioInGoal,
    NaoAudioOutAction,
    NaoAudioOutGoal,
)
from nao_library_msgs.msg import AudioInFunction, AudioOutFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from cases import case  # noqa: E402
from sound_fixture import Room, bursts, delay, level, noise, recording, strongest_frequency  # noqa: E402

VOCABULARY = [
    "yes", "no", "hello", "goodbye", "stop", "one", "two", "three", "four", "five",
    "red", "green", "blue", "left", "right", "stand up", "sit down", "good morning", "come here", "thank you",
    "what is your name", "play music", "turn around", "yellow", "follow me", "open your hand", "look at me",
    "wave", "tell me a story", "help",
]  # fmt: skip
# Most of them have to be understood: at least so many of the thirty.
UNDERSTOOD = 28
# m, in the frame of the head, in the order of a recording's channels.
MICROPHONES = np.array([
    [-0.0215, 0.0558, 0.0774], [-0.0215, -0.0558, 0.0774], [0.0206, 0.0309, 0.0986], [0.0206, -0.0309, 0.0986],
])  # fmt: skip
SPEED_OF_SOUND = 343.0
BEARINGS = [0, 45, 90, 135, 180, -135, -90, -45]
EXTRACTORS = ("ALSpeechRecognition", "ALSoundDetection", "ALSoundLocalization")
WAIT = Duration(1000)
# s that a robot which has begun to listen needs before it hears.
LISTENS_AFTER = 0.5
# s in which the bip of a robot that has stopped to listen is over.
BIP = 0.5


def f(function, **fields):
    return AudioInFunction(function=function, **fields)


def say(text):
    return AudioOutFunction(function="say", str_param=text)


class AudioIn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.ears = cls.robot.action_client("nao_audio_in", NaoAudioInAction)
        cls.voice = cls.robot.action_client("nao_audio_out", NaoAudioOutAction)
        cls.room = Room(cls.robot)

    def setUp(self):
        self.robot.reset()
        self.room.clear()

    def tearDown(self):
        self.play(f("stopRecognition"), f("disableEnergyComputation"))
        for module in EXTRACTORS:
            self.assertEqual(self.robot.module(module).getSubscribersInfo(), [], module)

    def play(self, *functions, state=GoalStatus.SUCCEEDED):
        run = send(self.ears, NaoAudioInGoal(list(functions))).wait(120.0)
        self.assertEqual(run.state, state, run.text)
        return run.result if state == GoalStatus.SUCCEEDED else run

    def begin(self, *functions, module):
        """Send a goal and wait until the robot hears for it."""
        run = send(self.ears, NaoAudioInGoal(list(functions)))
        subscribers = self.robot.module(module).getSubscribersInfo
        wait_until(subscribers, 20.0, f"a subscriber of {module}")
        # Its bip is not heard, and it has to learn how loud the background is.
        self.robot.advance(LISTENS_AFTER)
        return run

    def speak(self, *functions):
        run = send(self.voice, NaoAudioOutGoal(list(functions))).wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)

    # Words

    def test_own_speech_is_understood_by_own_ears(self):
        wrong = []
        for phrase in VOCABULARY:
            listen = f("listen", vocabulary=VOCABULARY, timeout=8.0)
            run = self.begin(listen, module="ALSpeechRecognition")
            self.speak(say(phrase))
            run.wait(60.0)
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
            if run.result.words[:1] != [phrase]:
                wrong.append((phrase, run.result.words))
        print(f"understood {len(VOCABULARY) - len(wrong)} of {len(VOCABULARY)}; not: {wrong}")
        self.assertGreaterEqual(len(VOCABULARY) - len(wrong), UNDERSTOOD, wrong)

    def test_listening_ends_with_the_word_and_tells_what_it_hears_meanwhile(self):
        run = self.begin(f("listen", vocabulary=["hello", "goodbye"], timeout=60.0), module="ALSpeechRecognition")
        self.speak(say("hello"))
        run.wait(30.0)
        self.assertEqual((run.state, run.result.words), (GoalStatus.SUCCEEDED, ["hello"]))
        self.assertTrue(0.0 < run.result.confidences[0] <= 1.0)
        self.assertLess(run.ended - run.sent, 20.0)
        self.assertIn("SpeechDetected", [feedback.status for _, feedback in run.feedback])
        self.assertIn(["hello"], [feedback.words for _, feedback in run.feedback])

    def test_silence_and_noise_are_no_words(self):
        listen = f("listen", vocabulary=VOCABULARY, timeout=8.0)
        run = send(self.ears, NaoAudioInGoal([listen])).wait(60.0)
        self.assertEqual((run.state, run.result.words), (GoalStatus.SUCCEEDED, []))
        self.assertAlmostEqual(run.ended - run.sent, 8.0, delta=2.0)
        self.room.place("noise", noise(3.0), self.room.around(1.0, 0.5), level_db=65.0, loop=True)
        self.assertEqual(self.play(listen).words, [])

    def test_a_person_is_understood(self):
        run = self.begin(f("listen", vocabulary=VOCABULARY, timeout=20.0), module="ALSpeechRecognition")
        self.room.person_says("stand up", self.room.around(1.0, 0.6))
        self.assertEqual(run.wait(60.0).result.words[:1], ["stand up"])

    def test_words_that_cannot_be_pronounced_are_told_and_nothing_stays(self):
        run = self.play(f("listen", vocabulary=["yes", "привет"]), state=GoalStatus.ABORTED)
        self.assertRegex(run.text, "^function 1 .listen.: .*no English pronunciation of the word 'привет'")

    def test_the_vocabulary_of_another_program_is_back_afterwards(self):
        recogniser = self.robot.module("ALSpeechRecognition")
        recogniser.setVocabulary(["red", "green"], False)
        recogniser.subscribe("another program")
        try:
            self.assertEqual(self.play(f("listen", vocabulary=["yes"], timeout=1.0)).words, [])
            self.robot.advance(LISTENS_AFTER)
            self.speak(say("green"))
            wait_until(
                lambda: self.robot.value("WordRecognized")[:1] == ["green"], 20.0, "the word of the other program"
            )
        finally:
            recogniser.unsubscribe("another program")

    def test_a_recognition_goes_on_after_its_goal_until_it_is_stopped(self):
        self.play(f("startRecognition", vocabulary=["hello", "goodbye"]))
        self.robot.advance(LISTENS_AFTER)
        self.speak(say("goodbye"))
        wait_until(lambda: self.robot.value("WordRecognized")[:1] == ["goodbye"], 20.0, "the word")
        self.play(f("stopRecognition"))

    # Recordings

    def record_while(self, action, seconds, **fields):
        """Record while something sounds; samples, rate and the file's message."""
        with self.robot.at_speed(0.5):  # the recording begins and ends a few ms late, and the sound comes in time
            run = send(self.ears, NaoAudioInGoal([f("record", duration=seconds, **fields)])).wait_for_function(0)
            wait_until(lambda: any(told.status == "recording" for _, told in run.feedback), 20.0, "the recording")
            action()
            run.wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        (file,) = run.result.files
        samples, rate = soundfile.read(str(recording(file.path)), always_2d=True)
        return samples, rate, file

    def test_what_the_loudspeakers_play_is_what_the_microphones_record(self):
        levels = {}
        for volume in (0.5, 0.25):
            tone = AudioOutFunction(function="playSine", frequency=800.0, volume=volume, duration=1.0)
            samples, rate, file = self.record_while(lambda t=tone: self.speak(t), 2.5, str_param="tone.wav", rate=48000)
            self.assertEqual((rate, samples.shape[1], len(file.channels)), (48000, 4, 4))
            self.assertAlmostEqual(len(samples) / rate, 2.5, delta=0.3)
            self.assertAlmostEqual(file.duration, len(samples) / rate, delta=0.3)
            self.assertAlmostEqual(strongest_frequency(samples, rate), 800.0, delta=2.0)
            block = rate // 50
            envelope = [level(samples[i : i + block]) for i in range(0, len(samples), block)]
            loud = [value for value in envelope if value > max(envelope) / 2]
            self.assertAlmostEqual(len(loud) / 50, 1.0, delta=0.1)
            levels[volume] = float(np.median(loud))
        self.assertAlmostEqual(levels[0.5] / levels[0.25], 2.0, delta=0.1)

    def test_one_microphone_at_a_low_rate_and_as_ogg(self):
        tone = AudioOutFunction(function="playSine", frequency=500.0, volume=0.3, duration=1.0)
        for name in ("low.wav", "low.ogg"):
            samples, rate, file = self.record_while(lambda: self.speak(tone), 1.5, str_param=name, channels=["rear"])
            self.assertEqual((rate, samples.shape[1], file.channels), (16000, 1, ["rear"]))
            self.assertAlmostEqual(strongest_frequency(samples, rate), 500.0, delta=2.0)

    def test_channels_are_as_late_as_the_way_of_the_sound_is_long(self):
        for bearing in BEARINGS:
            place = self.room.around(1.5, np.radians(bearing), height=0.2)
            self.room.place("noise", noise(1.0), place, level_db=70.0, loop=True)
            samples, rate, _ = self.record_while(lambda: None, 1.0, str_param="delays.wav", rate=48000)
            self.room.remove("noise")
            distances = np.linalg.norm(MICROPHONES - self.room.in_head(place), axis=1)
            for i, j in ((0, 1), (0, 2), (1, 3), (2, 3)):
                expected = (distances[j] - distances[i]) / SPEED_OF_SOUND
                found = delay(samples[-rate // 2 :, i], samples[-rate // 2 :, j], rate)
                self.assertAlmostEqual(found, expected, delta=2e-5, msg=f"{bearing} degrees, channels {i} and {j}")

    def test_a_recording_goes_on_after_its_goal_until_it_is_stopped(self):
        self.play(f("startRecording", str_param="day/long.wav"))
        run = self.play(f("record", str_param="second.wav", duration=1.0), state=GoalStatus.ABORTED)
        self.assertIn("stopRecording comes first", run.text)
        self.robot.advance(3.0)
        (file,) = self.play(f("stopRecording")).files
        info = soundfile.info(str(recording("day/long.wav")))
        self.assertGreaterEqual(info.duration, 2.9)
        self.assertAlmostEqual(info.duration, file.duration, delta=0.3)

    # Sounds

    def test_directions_of_sounds_all_around(self):
        right = []
        for bearing in BEARINGS:
            place = self.room.around(1.5, np.radians(bearing), height=0.1)
            run = self.begin(f("localizeSound", timeout=15.0, duration=1.0), module="ALSoundLocalization")
            self.room.place("bursts", bursts(), place, level_db=70.0, loop=True)
            run.wait(60.0)
            self.room.remove("bursts")
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
            self.assertEqual(len(run.result.sounds), 1, f"nothing heard at {bearing} degrees")
            sound = run.result.sounds[0]
            x, y, _ = self.room.in_head(place)
            missing = angle_between(sound.azimuth, np.arctan2(y, x))
            print(f"{bearing} degrees: off by {np.degrees(missing):.1f}, confidence {sound.confidence:.2f}")
            right.append(abs(missing) < np.radians(10.0))
            self.assertEqual((sound.header.frame_id, sound.base_frame), ("Head", "base_footprint"))
        self.assertGreaterEqual(sum(right), len(BEARINGS) - 1)

    def test_a_head_that_is_turned_hears_the_place_in_the_same_direction_of_the_base(self):
        motion = self.robot.module("ALMotion")
        motion.setStiffnesses("Head", 1.0)
        place = self.room.around(1.5, 0.8, height=0.1)
        found = {}
        for yaw in (0.0, 0.6):
            motion.angleInterpolationWithSpeed("HeadYaw", yaw, 0.5)
            run = self.begin(f("localizeSound", timeout=15.0, duration=1.0), module="ALSoundLocalization")
            self.room.place("bursts", bursts(), place, level_db=70.0, loop=True)
            (found[yaw],) = run.wait(60.0).result.sounds
            self.room.remove("bursts")
        self.assertAlmostEqual(found[0.0].azimuth - found[0.6].azimuth, 0.6, delta=0.15)
        self.assertAlmostEqual(found[0.0].base_azimuth, found[0.6].base_azimuth, delta=0.15)

    def test_a_sound_that_begins_is_detected_and_silence_is_not(self):
        quiet = self.play(f("detectSound", timeout=3.0))
        self.assertEqual(quiet.sounds, [])
        run = self.begin(f("detectSound", timeout=15.0), module="ALSoundDetection")
        self.room.place("bursts", bursts(), self.room.around(1.0, 0.0), level_db=75.0, loop=True)
        (sound,) = run.wait(60.0).result.sounds
        self.assertFalse(sound.located)

    def test_it_is_louder_on_the_side_of_a_sound_and_louder_than_before(self):
        quiet = dict(zip(*self.energies()))
        self.room.place("noise", noise(2.0), self.room.around(0.5, np.pi / 2), level_db=75.0, loop=True)
        loud = dict(zip(*self.energies()))
        self.assertEqual(list(loud), ["left", "right", "front", "rear"])
        for name in loud:
            self.assertGreater(loud[name], 3.0 * quiet[name])
        self.assertGreater(loud["left"], loud["right"])

    def energies(self):
        result = self.play(f("getEnergy", duration=0.6))
        return result.microphones, result.energies

    # What ends when

    def test_every_function_that_takes_time_is_preempted(self):
        functions = {
            "record": f("record", str_param="cut.wav", duration=1000.0),
            "listen": f("listen", vocabulary=VOCABULARY, timeout=1000.0),
            "detectSound": f("detectSound", timeout=1000.0),
            "localizeSound": f("localizeSound", timeout=1000.0),
            "getEnergy": f("getEnergy", duration=1000.0),
            "a wait": f("getLanguage", time=WAIT),
        }
        for name, function in functions.items():
            with case(name):
                run = send(self.ears, NaoAudioInGoal([function, f("ping")])).wait_for_function(0)
                self.robot.advance(1.0)
                run.cancel()
                run.wait(10.0)
                self.assertEqual(run.state, GoalStatus.PREEMPTED, run.text)
                for module in EXTRACTORS:
                    self.assertEqual(self.robot.module(module).getSubscribersInfo(), [])
                self.robot.advance(BIP)  # else the next one may detect it
        self.play(f("record", str_param="after.wav", duration=0.5))

    def test_a_preempted_recording_is_valid(self):
        run = send(self.ears, NaoAudioInGoal([f("record", str_param="cut.wav", duration=1000.0)])).wait_for_function(0)
        self.robot.advance(2.0)
        run.cancel()
        run.wait(10.0)
        self.assertEqual(run.state, GoalStatus.PREEMPTED)
        (file,) = run.result.files
        info = soundfile.info(str(recording("cut.wav")))
        self.assertGreaterEqual(info.duration, 1.9)
        self.assertAlmostEqual(info.duration, file.duration, delta=0.5)

    def test_bad_goals_are_refused_with_a_clear_text_before_anything_runs(self):
        bad = [
            (f("record", str_param="a.wav"), "field duration"),
            (f("record", str_param="../a.wav", duration=1.0), "leads out of the folder"),
            (f("record", str_param="a.wav", duration=1.0, rate=44100), "16000, 48000"),
            (f("record", str_param="a.wav", duration=1.0, channels=["up"]), "no microphone"),
            (f("record", str_param="a.wav", duration=1.0, channels=["left", "rear"]), "2 channel(s)"),
            (f("record", str_param="a.wav", duration=1.0, file_type="ogg"), "field file_type"),
            (f("listen"), "field vocabulary: it is empty"),
            (f("listen", vocabulary=["<a>"]), "cannot be said"),
            (f("listen", vocabulary=["yes"], timeout=float("nan")), "field timeout"),
            (f("listen", vocabulary=["yes"], timeout=-1.0), "field timeout"),
            (f("listen", vocabulary=["yes"], str_param="Klingon"), "one of English"),
            (f("localizeSound", timeout=1e9), "field timeout"),
            (f("setSensitivity", sensitivity=1.5), "field sensitivity"),
            (f("lissen"), "did you mean 'listen'"),
        ]
        first = f("startRecording", str_param="never.wav")
        recording("never.wav").unlink(missing_ok=True)
        for function, text in bad:
            with case(function.function, text=text):
                run = self.play(first, function, state=GoalStatus.ABORTED)
                self.assertRegex(run.text, f"^function 2 .{function.function}.: ")
                self.assertIn(text, run.text)
        self.assertFalse(recording("never.wav").exists())
        self.play(f("record", str_param="good.wav", duration=0.5))


def angle_between(first, second):
    """Difference of two angles, within half a turn."""
    return (first - second + np.pi) % (2 * np.pi) - np.pi


if __name__ == "__main__":
    rospy.init_node("audio_in_test")
    rostest.rosrun("nao_library_tests", "audio_in", AudioIn)
