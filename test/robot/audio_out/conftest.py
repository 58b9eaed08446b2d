"""The module for what can be heard, and a robot at full volume."""

from __future__ import annotations

import module_goals
import pytest
from bent_robot import BentRobot

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio_out import NaoAudioOutput


@pytest.fixture(autouse=True)
def as_at_the_start(robot):
    robot.ALAudioDevice.setOutputVolume(100)
    yield
    robot.ALTextToSpeech.stopAll()
    robot.ALTextToSpeech.setLanguage("English")
    robot.ALTextToSpeech.reset()
    robot.ALAudioPlayer.unloadAllFiles()
    robot.ALAudioPlayer.setMasterVolume(1.0)
    robot.ALAudioDevice.muteAudioOut(False)
    robot.ALAnimatedSpeech.setBodyLanguageModeFromStr("contextual")


@pytest.fixture
def audio(goals_to):
    return goals_to(NaoAudioOutput, NaoAudioOutGoal)


@pytest.fixture
def bent_audio(goals_to, monkeypatch):
    """Makes the module on a robot that is different; see BentRobot."""

    def make(bends=None, stubborn=()):
        monkeypatch.setattr(module_goals, "WatchedRobot", BentRobot)
        monkeypatch.setattr(BentRobot, "bends", bends or {})
        monkeypatch.setattr(BentRobot, "stubborn", stubborn)
        return goals_to(NaoAudioOutput, NaoAudioOutGoal)

    return make
