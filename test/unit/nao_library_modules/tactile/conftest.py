"""The module for touch on stand-ins."""

from __future__ import annotations

import pytest
from fake_feeling import FakeRunner, Skin
from fake_hearing import HearingClock


@pytest.fixture
def skin(robot):
    return Skin(robot)


@pytest.fixture
def runner():
    return FakeRunner()


@pytest.fixture
def clock(edge):
    edge.clock = HearingClock()
    return edge.clock


@pytest.fixture
def tactile(robot, edge, skin, runner):
    from nao_library_modules.tactile import NaoTactile

    module = NaoTactile("10.0.0.7", 9559, robot=robot, edge=edge, runner=runner)
    yield module
    module.shut_down()


@pytest.fixture
def play(tactile):
    """Plays functions, and gives the server."""
    from nao_library_actions.msg import NaoTactileGoal

    return lambda *functions: tactile.server.play(NaoTactileGoal(list(functions)))
