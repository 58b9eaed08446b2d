"""Speech: saying texts, by the topic `speech` of nao_speech, or by its action to wait for the end."""

from __future__ import annotations

import rospy
from std_msgs.msg import String

from nao_library_actions.msg import SpeechWithFeedbackAction, SpeechWithFeedbackGoal

from ..language.failures import SpeechLowLevelFailure
from .robot_module import RobotModule

SPEECH_TOPIC = "speech"
SPEECH_ACTION = "speech_action"
LISTENER_LIMIT = 10.0
"""s to wait for a node that speaks."""
LONGEST_SPEECH = 120.0
"""s that a text may take."""


class Speech(RobotModule):
    """Says texts."""

    name = "speech"
    methods = ("say", "text_to_speech")

    def text_to_speech(self, text: str) -> None:
        """Say a text without waiting for its end; SpeechLowLevelFailure if there is no subscriber."""
        if not self.robot.topic(SPEECH_TOPIC, String).tell(String(text), LISTENER_LIMIT):
            where = rospy.resolve_name(SPEECH_TOPIC)
            raise SpeechLowLevelFailure(f"nobody speaks what comes on {where}: is nao_speech running?")

    def say(self, text: str) -> None:
        """Say a text and wait for its end; a cancel silences it."""
        end = self.robot.action(SPEECH_ACTION, SpeechWithFeedbackAction).call(SpeechWithFeedbackGoal(say=text), LONGEST_SPEECH)
        if not end.succeeded:
            raise SpeechLowLevelFailure(f"{text!r} was not said: {end}", text=text)
