"""Words that somebody says, published by the node that listens for them."""

import unittest

import rospy
from actionlib_msgs.msg import GoalStatus
from dynamic_reconfigure.client import Client
from services import answer, configuration, service
from sound_fixture import Room
from std_msgs.msg import String
from std_srvs.srv import Empty

from nao_library_actions.msg import (
    SetSpeechVocabularyAction,
    SetSpeechVocabularyGoal,
    SpeechWithFeedbackAction,
    SpeechWithFeedbackGoal,
)
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_library_msgs.msg import WordRecognized
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

LIMIT = 60.0
SUBSCRIBER = "ros_nao_speech"


class DriverSpeechWords(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.recognition = cls.robot.module("ALSpeechRecognition")
        cls.room = Room(cls.robot)
        cls.settings = Client("nao_speech", timeout=LIMIT)
        cls.vocabulary = SimpleActionClient("speech_vocabulary_action", SetSpeechVocabularyAction)
        assert cls.vocabulary.wait_for_server(rospy.Duration(LIMIT)), "speech_vocabulary_action"
        cls.wait_for_silence()
        cls.settings.update_configuration({"vocabulary": "yes"})
        wait_until(lambda: cls.call("start_recognition") == "", LIMIT, "nao_speech and the robot")
        cls.call("stop_recognition")

    @staticmethod
    def wait_for_silence():
        """Until the robot has said that nao_walker is online: it would be heard in between."""
        rospy.wait_for_message("speech", String, LIMIT)
        speech = SimpleActionClient("speech_action", SpeechWithFeedbackAction)
        assert speech.wait_for_server(rospy.Duration(LIMIT)), "speech_action"
        ready, succeeded = SpeechWithFeedbackGoal("ready"), GoalStatus.SUCCEEDED
        wait_until(lambda: send(speech, ready).wait(LIMIT).state == succeeded, LIMIT, "nao_speech and the robot")

    @staticmethod
    def call(name):
        """Error text of a service, empty if it did what it was asked."""
        return answer(service(name, Empty, LIMIT))

    def setUp(self):
        self.robot.reset()
        self.room.clear()
        self.settings.update_configuration({"vocabulary": "", "word_spotting": False})

    def set_vocabulary(self, *words):
        return send(self.vocabulary, SetSpeechVocabularyGoal(list(words))).wait(LIMIT)

    def test_words_that_somebody_says_are_published(self):
        heard = []
        subscriber = rospy.Subscriber("word_recognized", WordRecognized, heard.append)
        self.addCleanup(subscriber.unregister)
        self.assertIn("vocabulary is empty", self.call("start_recognition"))
        run = self.set_vocabulary("yes", "no", "good morning", "robot")
        self.assertEqual((run.state, run.result.success), (GoalStatus.SUCCEEDED, True), run.text)
        self.assertEqual(self.call("start_recognition"), "")
        self.addCleanup(self.call, "stop_recognition")
        self.assertEqual([info[0] for info in self.recognition.getSubscribersInfo()], [SUBSCRIBER])
        self.robot.advance(1.0)
        self.room.person_says("good morning", self.room.around(1.0, 0.0))
        self.robot.advance(2.0)
        wait_until(lambda: heard, LIMIT, "a word")
        self.assertEqual(heard[0].words[0], "good morning")
        self.assertEqual(len(heard[0].words), len(heard[0].confidence_values))
        self.assertGreater(heard[0].confidence_values[0], 0.2)

        self.set_vocabulary("hello", "goodbye")  # while it listens
        heard.clear()
        self.robot.advance(1.0)  # the sound that says it listens again is over
        self.room.person_says("goodbye", self.room.around(1.0, 0.0))
        self.robot.advance(2.0)
        wait_until(lambda: heard, LIMIT, "a word of the new vocabulary")
        self.assertEqual(heard[0].words[0], "goodbye")

        self.assertEqual(self.call("stop_recognition"), "")
        self.assertEqual(self.recognition.getSubscribersInfo(), [])
        self.assertEqual(self.call("stop_recognition"), "")

    def test_vocabularies_that_will_not_do_are_refused(self):
        for words, text in ((("",), "is empty"), (("and/or",), "separates words"), ((), "at least one word")):
            run = self.set_vocabulary(*words)
            self.assertEqual((run.state, run.result.success), (GoalStatus.ABORTED, False))
            self.assertIn(text, run.text)
        self.assertEqual(configuration(self.settings)["vocabulary"], "")
