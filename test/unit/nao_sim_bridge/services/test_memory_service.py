"""ALMemory over the network: data, events, and modules of clients that are called back."""

from __future__ import annotations

import queue

import pytest

from nao_sim_bridge.services.memory_store import HISTORY_LENGTH

SENSOR = "Device/SubDeviceList/HeadYaw/Position/Sensor/Value"


@pytest.fixture
def memory(shared_robot):
    return shared_robot.ALMemory


@pytest.fixture
def hears(listener, patience):
    """The next call of the listening module."""
    return lambda: listener.heard.get(timeout=patience)


# --- data -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "value", [3, -2.5, "text", "", True, [1, [2.5, "three"], []], ["a", "b"], [[1, 2], [3, 4]], {"a": 1}]
)
def test_values_of_all_kinds_survive(memory, value):
    memory.insertData("Test/Value", value)
    assert memory.getData("Test/Value") == value
    assert memory.getData("Test/Value", 0) == value


def test_lists_of_keys_are_written_and_read_at_once(memory):
    memory.insertListData([["Test/One", 1], ["Test/Two", [2.0]]])
    assert memory.getListData(["Test/Two", "Test/Nothing", "Test/One"]) == [[2.0], None, 1]


@pytest.mark.parametrize("pairs", [["Test/One", 1], [["Test/Bad"]], [["Test/Bad", 1, 2]], [[1, 2]]])
def test_a_malformed_list_writes_nothing(memory, pairs):
    with pytest.raises(
        RuntimeError, match=r"ALMemory::insertListData list holds .*, allowed is \[\[key, value\], ...\]"
    ):
        memory.insertListData([["Test/Good", 1], *pairs])
    assert "Test/Good" not in memory.getDataListName()


@pytest.mark.parametrize("pairs", [3, "Test/One", {"Test/One": 1}, None])
def test_what_is_no_list_of_pairs_is_refused(memory, pairs):
    with pytest.raises(RuntimeError, match=r"ALMemory::insertListData list is .*, allowed is \[\[key, value\], ...\]"):
        memory.insertListData(pairs)


@pytest.mark.parametrize("keys", ["Test/One", [1, 2]])
def test_a_malformed_list_of_keys_is_refused(memory, keys):
    with pytest.raises(RuntimeError, match="keyList is .*, allowed is a list of strings"):
        memory.getListData(keys)


def test_an_unknown_key_offers_the_closest(memory):
    with pytest.raises(RuntimeError, match=f"ALMemory::getData unknown key .* did you mean '{SENSOR}'"):
        memory.getData(SENSOR.replace("Yaw", "Yow"))


def test_an_empty_name_is_refused(memory):
    for call in (memory.insertData, memory.raiseEvent, memory.raiseMicroEvent):
        with pytest.raises(RuntimeError, match="the key is empty"):
            call("", 1)
    with pytest.raises(RuntimeError, match="the key is empty"):
        memory.declareEvent("")


def test_a_sensor_cannot_be_written(memory):
    with pytest.raises(RuntimeError, match="is a sensor of the robot and cannot be written"):
        memory.insertData(SENSOR, 1.0)
    with pytest.raises(RuntimeError, match="cannot be removed"):
        memory.removeData(SENSOR)


def test_keys_are_listed_and_searched(memory):
    memory.insertData("Test/Listed/One", 1)
    memory.declareEvent("Test/Listed/Event")
    assert memory.getDataList("Test/Listed/") == ["Test/Listed/Event", "Test/Listed/One"]
    names = memory.getDataListName()
    assert {SENSOR, "Test/Listed/One", "NAOqiReady"} <= set(names)
    assert len(names) > 303


def test_a_removed_key_is_gone(memory):
    memory.insertData("Test/Gone", 1)
    memory.removeData("Test/Gone")
    with pytest.raises(RuntimeError, match="unknown key 'Test/Gone'"):
        memory.getData("Test/Gone")


