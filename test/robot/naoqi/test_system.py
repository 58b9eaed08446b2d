"""ALSystem: name, clock, machine, and what a simulated robot has not."""

import io

import pytest
from PIL import Image

from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.system import ALSystem


@pytest.fixture
def system(robot):
    return robot.ALSystem


def test_the_name_can_be_changed_and_is_announced(robot, system):
    assert system.setRobotName("Marvin-2") is True
    assert system.robotName() == "Marvin-2" == robot.value("ALSystem/RobotNameChanged")
    assert ["name", "Marvin-2"] in system.systemInfo()
    for name in ("", "two words", "../etc"):
        with pytest.raises(RuntimeError, match="setRobotName name is .*, allowed are letters, digits and hyp"):
            system.setRobotName(name)
    assert system.robotName() == "Marvin-2"


def test_the_robots_clock_is_that_of_its_time_zone(robot, system):
    def hour_in(zone):
        assert system.setTimezone(zone) is True and system.timezone() == zone
        robot.advance(1.1)
        return robot.value("Launchpad/Hour") + robot.value("Launchpad/Minute") / 60.0

    before = system.timezone()
    for wrong in ("Mars/Olympus", "", "../../../etc/passwd"):
        assert system.setTimezone(wrong) is False and system.timezone() == before
    robot.ALAutonomousLife.setAutonomousAbilityEnabled("All", False)
    robot.finish("ALAutonomousLife", "setState", "solitary", after=3.0)
    assert (hour_in("Asia/Tokyo") - hour_in("Etc/UTC")) % 24.0 == pytest.approx(9.0, abs=0.1)


def test_memory_is_that_of_the_computer_in_mib(system):
    assert 50 < system.freeMemory() < system.totalMemory() < 100_000_000


def test_a_reboot_puts_the_robot_to_the_start(robot, system):
    robot.finish("ALMotion", "wakeUp", after=2.5)
    system.reboot()
    assert robot.ALMotion.getStiffnesses("Body") == [0.0] * 26 and robot.ALMotion.robotIsWakeUp() is False


def test_the_icon_is_a_picture_of_the_robot(system):
    small, usual = (Image.open(io.BytesIO(bytes(system.robotIcon(*size)))) for size in ((48,), ()))
    assert (small.format, small.size, usual.size) == ("PNG", (48, 48), (128, 128))
    assert len(set(usual.convert("RGB").getdata())) > 50


def test_what_a_simulated_robot_has_not_is_refused_and_says_what_to_do(refuses):
    refuses("ALSystem", """
        robotIcon(5) -> size is 5, allowed is a whole number, 16 to 1024
        changePassword('nao', 'secret') -> needs no password
        factoryReset('image', 'checksum') -> no disk to flash; reboot, or NaoSimulation.reset
        upgrade('image', 'checksum') -> it offers what NAOqi 2.8
    """)  # fmt: skip
    ended = []
    alone = ALSystem(MemoryStore(lambda: 0.0), lambda: None, lambda: ended.append(True))
    with pytest.raises(RuntimeError, match="its picture"):
        alone.setRobotIcon(object())
    alone.shutdown()
    assert ended == [True]
