"""Keys and events of a memory are topics while somebody listens, and come back with the robot."""

from __future__ import annotations

import fake_memory
import fake_sound
import pytest

from nao_library_modules.clock import WallClock
from nao_library_modules.driver import memory_watch
from nao_library_modules.driver.memory_rules import Rule
from nao_library_modules.driver.memory_watch import MemoryWatch
from nao_library_modules.errors import BadGoal

CHARGE = "Device/SubDeviceList/Battery/Charge/Sensor/Value"
HUNDREDS = {f"Device/Motor{i}/Value": float(i) for i in range(700)}


@pytest.fixture
def memory():
    return fake_memory.Memory(
        {**HUNDREDS, CHARGE: 0.75, "Name": "nao", "FrontTactilTouched": 0.0}, {"FrontTactilTouched", "Never", "Click"}
    )


@pytest.fixture
def robot(make_call, memory, monkeypatch):
    monkeypatch.setattr(memory_watch, "RETRY", 0.01)
    return fake_sound.Robot(make_call, ALMemory=memory)


@pytest.fixture
def topics():
    return fake_memory.Topics()


@pytest.fixture
def watch(robot, topics):
    watch = MemoryWatch(robot, WallClock(), topics.make, 1000)
    yield watch
    watch.close()


def test_data_is_read_only_while_somebody_listens(watch, memory, topics, eventually):
    watch.watch([Rule(CHARGE, 100.0)])
    assert watch.watched() == {CHARGE: CHARGE} and topics[CHARGE].kind == "float"
    assert len(memory.asked) == 1
    topics[CHARGE].tell(True)
    eventually(lambda: len(topics[CHARGE].messages) >= 3)
    assert set(topics[CHARGE].messages) == {0.75}
    topics[CHARGE].tell(False)
    watch.unwatch("Nothing")  # it waits for a reading that is under way
    asked = len(memory.asked)
    watch.watch([Rule("Name")])
    eventually(lambda: "Name" in topics)
    assert len(memory.asked) == asked + 1, "the new key, and no reading of the charge"


def test_hundreds_of_keys_take_few_questions(watch, memory, topics, eventually):
    watch.watch([Rule("Device/Motor*", 20.0)])
    assert len(watch.watched("*")) == 700
    assert max(memory.asked) == 500 and len([count for count in memory.asked if count]) == 2
    memory.asked.clear()
    for i in range(0, 700, 7):
        topics[f"Device/Motor{i}/Value"].tell(True)
    eventually(lambda: all(len(topics[f"Device/Motor{i}/Value"].messages) > 2 for i in range(0, 700, 7)))
    assert memory.asked[-1] == 100, "keys of one rate are read together"
    assert topics["Device/Motor7/Value"].messages[0] == 7.0
    assert not topics["Device/Motor8/Value"].messages


def test_an_event_is_subscribed_only_while_somebody_listens(watch, memory, topics, eventually):
    watch.watch([Rule("FrontTactilTouched")])
    assert memory.listeners("FrontTactilTouched") == 0
    topic = topics["FrontTactilTouched"]
    topic.tell(True)
    eventually(lambda: topic.messages == [0.0])  # how it stands
    memory.raiseEvent("FrontTactilTouched", 1.0)
    assert topic.messages == [0.0, 1.0]
    topic.tell(False)
    eventually(lambda: memory.listeners("FrontTactilTouched") == 0)
    memory.raiseEvent("FrontTactilTouched", 0.0)
    assert topic.messages == [0.0, 1.0]


def test_an_event_that_was_never_raised_has_a_topic_from_then_on(watch, memory, topics, eventually):
    watch.watch([Rule("Never"), Rule("Click", kind="string")])
    assert watch.watched() == {"Never": "", "Click": "Click"}
    eventually(lambda: memory.listeners("Never") == 1)
    memory.raiseEvent("Never", [1, 2])
    eventually(lambda: "Never" in topics and topics["Never"].kind == "int[]")
    topics["Never"].tell(True)
    eventually(lambda: topics["Never"].messages[-1:] == [[1, 2]])
    topics["Click"].tell(True)
    eventually(lambda: memory.listeners("Click") == 1)
    memory.raiseEvent("Click", None)
    assert topics["Click"].messages == ["null"]


