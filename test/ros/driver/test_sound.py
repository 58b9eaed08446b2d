"""Microphones as a topic; files, volume, recordings and directions of sounds as services and a topic."""

import math
import unittest
from contextlib import contextmanager, suppress

import numpy as np
import rospy
import soundfile
from cases import case
from dynamic_reconfigure.client import Client
from news import Reports
from services import answer
from sound_fixture import Loudspeakers, Room, bursts, recording, strongest_frequency

from nao_library_msgs.msg import AudioBuffer, AudioSourceLocalization
from nao_library_msgs.srv import AudioPlayback, AudioRecorder, GetAudioMasterVolume, SetAudioMasterVolume
from nao_sim_bridge.testing import SimulatedRobot, StackNotReady, wait_until

LIMIT = 60.0
TRIES = 6
MICROPHONE = "nao_robot/microphone/naoqi_microphone"
BLOCK = 0.17
AUDIBLE = 300
"""Samples above this are no background noise."""
SIDES = ("left", "right", "front", "rear")
NOT_IN_HOME = "leads out of it"


class Blocks(list):
    """Messages of the microphones, in the order of their coming."""

    def samples(self):
        """(frames, channels), and the time of the first one."""
        channels = len(self[0].channelMap)
        joined = np.concatenate([np.array(block.data, dtype=float).reshape(-1, channels) for block in self])
        return joined, self[0].header.stamp.to_sec()

    def end(self):
        last = self[-1]
        return last.header.stamp.to_sec() + len(last.data) / len(last.channelMap) / last.frequency


class Service:
    """A service whose fields are std_msgs, called with plain values."""

    def __init__(self, name, kind):
        rospy.wait_for_service(name, LIMIT)
        self._kind = kind
        self._proxy = rospy.ServiceProxy(name, kind)

    def __call__(self, **fields):
        request = self._kind._request_class()
        for field, value in fields.items():
            getattr(request, field).data = value
        return self._proxy(request)


