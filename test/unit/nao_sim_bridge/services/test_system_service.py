"""ALSystem over the network."""

from __future__ import annotations

import os

import pytest

from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.services.system import ALSystem


@pytest.fixture
def system(shared_robot):
    return shared_robot.ALSystem


def test_the_name_can_be_changed_and_is_announced(robot):
    assert robot.ALSystem.setRobotName("Marvin-2") is True
    assert robot.ALSystem.robotName() == "Marvin-2"
    assert robot.ALMemory.getData("ALSystem/RobotNameChanged") == "Marvin-2"
    assert ["name", "Marvin-2"] in robot.ALSystem.systemInfo()


@pytest.mark.parametrize("name", ["", "two words", "semi;colon", "../etc"])
def test_an_impossible_name_is_refused_and_the_old_one_stays(system, name):
    before = system.robotName()
    with pytest.raises(RuntimeError, match="name is .*, allowed are letters, digits and hyphens"):
        system.setRobotName(name)
    assert system.robotName() == before


def test_versions_agree(system):
    assert system.systemVersion() == system.previousSystemVersion() == system.version()
    assert ["version", system.systemVersion()] in system.systemInfo()
    assert ["simulated", True] in system.systemInfo()


def test_the_time_zone_can_be_changed_to_one_there_is(system):
    before = system.timezone()
    for wrong in ("Mars/Olympus", "", "/etc/passwd", "../../../etc/passwd", "Europe"):
        assert system.setTimezone(wrong) is False
        assert system.timezone() == before


@pytest.mark.skipif(not os.path.isfile("/usr/share/zoneinfo/Europe/Paris"), reason="no time zones on this machine")
def test_a_known_time_zone_is_taken(system):
    assert system.setTimezone("Europe/Paris") is True
    assert system.timezone() == "Europe/Paris"


def test_memory_and_disk_are_those_of_the_machine(system):
    assert 0 < system.freeMemory() <= system.totalMemory()
    assert system.totalMemory() == pytest.approx(
        os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**20, abs=1
    )
    for mount, total, used, free in system.diskFree(True):
        assert mount == "/"
        assert 0 <= free <= total and 0 <= used <= total


def test_a_reboot_puts_the_robot_to_the_start(stiff_robot):
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    stiff_robot.ALSystem.reboot()
    assert stiff_robot.ALMotion.getStiffnesses("Body") == [0.0] * 26
    assert stiff_robot.ALMotion.robotIsWakeUp() is False


def test_a_shutdown_ends_the_simulator():
    ended = []
    ALSystem(MemoryStore(lambda: 0.0), lambda: None, lambda: ended.append(True)).shutdown()
    assert ended == [True]
