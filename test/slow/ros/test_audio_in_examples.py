"""The examples for nao_audio_in, started as users start them."""

import signal
import tempfile
import unittest
from pathlib import Path

import numpy as np
import soundfile
from examples_fixture import start
from sound_fixture import Room, bursts, level, recording
from waits import PATIENCE

from example_parts import dialogue_record
from nao_sim_bridge.testing import SimulatedRobot, wait_until

HEAD_YAW = "Device/SubDeviceList/HeadYaw/Position/Sensor/Value"


class AudioInExamples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.room = Room(cls.robot)

    def setUp(self):
        self.robot.reset()
        self.room.clear()
        self.example = None

    def tearDown(self):
        if self.example is not None:
            self.example.kill()
            self.example.communicate()

    def start(self, name, *arguments):
        self.example = start(name, *arguments)

    def finish(self, status=0):
        """What the example printed; it ends with this status."""
        output, _ = self.example.communicate(timeout=90)
        self.assertEqual(self.example.returncode, status, output)
        return output

    def wait_for_subscriber(self, module):
        service = self.robot.module(module)
        wait_until(service.getSubscribersInfo, 60.0, f"a subscriber of {module}")
        self.robot.advance(1.0)  # its bip is not heard, and it has to learn how loud the background is

    def test_a_recording(self):
        recording("example.wav").unlink(missing_ok=True)
        with self.robot.at_speed(0.5):
            self.start("record_sound.py", "example.wav", "--seconds", "2", "--all")
            output = self.finish()
        self.assertIn("example.wav: succeeded", output)
        info = soundfile.info(str(recording("example.wav")))
        told = f"{recording('example.wav')}: {info.duration:.1f} s, 48000 Hz, left, right, front, rear"
        self.assertIn(told, output)
        self.assertEqual(info.channels, 4)
        self.assertGreater(info.duration, 1.8)
        self.start("record_sound.py", "example.wav", "--seconds", "2")
        self.assertIn(f"{recording('example.wav')} is there already", self.finish(status=1))

    def test_a_recording_that_is_interrupted_is_good(self):
        recording("cut.wav").unlink(missing_ok=True)
        self.start("record_sound.py", "cut.wav", "--seconds", "600")
        # The file is there a few ticks before its first sample.
        wait_until(lambda: holds_samples(recording("cut.wav")), 60.0, "the first samples")
        self.robot.advance(1.0)
        self.example.send_signal(signal.SIGINT)
        self.example.communicate(timeout=PATIENCE)
        recorder = self.robot.module("ALAudioRecorder")
        wait_until(lambda: begins_to_record(recorder), 60.0, "the end of the recording")
        recorder.stopMicrophonesRecording()
        info = soundfile.info(str(recording("cut.wav")))
        self.assertGreaterEqual(info.frames, info.samplerate - 1)

    def test_the_head_turns_to_a_sound(self):
        self.start("turn_to_sound.py", "--timeout", "30")
        self.wait_for_subscriber("ALSoundLocalization")
        self.room.place("bursts", bursts(), self.room.around(1.5, 0.9, 0.1), level_db=70.0, loop=True)
        self.assertRegex(self.finish(), "a sound at [45][0-9] degrees")
        self.assertAlmostEqual(self.robot.value(HEAD_YAW), 0.9, delta=0.2)

    def dialogue_with(self, answer):
        self.start("dialogue.py", "--timeout", "30")
        self.wait_for_subscriber("ALSpeechRecognition")
        self.room.person_says(answer, self.room.around(1.0, 0.3))
        return self.finish()

    def test_a_dialogue_with_a_person_who_says_yes(self):
        output = self.dialogue_with("yes")
        self.assertRegex(output, r"(?s)robot: Shall we play\?.*heard: yes.*robot: Great!")

    def test_a_dialogue_with_a_person_who_says_no(self):
        self.assertIn("robot: What a pity.", self.dialogue_with("no"))

    def test_a_dialogue_that_needs_nobody_and_what_is_kept_of_it(self):
        recording("dialogue.wav").unlink(missing_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "dialogue.json"
            self.start("dialogue.py", "--person", "yes", "--record", "dialogue.wav", "--log", str(log))
            output = self.finish()
            turns = dialogue_record.load(log)
        self.assertRegex(output, "heard: a voice at (1[5-9]|2[0-9])°")
        self.assertAlmostEqual(self.robot.value(HEAD_YAW), np.arctan2(0.4, 1.0), delta=0.15)
        self.assertIn("yes", [turn.text for turn in turns if turn.what == dialogue_record.HEARS])
        sound, rate = soundfile.read(str(recording("dialogue.wav")))
        self.assertEqual(rate, 16000)
        self.assertAlmostEqual(len(sound) / rate, turns[-1].ended, delta=1.0)
        spoken = [turn for turn in turns if turn.what == dialogue_record.SAYS]
        self.assertEqual({turn.who for turn in spoken}, {dialogue_record.ROBOT, dialogue_record.PERSON})
        silent = level(sound[: int(0.3 * rate)])
        for turn in spoken:
            self.assertGreater(level(sound[int(turn.began * rate) : int(turn.ended * rate)]), 3.0 * silent, turn)

    def test_a_dialogue_with_nobody(self):
        self.start("dialogue.py", "--timeout", "2", "--times", "2")
        output = self.finish(status=1)
        self.assertEqual(output.count("robot: Shall we play?"), 2)
        self.assertIn("I did not hear you.", output)

    def test_the_robot_does_not_understand_what_it_is_not_asked(self):
        self.start("dialogue.py", "--timeout", "4", "--times", "1")
        self.wait_for_subscriber("ALSpeechRecognition")
        self.room.place("bursts", bursts(), self.room.around(1.0, np.pi), level_db=65.0, loop=True)
        self.assertIn("I did not hear you.", self.finish(status=1))


def holds_samples(file):
    """Whether a recording that grows has more than its header."""
    return file.exists() and file.stat().st_size > 1000


def begins_to_record(recorder):
    """Whether a recording can begin, for none runs; it runs then."""
    try:
        recorder.startMicrophonesRecording("next.wav", "wav", 16000, [0, 0, 1, 0])
    except RuntimeError:
        return False
    return True
