"""The module for what can be heard, and a robot at full volume."""

from __future__ import annotations

import module_goals
import pytest
from bent_robot import BentRobot

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio_out import NaoAudioOutput


@pytest.fixture(autouse=True)
def full_volume(robot):
    robot.ALAudioDevice.setOutputVolume(100)


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
