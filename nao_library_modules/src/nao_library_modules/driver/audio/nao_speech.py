"""The node nao_speech: speech, and recognition of words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import rospy
from std_msgs.msg import String
from std_srvs.srv import Empty

from nao_library_actions.msg import (
    SetSpeechVocabularyAction,
    SetSpeechVocabularyGoal,
    SetSpeechVocabularyResult,
    SpeechWithFeedbackAction,
    SpeechWithFeedbackFeedback,
    SpeechWithFeedbackGoal,
    SpeechWithFeedbackResult,
)
from nao_library_msgs.msg import WordRecognized
from naoqi.errors import NaoError, UnknownModule

from ...core.errors import BadGoal, of_those
from ...core.health import Report
from ...core.robot import ask
from ...core.waiting import CancellationToken
from ...ros.action_server import ConcurrentActionServer, GoalOutcome
from ...ros.node_interface import NodeInterface, node_that_offers
from ...ros.time_and_frames import RosClock
from ..base.driver_node import name_for_robot, publish, whenever
from ..base.reconfigure import ReconfigureField, serve, update
from .robot_speech import (
    FORMER_NAMES,
    FULL_VOLUME,
    ROBOTS_OWN,
    SPEECH,
    RobotSpeech,
    SpeechSettings,
    from_config,
    given_parameters,
    join_vocabulary,
)
from .speech_recognition import RecognizedWords, WordRecognition

START = "start_recognition"
SHUTDOWN_LIMIT = 1.0
VOICE = frozenset({"the voice"})
VOCABULARY = frozenset({"the vocabulary"})
PARAMETERS = (
    ReconfigureField("voice", "", "name of the voice; empty: the robot's own"),
    ReconfigureField("language", "", "name of the language, such as English; empty: the robot's own"),
    ReconfigureField(
        "volume", ROBOTS_OWN, "volume of the speech in percent; -1: the robot's own", ROBOTS_OWN, FULL_VOLUME
    ),
    ReconfigureField("vocabulary", "", "words and phrases to listen for, separated by /"),
    ReconfigureField("audio_expression", True, "whether the robot beeps when it begins to listen"),
    ReconfigureField("visual_expression", True, "whether its eyes show that it listens"),
    ReconfigureField("word_spotting", False, "whether words are found within longer sentences"),
)
KNOWN = {"voice": "getAvailableVoices", "language": "getAvailableLanguages"}


class NaoSpeech:
    """Says what comes by topic or action, each text once and one after the other; publishes words that were heard.

    A second node of this kind in the same namespace does not start: the robot would say everything twice.

    ROS API (relative names):
        Subscribes `speech` (std_msgs/String). Publishes `word_recognized` (nao_library_msgs/WordRecognized), whoever
        has started the recognition.
        Actions `speech_action` (nao_library_actions/SpeechWithFeedback: feedback when the robot begins to talk, result
        when it has ended; a cancelled one is silent at once; a newer goal ends the one before),
        `speech_vocabulary_action` (nao_library_actions/SetSpeechVocabulary).
        Services `start_recognition`, `stop_recognition`, `reconfigure` (reads the parameters again) (std_srvs/Empty).
        Parameters, all of them also by dynamic_reconfigure: `~voice`, `~language`, `~volume` (percent, or a share of
        1 written with a point): used for each text and put back after it; `~vocabulary` ("yes / no" or a list),
        `~audio_expression`, `~visual_expression`, `~word_spotting` (with `enable_` before them as well).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        """Raises NaoError for a wrong parameter, or if another node speaks already; the robot need not be connected."""
        self._node = node
        other = node_that_offers(node.resolve(START))
        if other:
            raise NaoError(f"{other} speaks for this robot already ({self._node.resolve('speech')}): one is enough")
        self._robot = robot
        for name, value in self._read_parameters().items():
            rospy.set_param(
                node.resolve(f"~{name}"), value
            )  # in today's form, as the server of the parameters wants it
        self._settings = SpeechSettings()
        self._words = self._node.publisher("word_recognized", WordRecognized, queue_size=10)
        self._speech = RobotSpeech(robot, RosClock(), lambda: self._settings)
        node.if_it_fails(self._speech.close)
        self._recognition = WordRecognition(
            robot, name_for_robot(self._node.name), lambda: self._settings, self._publish
        )
        node.if_it_fails(self._recognition.close)
        self._server = serve(node, PARAMETERS, self._changed)
        self._goals = {
            "speech_action": ConcurrentActionServer(lambda _: VOICE, self._say, with_feedback=True, robot=robot),
            "speech_vocabulary_action": ConcurrentActionServer(lambda _: VOCABULARY, self._set_vocabulary, robot=robot),
        }
        for (name, server), action in zip(self._goals.items(), (SpeechWithFeedbackAction, SetSpeechVocabularyAction)):
            self._node.action(name, action, server)
        self._stop_watching = whenever(robot, node, "connected", self._speech.robot_is_back)
        self._node.subscriber("speech", String, self._on_text, queue_size=100)
        self._node.offer("stop_recognition", Empty, lambda _: self._recognition.stop())
        self._node.offer("reconfigure", Empty, lambda _: update(self._server, self._read_parameters()))
        self._node.offer(START, Empty, lambda _: self._recognition.start())

    def reports(self) -> dict[str, Callable[[], Report]]:
        goals = {f"goals {name}": server.counter.report for name, server in self._goals.items()}
        return {"speech": self._speech.report, "recognition": self._recognition.report, **goals}

    def close(self) -> None:
        self._stop_watching()
        for server in self._goals.values():
            server.close(SHUTDOWN_LIMIT / len(self._goals))
        self._speech.close()
        self._recognition.close()

    # --- speech ---------------------------------------------------------------------------------------------------

    def _on_text(self, message: String) -> None:
        text = message.data
        if not text.strip():
            rospy.logwarn("speech: an empty text, so nothing is said")
            return
        try:
            self._speech.say(text, on_failure=lambda error: _complain(text, error))
        except NaoError as error:
            _complain(text, error)

    def _say(
        self, goal: SpeechWithFeedbackGoal, interrupt: CancellationToken, feedback: Callable[[Any], None]
    ) -> GoalOutcome:
        if not goal.say.strip():
            raise BadGoal("say", goal.say, "a text", "it is empty")
        utterance = self._speech.say(goal.say, on_start=lambda: feedback(SpeechWithFeedbackFeedback()))
        with interrupt.waking(lambda: self._speech.silence(utterance)):
            utterance.ended.wait()
        if utterance.error is not None:
            raise utterance.error
        return GoalOutcome(SpeechWithFeedbackResult())

    # --- recognition ----------------------------------------------------------------------------------------------

    def _set_vocabulary(self, goal: SetSpeechVocabularyGoal, _interrupt: CancellationToken) -> GoalOutcome:
        if not goal.words:
            raise BadGoal("words", goal.words, "at least one word", "it is empty")
        update(self._server, {"vocabulary": join_vocabulary(goal.words)})
        return GoalOutcome(SetSpeechVocabularyResult(success=True))

    def _publish(self, heard: RecognizedWords) -> None:
        publish(self._words, WordRecognized(list(heard.words), list(heard.confidences)))

    # --- parameters -----------------------------------------------------------------------------------------------

    def _changed(self, before: Mapping[str, Any], after: Mapping[str, Any]) -> Mapping[str, Any]:
        """Apply new values of the parameters; the first ones are not tried on the robot."""
        former, self._settings = self._settings, from_config(after)
        try:
            if before:
                self._try_voice(former, self._settings)
                if _listening(former) != _listening(self._settings):
                    self._recognition.apply()
        except NaoError:
            self._settings = former
            raise
        return {**after, "vocabulary": join_vocabulary(self._settings.vocabulary)}

    def _try_voice(self, former: SpeechSettings, settings: SpeechSettings) -> None:
        """Refuse a voice or language that the robot lacks; one that is not connected is asked at the next text."""
        if self._robot.connection.state != "connected":
            return
        for name, method in KNOWN.items():
            wanted = getattr(settings, name)
            if wanted and wanted != getattr(former, name):
                known = ask(self._robot, SPEECH, method)
                if wanted not in known:
                    raise NaoError(f"the robot has no {name} {wanted!r}{of_those(wanted, sorted(known))}")

    def _read_parameters(self) -> dict[str, Any]:
        """Private parameters that are set, in today's form; former names are deleted."""
        given = self._node.param(self._node.name, {})
        values = given_parameters(given)
        for former in FORMER_NAMES.values():
            if former in given:
                rospy.delete_param(self._node.resolve(f"~{former}"))
        return values


def _listening(settings: SpeechSettings) -> tuple[Any, ...]:
    """The settings that recognition depends on."""
    return settings.vocabulary, settings.audio_expression, settings.visual_expression, settings.word_spotting


def _complain(text: str, error: Exception) -> None:
    log = rospy.loginfo if isinstance(error, UnknownModule) else rospy.logerr
    log("speech: %r was not said: %s", text, error)
