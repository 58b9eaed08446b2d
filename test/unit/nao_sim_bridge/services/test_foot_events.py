"""The event about the ground under the feet."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.foot_events import CONTACT


@pytest.fixture
def standing(stiff_robot):
    """The robot, stiff, that feels the floor."""
    stiff_robot.advance(0.5)
    return stiff_robot


def raised(robot):
    return len(robot.ALMemory.getEventHistory(CONTACT))


def test_a_robot_that_stands_has_contact(standing):
    assert standing.ALMemory.getData(CONTACT) is True


def test_contact_is_told_when_it_is_lost_and_when_it_is_won(standing):
    before = raised(standing)
    standing.NaoSimulation.push([0.0, 0.0, 60.0], 0.5, "torso")
    standing.advance(0.45)
    assert standing.ALMemory.getData(CONTACT) is False
    assert raised(standing) == before + 1
    standing.advance(3.0)
    assert standing.ALMemory.getData(CONTACT) is True
    assert raised(standing) >= before + 2


def test_walking_keeps_contact(standing):
    before = raised(standing)
    standing.ALMotion.move(0.05, 0.0, 0.0)
    standing.advance(5.0)
    assert standing.ALMotion.moveIsActive()
    assert raised(standing) == before
