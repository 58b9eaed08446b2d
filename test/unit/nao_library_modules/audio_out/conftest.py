"""The audio module on stand-ins."""

from __future__ import annotations

import pytest
from fake_audio_out import FakeAnimatedSpeech, FakeAudioDevice, FakePlayer, FakeSpeech


@pytest.fixture
def speech(robot, make_call):
    speech = FakeSpeech(make_call)
    robot.add("ALTextToSpeech", speech)
    robot.add("ALAnimatedSpeech", FakeAnimatedSpeech(speech))
    return speech


@pytest.fixture
def player(robot, make_call):
    player = FakePlayer(make_call)
    robot.add("ALAudioPlayer", player)
    return player


@pytest.fixture
def device(robot):
    device = FakeAudioDevice()
    robot.add("ALAudioDevice", device)
    return device


@pytest.fixture
def audio(robot, edge, speech, player, device):
    from nao_library_modules.audio_out import NaoAudioOutput

    return NaoAudioOutput("10.0.0.7", 9559, robot=robot, edge=edge)
