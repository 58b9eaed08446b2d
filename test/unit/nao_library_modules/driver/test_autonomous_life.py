"""States and abilities, on robots that have modules for them and on robots that have not."""

from __future__ import annotations

import fake_memory
import fake_sound
import pytest

from nao_library_modules.driver import demand
from nao_library_modules.driver.autonomous_life import ABILITIES, AutonomousLife
from naoqi.errors import UnknownModule

BACKGROUND = ABILITIES[0]


class Life:
    """ALAutonomousLife."""

    def __init__(self, memory):
        self._memory = memory
        self.state = "disabled"
        self.abilities = {ability.life: False for ability in ABILITIES}

    def getState(self):
        return self.state

    def setState(self, state):
        self.state = state
        self._memory.raiseEvent("AutonomousLife/State", state)

    def setAutonomousAbilityEnabled(self, name, enabled):
        self.abilities[name] = enabled

    def getAutonomousAbilityEnabled(self, name):
        return self.abilities[name]


class Movement:
    """ALBackgroundMovement of older robots."""

    enabled = False

    def setEnabled(self, enabled):
        self.enabled = enabled

    def isEnabled(self):
        return self.enabled


@pytest.fixture
def memory():
    return fake_memory.Memory()


@pytest.fixture
def robot(make_call, memory, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    return fake_sound.Robot(make_call, ALMemory=memory, ALAutonomousLife=Life(memory))


@pytest.fixture
def told():
    return []


@pytest.fixture
def life(robot, told):
    life = AutonomousLife(robot, told.append)
    yield life
    life.close()


def test_states_are_told_from_the_beginning(life, told, eventually):
    eventually(lambda: told == ["disabled"])
    life.set_state("solitary")
    eventually(lambda: told == ["disabled", "solitary"])
    assert life.report().message == "solitary"


def test_states_are_told_after_a_loss(life, robot, told, eventually):
    eventually(lambda: told)
    robot.lose()
    robot.services["ALAutonomousLife"].state = "safeguard"
    robot.come_back()
    eventually(lambda: told == ["disabled", "safeguard"])


def test_abilities_are_those_of_life(life, robot):
    life.set_enabled(BACKGROUND, True)
    assert robot.services["ALAutonomousLife"].abilities["BackgroundMovement"] is True
    assert life.is_enabled(BACKGROUND) and not life.is_enabled(ABILITIES[1])


def test_an_older_robot_has_a_module_for_each(life, robot):
    robot.services["ALBackgroundMovement"] = Movement()
    life.set_enabled(BACKGROUND, True)
    assert robot.services["ALBackgroundMovement"].enabled and life.is_enabled(BACKGROUND)
    assert not robot.services["ALAutonomousLife"].abilities["BackgroundMovement"]


def test_a_robot_without_life_says_so_and_is_no_error(life, robot, told, eventually):
    eventually(lambda: told)
    robot.lose()
    del robot.services["ALAutonomousLife"]
    robot.come_back()
    eventually(lambda: life.report().message == "unknown" and life.report().level == 0)
    with pytest.raises(UnknownModule):
        life.set_state("solitary")
    with pytest.raises(UnknownModule, match="ALAutonomousLife"):
        life.is_enabled(BACKGROUND)
