"""The first clients of lights, sound and touch, started as users start them."""

import subprocess

from examples_fixture import ExampleTest, start
from sound_fixture import Loudspeakers

from nao_library_actions.msg import NaoAudioOutAction, NaoLedAction, NaoTactileAction

HEAD = "Head/Led/Front/Right/1"
GREEN, RED = "Face/Led/Green/Left/0Deg", "Face/Led/Red/Left/0Deg"


class LightAndSoundExamples(ExampleTest):
    limit = 60

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        servers = (("NaoLights", NaoLedAction), ("nao_audio_out", NaoAudioOutAction), ("NaoTactile", NaoTactileAction))
        for name, action in servers:
            cls.robot.action_client(name, action)
        cls.loudspeakers = Loudspeakers(cls.robot)
        cls.simulation = cls.robot.module("NaoSimulation")

    def test_green_eyes(self):
        example = start("green_eyes.py")
        try:
            self.robot.wait_for_leds({GREEN: 1.0, RED: 0.0}, 30.0)
            self.assertRegex(example.communicate(timeout=self.limit)[0], r"(?m)^\['(1\.0|0\.99\d*)'\]\n\Z")
        finally:
            example.kill()
        self.assertEqual((self.robot.led(GREEN), self.robot.led(RED)), (1.0, 1.0))

    def test_lights_client(self):
        text = self.run_example("lights_client.py")
        self.assertEqual(text.count("succeeded"), 3)
        self.assertEqual((self.robot.led(HEAD), self.robot.led(GREEN)), (0.5, 0.0))

    def test_hello_is_heard(self):
        began = self.simulation.time()
        self.assertRegex(self.run_example("hello.py", "I", "am", "Nao."), r"(?m)^said\n\Z")
        self.assertGreater(self.loudspeakers.level(began, self.simulation.time()), 0.01)

    def test_sing_and_talk(self):
        text = self.run_example("sing_and_talk.py", "Hear me")
        self.assertIn("Hear me", text)
        self.assertRegex(text, r"refrain.wav: \d+\.\d s")

    def test_react_to_touch(self):
        example = start("react_to_touch.py", "--behavior", "nod", "--times", "1")
        try:
            self.assertIn("waiting for a touch: head\n", iter(example.stdout.readline, ""))  # actionlib logs as well
            self.robot.press(["Head/Touch/Front"])
            self.robot.advance(0.1)  # a finger that comes and goes between two ticks was never there
            self.robot.press([])
            text, _ = example.communicate(timeout=self.limit)
            self.assertEqual(example.returncode, 0, text)
            self.assertIn("nod: succeeded", text)
        except subprocess.TimeoutExpired:
            example.kill()
            self.fail(f"it does not end: {example.communicate()[0]}")
        finally:
            example.kill()
