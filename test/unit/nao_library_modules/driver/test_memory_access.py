"""The robot's memory, asked and written."""

from __future__ import annotations

import fake_memory
import fake_sound
import pytest

from nao_library_modules.driver.memory_access import MemoryAccess
from nao_library_modules.errors import BadGoal
from naoqi.errors import RobotUnreachable


@pytest.fixture
def memory():
    return fake_memory.Memory({**{f"Key{i}": i for i in range(1200)}, "Front": 0.0}, {"Front", "Never"})


@pytest.fixture
def robot(make_call, memory):
    return fake_sound.Robot(make_call, ALMemory=memory)


@pytest.fixture
def access(robot):
    return MemoryAccess(robot)


def test_many_keys_are_asked_for_in_parts(access, memory):
    keys = [f"Key{i}" for i in range(1200)]
    assert access.values(keys) == list(range(1200))
    assert memory.asked == [500, 500, 200]
    assert access.values([]) == [] and len(memory.asked) == 3


def test_events_are_known_among_the_keys(access):
    known = access.known()
    assert len(known) == 1202
    assert [key for key, event in known.items() if event] == ["Front", "Never"]


def test_keys_are_found_by_name_and_by_pattern(access):
    assert access.find("Front") == {"Front": 0.0}
    assert access.find("Key119?") == {f"Key119{i}": 1190 + i for i in range(10)}
    assert access.find("Never") == {"Never": None}


@pytest.mark.parametrize(
    "pattern, words",
    [("Frnt", "there is no key 'Frnt': did you mean 'Front'"), ("x*", "no key is like"), ("", "empty")],
)
def test_what_is_not_there_is_told(access, pattern, words):
    with pytest.raises(BadGoal, match=words):
        access.find(pattern)


def test_values_are_written_as_they_are(access, memory):
    access.write("Flag", True, as_event=False)
    access.write("Front", 1.0, as_event=True)
    assert memory.values["Flag"] is True and memory.values["Front"] == 1.0
    assert "Flag" not in memory.events


def test_a_lost_robot_is_told(access, robot):
    robot.lose()
    with pytest.raises(RobotUnreachable):
        access.known()