def test_kind_and_description(memory):
    memory.insertData("Test/Described", 1)
    memory.setDescription("Test/Described", "a number")
    memory.declareEvent("Test/DescribedEvent")
    memory.raiseMicroEvent("Test/DescribedMicro", 1)
    kinds = [memory.getType(f"Test/Described{kind}") for kind in ("", "Event", "Micro")]
    assert kinds == ["Data", "Event", "MicroEvent"]
    assert memory.getDescriptionList(["Test/Described"]) == [["Test/Described", "Data", "a number"]]
    assert ["Test/DescribedEvent", "Event", ""] in memory.getDescriptionList([])


def test_timestamps_are_simulated_time(shared_robot):
    robot = shared_robot
    robot.ALMemory.insertData("Test/Time", "x")
    written = robot.now.time
    robot.advance(1.25)
    value, seconds, microseconds = robot.ALMemory.getTimestamp("Test/Time")
    assert value == "x"
    assert seconds + 1e-6 * microseconds == pytest.approx(written, abs=2e-6)
    _, seconds, microseconds = robot.ALMemory.getTimestamp(SENSOR)
    assert seconds + 1e-6 * microseconds == pytest.approx(robot.now.time, abs=2e-6)


def test_waiting_for_a_change_blocks_nobody(shared_robot):
    robot = shared_robot
    robot.ALMemory.insertData("Test/Change", 1)
    future = robot.post("ALMemory", "getDataOnChange", "Test/Change", 0)
    assert robot.ALMemory.getData("Test/Change") == 1
    assert future.isRunning()
    robot.ALMemory.insertData("Test/Change", 2)
    assert robot.answer(future) == 2


def test_pointers_are_refused_with_the_way_out(memory):
    for method in (memory.getDataPtr, memory.getFloatPtr, memory.getIntPtr):
        with pytest.raises(RuntimeError, match="use getData"):
            method(SENSOR)


# --- events called back -----------------------------------------------------------------------------------------------


def test_a_subscribed_module_is_called_with_name_value_and_message(memory, hears):
    memory.subscribeToEvent("Test/Event", "Listener", "onEvent")
    memory.raiseEvent("Test/Event", [1, "two"])
    assert hears() == ("Test/Event", [1, "two"], "")
    memory.subscribeToEvent("Test/Event", "Listener", "my message", "onEvent")
    memory.raiseEvent("Test/Event", 2)
    assert hears() == ("Test/Event", 2, "my message")
    assert memory.getSubscribers("Test/Event") == ["Listener"]
    memory.unsubscribeToEvent("Test/Event", "Listener")
    assert memory.getSubscribers("Test/Event") == []


def test_micro_events_call_back_as_well(memory, hears):
    memory.subscribeToMicroEvent("Test/Micro", "Listener", "hello", "onEvent")
    memory.raiseMicroEvent("Test/Micro", 1.5)
    assert hears() == ("Test/Micro", 1.5, "hello")
    assert "Test/Micro" in memory.getMicroEventList()
    memory.unsubscribeToMicroEvent("Test/Micro", "Listener")
    memory.removeMicroEvent("Test/Micro")
    assert "Test/Micro" not in memory.getMicroEventList()


def test_who_unsubscribed_is_not_called_any_more(memory, listener, hears):
    memory.subscribeToEvent("Test/Silent", "Listener", "onEvent")
    memory.subscribeToEvent("Test/Loud", "Listener", "onEvent")
    memory.unsubscribeToEvent("Test/Silent", "Listener")
    memory.raiseEvent("Test/Silent", 1)
    memory.raiseEvent("Test/Loud", 2)
    assert hears() == ("Test/Loud", 2, "")
    assert listener.heard.empty()
    memory.unsubscribeToEvent("Test/Loud", "Listener")


