"""ALSystem over the network."""

from __future__ import annotations

import io
import os

import pytest
from PIL import Image

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


@pytest.mark.skipif(not os.path.isfile("/usr/share/zoneinfo/Asia/Tokyo"), reason="no time zones on this machine")
def test_the_robots_clock_is_that_of_its_time_zone(robot, system):
    def hour_in(zone):
        assert system.setTimezone(zone) is True
        robot.advance(1.1)
        return robot.ALMemory.getData("Launchpad/Hour") + robot.ALMemory.getData("Launchpad/Minute") / 60.0

    before = system.timezone()
    robot.ALAutonomousLife.setAutonomousAbilityEnabled("All", False)
    robot.finish("ALAutonomousLife", "setState", "solitary", after=8.0)
    try:
        assert (hour_in("Asia/Tokyo") - hour_in("Etc/UTC")) % 24.0 == pytest.approx(9.0, abs=0.1)
    finally:
        robot.ALAutonomousLife.setState("disabled")
        system.setTimezone(before)


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


def test_the_icon_is_a_picture_of_the_robot(system):
    small, usual = (Image.open(io.BytesIO(bytes(system.robotIcon(*size)))) for size in ((48,), ()))
    assert (small.format, small.size, usual.size) == ("PNG", (48, 48), (128, 128))
    assert len(set(usual.convert("RGB").getdata())) > 50
    with pytest.raises(RuntimeError, match="ALSystem::robotIcon size is 5, allowed is a whole number, 16 to 1024"):
        system.robotIcon(5)


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("changePassword", ("nao", "secret"), "needs no password"),
        ("factoryReset", ("image", "checksum"), "no disk to flash; reboot, or NaoSimulation.reset"),
        ("upgrade", ("image", "checksum"), "it offers what NAOqi 2.8"),
    ],
)
def test_what_would_flash_a_robot_is_refused_and_says_what_to_do(system, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALSystem::{method} .*{message}"):
        system.call(method, *arguments)


def test_an_icon_cannot_be_set():
    with pytest.raises(RuntimeError, match="its picture"):
        ALSystem(MemoryStore(lambda: 0.0), lambda: None, lambda: None).setRobotIcon(object())


def test_there_are_no_applications_to_back_up(system):
    assert list(system.appBackupInfo()) == []
