"""The robot dies while it talks, and comes back: the nodes of its sound say so, and go on."""

import rospy
from actionlib_msgs.msg import GoalStatus
from mortal_simulator import LIMIT, PORT, LostRobotCase
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

from nao_library_actions.msg import SpeechWithFeedbackAction, SpeechWithFeedbackGoal
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_library_msgs.msg import AudioBuffer, AudioSourceLocalization
from nao_library_msgs.srv import GetAudioMasterVolume
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy

LONG = "This story takes longer than the robot lives, and nobody will ever know how it ends. " * 4


class LostSpeech(LostRobotCase):
    def setUp(self):
        super().setUp()
        self.speech = SimpleActionClient("speech_action", SpeechWithFeedbackAction)
        self.assertTrue(self.speech.wait_for_server(rospy.Duration(LIMIT)))
        self.topic = self.kept(rospy.Publisher("speech", String, queue_size=10))
        wait_until(lambda: self.topic.get_num_connections() == 1, LIMIT, "the one subscriber of speech")
        self.blocks, self.complaints = [], []
        for topic, kind, take in (
            ("nao_robot/microphone/naoqi_microphone/audio_raw", AudioBuffer, self.blocks.append),
            ("nao_audio/audio_source_localization", AudioSourceLocalization, None),
            ("/rosout", Log, lambda log: self.complaints.append(log.msg)),
        ):
            self.kept(rospy.Subscriber(topic, kind, take))
        self.volume = rospy.ServiceProxy("nao_audio/get_master_volume", GetAudioMasterVolume)

    def say(self, text):
        return send(self.speech, SpeechWithFeedbackGoal(text))

    def wait_until_it_works(self):
        succeeded = GoalStatus.SUCCEEDED
        wait_until(lambda: self.say("I am here.").wait(LIMIT).state == succeeded, LIMIT, "a text that is said")
        heard = len(self.blocks)
        wait_until(lambda: len(self.blocks) > heard, LIMIT, "blocks of the microphones")
        localisation = ALProxy("ALSoundLocalization", "127.0.0.1", PORT)
        wait_until(localisation.getSubscribersInfo, LIMIT, "the localisation of sounds")

    def test_robot_that_dies_and_comes_back(self):
        self.wait_until_it_works()
        self.assertEqual(self.volume().master_volume.data, 100)

        late = "Nobody hears this."
        story = self.say(LONG)
        wait_until(lambda: story.feedback, LIMIT, "the beginning of the story")
        self.topic.publish(late)
        self.kill()
        story.wait(LIMIT)
        self.assertEqual(story.state, GoalStatus.ABORTED, story.text)
        self.assertIn(f"127.0.0.1:{PORT}", story.text)
        told = f"{late!r} was not said"
        wait_until(lambda: any(told in text for text in self.complaints), LIMIT, told)
        self.start()
        self.wait_until_it_works()