def test_keys_that_appear_later_are_watched_too(watch, memory, topics, eventually):
    watch.watch([Rule("Mine/*"), Rule("Later")])
    memory.insertData("Mine/Text", "a")
    memory.insertData("Yours/Text", "b")
    memory.insertData("Later", 3)
    eventually(lambda: "Mine/Text" in topics and "Later" in topics)
    assert set(watch.watched()) == {"Mine/Text", "Later"}


def test_an_event_that_comes_too_often_is_thinned_out(watch, memory, topics, eventually):
    watch.watch([Rule("FrontTactilTouched", 4.0)])
    topic = topics["FrontTactilTouched"]
    topic.tell(True)
    eventually(lambda: topic.messages)
    for i in range(1, 200):
        memory.raiseEvent("FrontTactilTouched", float(i))
    eventually(lambda: topic.messages[-1] == 199.0)
    assert len(topic.messages) <= 4


def test_it_goes_on_after_a_loss(watch, robot, memory, topics, eventually):
    watch.watch([Rule("FrontTactilTouched"), Rule(CHARGE, 100.0)])
    for name in ("FrontTactilTouched", CHARGE):
        topics[name].tell(True)
    eventually(lambda: topics[CHARGE].messages and memory.listeners("FrontTactilTouched") == 1)
    robot.lose()
    eventually(lambda: watch.report().message == "the robot is not connected")
    memory.values["FrontTactilTouched"] = 1.0
    count = len(topics[CHARGE].messages)
    robot.come_back()
    eventually(lambda: topics["FrontTactilTouched"].messages == [0.0, 1.0] and len(topics[CHARGE].messages) > count)
    assert memory.listeners("FrontTactilTouched") == 1
    memory.raiseEvent("FrontTactilTouched", 0.0)
    assert topics["FrontTactilTouched"].messages == [0.0, 1.0, 0.0]


def test_what_is_asked_of_a_lost_robot_waits_for_it(watch, robot, topics, eventually):
    robot.lose()
    watch.watch([Rule(CHARGE)])
    assert watch.watched() == {}
    robot.come_back()
    eventually(lambda: CHARGE in topics)


def test_unwatching_closes_topics(watch, memory, topics, eventually):
    watch.watch([Rule("*")])
    assert len(watch.unwatch("Device/*")) == 701
    assert CHARGE not in topics and "Name" in topics
    assert set(watch.watched()) == {"Name", "FrontTactilTouched", "Never", "Click"}
    watch.unwatch("*")
    assert watch.watched() == {} and watch.report().message == "nothing is watched"
    eventually(lambda: memory.listeners("Never") == 0)


def test_too_many_keys_are_refused_and_nothing_changes(robot, topics):
    watch = MemoryWatch(robot, WallClock(), topics.make, 100)
    watch.watch([Rule(CHARGE)])
    with pytest.raises(BadGoal, match="705 keys.*100 at most"):
        watch.watch([Rule("*")])
    assert watch.watched() == {CHARGE: CHARGE}
    watch.watch([Rule("Name")])
    assert set(watch.watched()) == {CHARGE, "Name"}
    watch.close()


def test_keys_that_come_above_the_limit_do_not_end_what_is_watched(robot, memory, topics, eventually):
    watch = MemoryWatch(robot, WallClock(), topics.make, 2)
    watch.watch([Rule(CHARGE, 100.0), Rule("Mine/*")])
    topics[CHARGE].tell(True)
    for i in range(3):
        memory.insertData(f"Mine/{i}", i)
    eventually(lambda: "4 keys are to be watched" in watch.report().message)
    count = len(topics[CHARGE].messages)
    eventually(lambda: len(topics[CHARGE].messages) > count)
    watch.close()
