"""The module for hearing on stand-ins."""

from __future__ import annotations

import pytest
from fake_hearing import Ears, HearingClock


@pytest.fixture
def ears(robot):
    return Ears(robot)


@pytest.fixture
def clock(edge):
    edge.clock = HearingClock()
    return edge.clock


@pytest.fixture
def hearing(robot, edge, clock, ears):
    from nao_library_modules.audio_in import NaoAudioInput

    return NaoAudioInput("10.0.0.7", 9559, robot=robot, edge=edge)
