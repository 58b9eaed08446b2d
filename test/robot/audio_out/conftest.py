"""The module for what can be heard, and a robot at full volume."""

from __future__ import annotations

import pytest

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio_out.audio_out_server import NaoAudioOutput


@pytest.fixture(autouse=True)
def full_volume(robot):
    robot.ALAudioDevice.setOutputVolume(100)


@pytest.fixture
def audio(goals_to):
    return goals_to(NaoAudioOutput, NaoAudioOutGoal)
