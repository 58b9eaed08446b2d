"""Every change of every touch sensor, and how they stand at the beginning."""

from __future__ import annotations

import fake_memory
import fake_sound
import pytest

from nao_library_modules.driver import demand
from nao_library_modules.driver.touch_sensors import BUMPER, CLICKS, FEET, HAND, HEAD, SENSORS, TouchSensors
from nao_library_msgs.msg import Bumper, HandTouch, TactileTouch

FRONT = "Device/SubDeviceList/Head/Touch/Front/Sensor/Value"
LEFT_BUMPERS = [f"Device/SubDeviceList/LFoot/Bumper/{side}/Sensor/Value" for side in ("Left", "Right")]


@pytest.fixture
def memory():
    return fake_memory.Memory({**dict.fromkeys([FRONT, *LEFT_BUMPERS], 0.0), "footContact": 1.0})


@pytest.fixture
def robot(make_call, memory, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    return fake_sound.Robot(make_call, ALMemory=memory)


@pytest.fixture
def told():
    return []


@pytest.fixture
def make_sensors(robot, told):
    made = []

    def make():
        made.append(TouchSensors(robot, lambda s, now: told.append((s.place, s.number, now)), told.append))
        return made[-1]

    yield make
    for sensors in made:
        sensors.close()


def listening(sensors):
    return sensors.report().message == "touches are told"


def test_events_are_told_once_a_change(make_sensors, memory, told, eventually):
    sensors = make_sensors()
    eventually(lambda: listening(sensors))
    assert told == [(FEET, 0, True)]
    for value in (1.0, 1.0, 0.0):
        memory.raiseEvent("HandLeftLeftTouched", value)
    memory.raiseEvent("RightBumperPressed", 1.0)
    memory.raiseEvent("ALChestButton/DoubleClickOccurred", None)
    memory.raiseEvent("footContactChanged", False)
    memory.raiseEvent("FrontTactilTouched", None)
    assert told[1:] == [(HAND, 4, True), (HAND, 4, False), (BUMPER, 0, True), 2, (FEET, 0, False)]
    assert sensors.report().values["RightBumperPressed"] == "touched"


def test_what_is_touched_at_the_beginning_is_told(make_sensors, memory, told, eventually):
    memory.values.update({FRONT: 1.0, LEFT_BUMPERS[1]: 1.0, "footContact": 0.0})
    sensors = make_sensors()
    eventually(lambda: listening(sensors))
    assert told == [(HEAD, 1, True), (BUMPER, 1, True), (FEET, 0, False)]


def test_a_robot_without_feet_says_nothing_of_them(make_sensors, memory, told, eventually):
    del memory.values["footContact"]
    sensors = make_sensors()
    eventually(lambda: listening(sensors))
    assert told == []
    assert sensors.report().values["footContactChanged"] == "unknown"


def test_what_changed_while_the_robot_was_lost_is_told(make_sensors, robot, memory, told, eventually):
    memory.values[FRONT] = 1.0
    sensors = make_sensors()
    eventually(lambda: listening(sensors))
    robot.lose()
    assert "deaf" in sensors.report().message
    memory.values.update({FRONT: 0.0, LEFT_BUMPERS[0]: 1.0})
    told.clear()
    robot.come_back()
    eventually(lambda: listening(sensors))
    assert told == [(HEAD, 1, False), (BUMPER, 1, True)]
    memory.raiseEvent("FrontTactilTouched", 1.0)
    assert told[2:] == [(HEAD, 1, True)]
    assert memory.listeners("FrontTactilTouched") == 1


def test_an_event_counts_more_than_what_was_read_before_it(make_sensors, memory, told, eventually):
    read = memory.getListData

    def slow(keys):
        values = read(keys)
        memory.raiseEvent("FrontTactilTouched", 1.0)
        return values

    memory.getListData = slow
    sensors = make_sensors()
    eventually(lambda: listening(sensors))
    assert (HEAD, 1, True) in told and (HEAD, 1, False) not in told


def test_events_that_come_in_the_wrong_order_are_put_right(make_sensors, memory, told, eventually, monkeypatch):
    monkeypatch.setattr(demand, "LOOK_PERIOD", 0.01)
    sensors = make_sensors()
    eventually(lambda: listening(sensors))
    told.clear()
    memory.values[FRONT] = 0.0  # pressed and let go at once
    memory.raiseEvent("FrontTactilTouched", 0.0)
    memory.raiseEvent("FrontTactilTouched", 1.0)
    eventually(lambda: told == [(HEAD, 1, True), (HEAD, 1, False)])


def test_numbers_are_those_of_the_messages():
    numbers = {sensor.event: sensor.number for sensor in SENSORS}
    assert numbers["RearTactilTouched"] == TactileTouch.buttonRear
    assert numbers["HandRightLeftTouched"] == HandTouch.RIGHT_LEFT
    assert numbers["HandLeftBackTouched"] == HandTouch.LEFT_BACK
    assert numbers["LeftBumperPressed"] == Bumper.left
    assert len(SENSORS) == 13 and len(CLICKS) == 3
