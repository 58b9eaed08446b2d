"""The module for hearing, and what it must leave behind."""

from __future__ import annotations

import pytest

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput

EXTRACTORS = ("ALSpeechRecognition", "ALSoundDetection", "ALSoundLocalization")


@pytest.fixture
def ears(goals_to, robot):
    return goals_to(NaoAudioInput, NaoAudioInGoal, robot_home=str(robot.server.files.folder))


@pytest.fixture
def subscribers(robot):
    """Names of the subscribers of what hears."""
    return lambda: [row[0] for module in EXTRACTORS for row in getattr(robot, module).getSubscribersInfo()]


@pytest.fixture
def restored(robot, subscribers):
    """Checks that nobody is subscribed and that the recognition has the settings of before."""

    def check():
        service = robot.ALSpeechRecognition
        assert subscribers() == []
        service.pause(True)
        with pytest.raises(RuntimeError, match="no contexts have been pushed"):
            service.popContexts()
        service.pause(False)

    return check


@pytest.fixture(autouse=True)
def silent_listener(robot):
    """The bips of a robot that listens would be heard; and its recogniser has been started."""
    robot.ALSpeechRecognition.setAudioExpression(False)
    robot.ALSpeechRecognition.setVocabulary(["theirs"], False)