class DriverSound(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.device = cls.robot.module("ALAudioDevice")
        cls.simulation = cls.robot.module("NaoSimulation")
        cls.room = Room(cls.robot)
        cls.loudspeakers = Loudspeakers(cls.robot)
        cls.settings = Client(MICROPHONE, timeout=LIMIT)
        cls.reports = Reports()
        cls.play_file = Service("nao_audio/play_file", AudioPlayback)
        cls.record = Service("nao_audio/record", AudioRecorder)
        cls.set_volume = Service("nao_audio/master_volume", SetAudioMasterVolume)
        cls.volume = Service("nao_audio/get_master_volume", GetAudioMasterVolume)
        wait_until(lambda: answer(cls.volume) == "", LIMIT, "nao_audio and the robot")

    def setUp(self):
        self.robot.reset()
        self.room.clear()
        self.set_volume(master_volume=100)
        self.settings.update_configuration({"frequency": 16000})

    # --- microphones ----------------------------------------------------------------------------------------------

    @contextmanager
    def listening(self, frequency=16000):
        """Blocks of the microphones, in a list that grows while time passes; it stands still but for `advance`."""
        self.settings.update_configuration({"frequency": frequency})
        blocks = Blocks()
        subscriber = rospy.Subscriber(f"{MICROPHONE}/audio_raw", AudioBuffer, blocks.append, queue_size=1000)
        try:
            wait_until(lambda: blocks and blocks[-1].frequency == frequency, LIMIT, "a block of the microphones")
            self.robot.pause()
            for _ in range(TRIES):  # while a subscription begins, a block may be lost, and time stands still
                self.robot.advance(BLOCK)
                with suppress(StackNotReady):
                    self.wait_for_blocks(blocks, LIMIT / TRIES)
                    break
            else:
                self.fail("no block comes while time goes on a block after the other")
            blocks.clear()
            yield blocks
        finally:
            self.robot.resume()
            subscriber.unregister()

    def let_pass(self, blocks, seconds):
        """Let time pass, a block after the other: a busy computer loses none."""
        for _ in range(math.ceil(seconds / BLOCK)):
            self.robot.advance(BLOCK)
            self.wait_for_blocks(blocks)

    def wait_for_blocks(self, blocks, limit=LIMIT):
        """Until the last block that has been heard is there."""
        heard = math.floor((self.simulation.time() - 0.005) / BLOCK) * BLOCK
        wait_until(lambda: blocks and blocks.end() > heard - 0.01, limit, f"sound up to {heard:.2f} s")

    def test_a_tone_comes_with_its_pitch_and_at_its_time(self):
        with self.listening() as blocks:
            before = self.simulation.time()
            self.device.playSine(1000, 80, 0, 1.0, _async=True)
            self.let_pass(blocks, 2.0)
            samples, start = blocks.samples()
            played = self.loudspeakers.span(before, blocks.end())
        self.assertEqual((blocks[0].frequency, list(blocks[0].channelMap)), (16000, [AudioBuffer.CHANNEL_FRONT_LEFT]))
        stamps = np.array([block.header.stamp.to_sec() for block in blocks])
        np.testing.assert_allclose(np.diff(stamps), BLOCK, atol=1e-4)
        loud = np.flatnonzero(np.abs(samples[:, 0]) > AUDIBLE)
        # From the loudspeakers to the microphones sound takes less than a millisecond.
        heard = (start + loud[0] / 16000, start + loud[-1] / 16000)
        np.testing.assert_allclose(heard, played, atol=0.003)
        self.assertAlmostEqual(strongest_frequency(samples[loud[0] : loud[-1]], 16000), 1000.0, delta=1.0)

    def test_nothing_is_captured_while_nobody_listens(self):
        with self.listening():
            pass
        counts = []
        for _ in range(3):  # blocks that are under way still come after the first
            counts.append(self.reports.values(f"{MICROPHONE}: microphones", "no subscriber")["blocks"])
            self.robot.advance(2.0)
        self.assertEqual(counts[1], counts[2])

    # --- files and volume -----------------------------------------------------------------------------------------

    def channels(self, *sides):
        return {f"{side}_channel": side in sides for side in SIDES}

    def test_volume_is_set_and_read(self):
        self.set_volume(master_volume=35)
        self.assertEqual(self.volume().master_volume.data, 35)
        self.assertEqual(self.device.getOutputVolume(), 35)
        self.assertIn("0 to 100", answer(self.set_volume, master_volume=101))
        self.assertEqual(self.device.getOutputVolume(), 35)

    def test_a_recording_holds_what_was_heard_and_plays_as_long(self):
        self.device.playSine(440, 80, 0, 120.0, _async=True)
        self.device.getOutputVolume()  # the module takes one call after the other: the tone is there
        request = {"file_path": "driver/tone.wav", "secs": 2, "audio_type": 0, "samplerate": 48000}
        self.record(**request, **self.channels(*SIDES))
        path = recording("driver/tone.wav")
        samples, rate = soundfile.read(str(path))
        self.assertEqual((rate, samples.shape[1]), (48000, 4))
        length = len(samples) / rate
        self.assertGreater(length, 2.0 - BLOCK)
        self.assertAlmostEqual(strongest_frequency(samples, rate), 440.0, delta=1.0)
        self.device.flushAudioOutputs()
        self.robot.reset()
        before = self.simulation.time()
        self.play_file(file_path="driver/tone.wav")
        after = self.simulation.time()
        self.assertGreater(after - before, length - BLOCK)
        first, last = self.loudspeakers.span(before, after + 0.5)
        self.assertAlmostEqual(last - first, length, delta=0.2)

    def test_what_is_wrong_is_said_and_the_services_go_on(self):
        good = {"file_path": "a.wav", "secs": 1, "audio_type": 0, "samplerate": 48000}
        cases = [
            ("secs", {"secs": 0}, SIDES),
            ("audio_type", {"audio_type": 7}, SIDES),
            ("samplerate", {"samplerate": 44100}, SIDES),
            ("channels", {}, ()),
            ("channels", {}, ("left", "front")),
            (NOT_IN_HOME, {"file_path": "../../etc/a.wav"}, SIDES),
            ("filename", {"file_path": "a.mp3"}, SIDES),
        ]
        for text, change, sides in cases:
            with case(text, **change):
                self.assertIn(text, answer(self.record, **{**good, **change}, **self.channels(*sides)))
        for text, name in (("no file", "nothing.wav"), (NOT_IN_HOME, "../a.wav"), ("file_path", "")):
            with case(text, name=name):
                self.assertIn(text, answer(self.play_file, file_path=name))
        self.assertEqual(answer(self.volume), "")

    # --- directions -----------------------------------------------------------------------------------------------

    def test_sounds_are_located_while_somebody_listens(self):
        localisation = self.robot.module("ALSoundLocalization")
        self.assertEqual(localisation.getSubscribersInfo(), [])
        found = []
        topic = "nao_audio/audio_source_localization"
        subscriber = rospy.Subscriber(topic, AudioSourceLocalization, found.append)
        wait_until(localisation.getSubscribersInfo, LIMIT, "a subscriber of ALSoundLocalization")
        for bearing in (60, -120):
            with case(bearing=bearing):
                place = self.room.around(2.0, math.radians(bearing))
                self.room.place("burst", bursts(), place, 70.0, loop=True)
                x, y, _ = self.room.in_head(place)

                def near(message, x=x, y=y):
                    off = (message.azimuth.data - math.atan2(y, x) + math.pi) % (2 * math.pi) - math.pi
                    return abs(off) < math.radians(15.0)

                found.clear()
                self.robot.advance(3.0)
                wait_until(lambda near=near: any(map(near, found)), LIMIT, lambda: f"the direction, among {found}")
                message = next(filter(near, found))
                self.assertGreater(message.confidence.data, 0.0)
                self.assertEqual(message.header.frame_id, "torso")
                self.assertAlmostEqual(message.head_pose.position.z, 0.1265, delta=0.001)
                orientation = message.head_pose.orientation
                parts = (orientation.x, orientation.y, orientation.z, orientation.w)
                self.assertAlmostEqual(math.hypot(*parts), 1.0, delta=1e-6)
                self.room.clear()
                self.robot.advance(2.0)
        subscriber.unregister()
        wait_until(lambda: localisation.getSubscribersInfo() == [], LIMIT, "the end of the localisation")
