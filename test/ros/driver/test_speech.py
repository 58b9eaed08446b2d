"""The one node that speaks: every text once and in turn, and ends that are ends."""

import subprocess
import sys
import unittest

import rospkg
import rospy
from actionlib_msgs.msg import GoalStatus
from dynamic_reconfigure.client import Client
from services import answer, configuration, service
from std_msgs.msg import String
from std_srvs.srv import Empty

from nao_library_actions.msg import SpeechWithFeedbackAction, SpeechWithFeedbackGoal
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

LIMIT = 60.0
NODE = rospkg.RosPack().get_path("nao_library_modules") + "/nodes/nao_speech"
LONG = "This is a long story, and it goes on and on, for nobody has told the robot where such a story ends. " * 3


class DriverSpeech(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.voice = cls.robot.module("ALTextToSpeech")
        cls.sentences = []
        cls.subscriber = cls.robot.module("ALMemory").subscriber("ALTextToSpeech/CurrentSentence")
        cls.subscriber.signal.connect(lambda text: cls.sentences.append(text) if text else None)
        rospy.wait_for_message("speech", String, LIMIT)  # nao_walker is online: the last that others have to say
        cls.topic = rospy.Publisher("speech", String, queue_size=100)
        wait_until(lambda: cls.topic.get_num_connections() == 1, LIMIT, "the one subscriber of speech")
        cls.settings = Client("nao_speech", timeout=LIMIT)
        cls.speech = SimpleActionClient("speech_action", SpeechWithFeedbackAction)
        assert cls.speech.wait_for_server(rospy.Duration(LIMIT)), "speech_action"
        wait_until(
            lambda: cls.say("ready").wait(LIMIT).state == GoalStatus.SUCCEEDED, LIMIT, "nao_speech and the robot"
        )

    @classmethod
    def say(cls, text):
        return send(cls.speech, SpeechWithFeedbackGoal(text))

    def setUp(self):
        self.robot.reset()
        self.configure()
        self.sentences.clear()

    def configure(self, **changes):
        rest = {"voice": "", "language": "", "volume": -1, "vocabulary": "", "word_spotting": False}
        self.settings.update_configuration({**rest, **changes})

    def succeed(self, text):
        run = self.say(text).wait(LIMIT)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run

    def test_texts_of_topic_and_action_are_said_in_turn_and_once(self):
        texts = [f"Number {n}" for n in ("one", "two", "three", "four")]
        for text in texts:
            self.topic.publish(text)
        wait_until(lambda: len(self.sentences) >= 1, LIMIT, "the first text")
        self.topic.publish("Number five")
        wait_until(lambda: "Number four" in self.sentences, LIMIT, "the fourth text")
        run = self.succeed("The end")
        wait_until(lambda: run.feedback, LIMIT, "the feedback, which has a topic of its own")
        self.assertEqual(len(run.feedback), 1)  # it has begun
        wait_until(lambda: len(self.sentences) >= 6, LIMIT, lambda: f"all sentences; heard {self.sentences}")
        self.robot.advance(2.0)
        said = [sentence.strip(" .") for sentence in self.sentences]
        self.assertEqual(sorted(said), sorted([*texts, "Number five", "The end"]))
        self.assertEqual([text for text in said if text in texts], texts)

    def test_a_voice_that_the_robot_does_not_have_is_refused(self):
        with self.assertRaises(Exception):  # noqa: B017  the client of dynamic_reconfigure has no narrower one
            self.configure(voice="nobody")
        self.assertEqual(configuration(self.settings)["voice"], "")
        rospy.set_param("nao_speech/voice", "nobody")
        self.assertIn("no voice 'nobody': there are", answer(service("reconfigure", Empty)))
        rospy.set_param("nao_speech/voice", "")
        self.succeed("My own voice.")

    def test_parameters_of_former_versions_are_read_again_on_request(self):
        rospy.set_param("nao_speech/volume", 0.25)
        rospy.set_param("nao_speech/vocabulary", ["yes", "no"])
        rospy.set_param("nao_speech/enable_word_spotting", True)
        self.assertEqual(answer(service("reconfigure", Empty)), "")
        wanted = {"volume": 25, "vocabulary": "yes / no", "word_spotting": True}

        def arrived():
            found = self.settings.get_configuration()
            return all(found[name] == value for name, value in wanted.items())

        wait_until(arrived, LIMIT, f"parameters {wanted}")

    def test_a_second_one_does_not_start(self):
        second = subprocess.run(
            [sys.executable, NODE, "__name:=second_speech", "--pport", str(self.robot.port)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=LIMIT,
        )
        self.assertEqual(second.returncode, 1)
        self.assertIn("/nao_driver speaks for this robot already", second.stdout)
        self.assertEqual(self.topic.get_num_connections(), 1)