def test_unsubscribing_a_stranger_names_who_is_subscribed(memory):
    memory.subscribeToEvent("Test/Named", "Somebody", "onEvent")
    with pytest.raises(RuntimeError, match="'Nobody' is not subscribed to 'Test/Named'; subscribed is Somebody"):
        memory.unsubscribeToEvent("Test/Named", "Nobody")
    memory.unregisterModuleReference("Somebody")
    assert memory.getSubscribers("Test/Named") == []


def test_a_subscriber_that_is_gone_disturbs_nobody(memory, hears):
    memory.subscribeToEvent("Test/Crowd", "NeverThere", "onEvent")
    memory.subscribeToEvent("Test/Crowd", "Listener", "onNothing")
    memory.subscribeToEvent("Test/Crowd", "listener", "onEvent")
    memory.unsubscribeToEvent("Test/Crowd", "Listener")
    memory.subscribeToEvent("Test/Crowd", "Listener", "onEvent")
    memory.raiseEvent("Test/Crowd", 1)
    assert hears() == ("Test/Crowd", 1, "")
    for module in ("NeverThere", "listener", "Listener"):
        memory.unregisterModuleReference(module)


# --- events listed ----------------------------------------------------------------------------------------------------


def test_declared_events_belong_to_their_extractor(memory):
    memory.declareEvent("Test/Face", "TestExtractor")
    memory.declareEvent("Test/Plain")
    assert memory.getExtractorEvent("TestExtractor") == ["Test/Face"]
    assert {"Test/Face", "Test/Plain", "robotIsWakeUp"} <= set(memory.getEventList())


def test_the_history_of_an_event(memory):
    for n in range(HISTORY_LENGTH + 1):
        memory.raiseEvent("Test/History", n)
    history = memory.getEventHistory("Test/History")
    assert [entry[0] for entry in history] == list(range(1, HISTORY_LENGTH + 1))
    assert all(len(entry) == 3 for entry in history)


def test_removing_an_event_needs_an_event(memory):
    memory.insertData("Test/NoEvent", 1)
    with pytest.raises(RuntimeError, match="unknown Event 'Test/NoEvent'"):
        memory.removeEvent("Test/NoEvent")
    memory.raiseEvent("Test/Removed", 1)
    memory.removeEvent("Test/Removed")
    assert "Test/Removed" not in memory.getEventList()


# --- events as signals ------------------------------------------------------------------------------------------------


def test_a_subscriber_object_signals_every_value(memory, patience):
    heard = queue.Queue()
    subscriber = memory.subscriber("Test/Signal")
    subscriber.signal.connect(heard.put)
    memory.raiseEvent("Test/Signal", [1, 2])
    memory.raiseEvent("Test/Signal", "x")
    assert sorted((heard.get(timeout=patience) for _ in range(2)), key=repr) == ["x", [1, 2]]


@pytest.mark.parametrize("remove", ["removeEvent", "removeData"])
def test_an_event_that_was_removed_can_be_subscribed_to_anew(memory, patience, remove):
    memory.raiseEvent("Test/Again", 0)
    memory.subscriber("Test/Again")
    getattr(memory, remove)("Test/Again")
    heard = queue.Queue()
    subscriber = memory.subscriber("Test/Again")
    subscriber.signal.connect(heard.put)
    memory.raiseEvent("Test/Again", 5)
    assert heard.get(timeout=patience) == 5


def test_signals_of_a_service_become_events(memory, listener, patience):
    heard = queue.Queue()
    memory.addMapping("Listener", "touched", "Test/Touched")
    memory.addMapping("Listener", {"moved": "Test/Moved"})
    subscribers = [memory.subscriber(event) for event in ("Test/Touched", "Test/Moved")]
    for subscriber in subscribers:
        subscriber.signal.connect(heard.put)
    listener.touched(3)
    assert heard.get(timeout=patience) == 3
    listener.moved(4, 5)
    assert heard.get(timeout=patience) == [4, 5]
    with pytest.raises(RuntimeError, match="service 'Listener' has no signal 'tuched'"):
        memory.addMapping("Listener", "tuched", "Test/Touched")
