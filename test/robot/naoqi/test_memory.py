"""ALMemory: data, events, and modules of clients that are called back."""

import sys

import pytest
from simulator import PATIENCE

from nao_sim_bridge.naoqi.memory.store import HISTORY_LENGTH

SENSOR = "Device/SubDeviceList/HeadYaw/Position/Sensor/Value"
VALUES = [3, -2.5, "text", "", True, [1, [2.5, "three"], []], ["a", "b"], [[1, 2], [3, 4]], {"a": 1}]


@pytest.fixture
def memory(robot):
    return robot.ALMemory


def test_values_of_all_kinds_survive_alone_and_in_lists(memory):
    for value in VALUES:
        memory.insertData("Test/Value", value)
        assert memory.getData("Test/Value") == value == memory.getData("Test/Value", 0)
    memory.insertListData([["Test/One", 1], ["Test/Two", [2.0]]])
    assert memory.getListData(["Test/Two", "Test/Nothing", "Test/One"]) == [[2.0], None, 1]


def test_keys_are_listed_described_and_removed(memory):
    memory.insertData("Test/Listed", 1)
    memory.setDescription("Test/Listed", "a number")
    memory.declareEvent("Test/ListedEvent")
    memory.raiseMicroEvent("Test/ListedMicro", 1)
    names = memory.getDataListName()
    assert {SENSOR, "Test/Listed", "NAOqiReady"} <= set(names) and len(names) > 303
    assert [memory.getType(f"Test/Listed{kind}") for kind in ("", "Event", "Micro")] == ["Data", "Event", "MicroEvent"]
    assert memory.getDescriptionList(["Test/Listed"]) == [["Test/Listed", "Data", "a number"]]
    memory.removeData("Test/Listed")
    with pytest.raises(RuntimeError, match="ALMemory::getData unknown key 'Test/Listed'"):
        memory.getData("Test/Listed")


def test_timestamps_are_simulated_time(robot, memory):
    robot.advance(0.5)
    memory.insertData("Test/Time", "x")
    written = robot.now.time
    robot.advance(1.25)
    for key, when in (("Test/Time", written), (SENSOR, robot.now.time)):
        value, seconds, microseconds = memory.getTimestamp(key)
        assert seconds + 1e-6 * microseconds == pytest.approx(when, abs=2e-6)
    assert memory.getTimestamp("Test/Time")[0] == "x"


def test_waiting_for_a_change_blocks_nobody(robot, memory):
    memory.insertData("Test/Change", 1)
    future = robot.post("ALMemory", "getDataOnChange", "Test/Change", 0)
    assert memory.getData("Test/Change") == 1 and future.isRunning()
    memory.insertData("Test/Change", 2)
    assert robot.answer(future) == 2


def test_a_wait_for_a_change_ends_when_it_is_cancelled_and_is_refused_for_a_sensor(robot, memory, refuses):
    memory.insertData("Test/Change", 1)
    future = robot.post("ALMemory", "getDataOnChange", "Test/Change", 0)
    robot.handed_over("ALMemory")
    future.cancel()
    future.wait(int(1000 * PATIENCE))
    assert future.isCanceled()
    refuses("ALMemory", f"getDataOnChange('{SENSOR}', 0) -> is measured when it is read")


def test_what_is_wrong_is_told_and_writes_nothing(memory, refuses):
    memory.insertData("Test/Data", 1)
    memory.subscribeToEvent("Test/Named", "Somebody", "onEvent")
    refuses("ALMemory", r"""
        insertListData([['Test/Good', 1], 'Test/One', 1]) -> list holds 'Test/One', allowed is \[\[key, value\], ...\]
        insertListData([['Test/Good', 1], ['Test/Bad']]) -> list holds \['Test/Bad'\], allowed
        insertListData(3) -> list is 3, allowed is \[\[key, value\], ...\]
        getListData('Test/One') -> keyList is 'Test/One', allowed is a list of strings
        getData('Device/SubDeviceList/HeadYow/Position/Sensor/Value') -> unknown key .*did you mean '.*HeadYaw/Pos
        insertData('', 1) -> the key is empty
        declareEvent('') -> the key is empty
        insertData('Device/SubDeviceList/HeadYaw/Position/Sensor/Value', 1.0) -> is a sensor .* cannot be written
        removeEvent('Test/Data') -> unknown Event 'Test/Data'
        getDataPtr('Test/Data') -> use getData
        unsubscribeToEvent('Test/Named', 'Nobody') -> 'Nobody' is not subscribed to 'Test/Named'; subscribed is Somebody
    """)  # fmt: skip
    assert "Test/Good" not in memory.getDataListName()
    memory.unregisterModuleReference("Somebody")
    assert memory.getSubscribers("Test/Named") == []


def test_a_subscribed_module_is_called_with_name_value_and_message(memory, listener):
    memory.subscribeToEvent("Test/Event", "Listener", "onEvent")
    memory.raiseEvent("Test/Event", [1, "two"])
    assert listener.next() == ("Test/Event", [1, "two"], "")
    memory.subscribeToEvent("Test/Event", "Listener", "my message", "onEvent")
    memory.raiseEvent("Test/Event", 2)
    assert listener.next() == ("Test/Event", 2, "my message")
    assert memory.getSubscribers("Test/Event") == ["Listener"]
    memory.subscribeToMicroEvent("Test/Micro", "Listener", "hello", "onEvent")
    memory.unsubscribeToEvent("Test/Event", "Listener")
    memory.raiseEvent("Test/Event", 3)
    memory.raiseMicroEvent("Test/Micro", 4)
    assert listener.next() == ("Test/Micro", 4, "hello") and listener.heard.empty()
    memory.unsubscribeToMicroEvent("Test/Micro", "Listener")
    assert memory.getSubscribers("Test/Event") == memory.getSubscribers("Test/Micro") == []


def test_events_are_listed_with_their_history_and_removed(memory):
    memory.declareEvent("Test/Face", "TestExtractor")
    memory.raiseMicroEvent("Test/Micro", 1)
    for n in range(HISTORY_LENGTH + 1):
        memory.raiseEvent("Test/History", n)
    assert memory.getExtractorEvent("TestExtractor") == ["Test/Face"]
    assert {"Test/Face", "Test/History", "robotIsWakeUp"} <= set(memory.getEventList())
    assert memory.getMicroEventList() == ["Test/Micro"]
    history = memory.getEventHistory("Test/History")
    assert [entry[0] for entry in history] == list(range(1, HISTORY_LENGTH + 1)) and {len(e) for e in history} == {3}
    memory.removeEvent("Test/History")
    memory.removeMicroEvent("Test/Micro")
    assert "Test/History" not in memory.getEventList() and memory.getMicroEventList() == []


def test_a_subscriber_object_signals_every_value_also_anew_after_a_removal(robot, memory):
    heard = robot.heard("Test/Signal")
    memory.raiseEvent("Test/Signal", [1, 2])
    memory.raiseEvent("Test/Signal", "x")
    assert sorted((heard.get(timeout=PATIENCE) for _ in range(2)), key=repr) == ["x", [1, 2]]
    memory.removeEvent("Test/Signal")
    again = robot.heard("Test/Signal")
    memory.raiseEvent("Test/Signal", 5)
    assert again.get(timeout=PATIENCE) == 5


@pytest.mark.parametrize(
    "event, module",
    [
        ("FaceDetected", "ALFaceDetection"),
        ("SoundDetected", "ALSoundDetection"),
        ("PictureDetected", "ALVisionRecognition"),
        ("DarknessDetection/DarknessDetected", "ALDarknessDetection"),
    ],
)
def test_who_subscribes_to_an_event_starts_the_module_that_raises_it(robot, memory, listener, event, module):
    memory.subscribeToEvent(event, "Listener", "onEvent")
    extractor = getattr(robot, module)
    assert [name for name, *_ in extractor.getSubscribersInfo()] == ["Listener"] and extractor.isProcessing()
    memory.unsubscribeToEvent(event, "Listener")
    assert extractor.getSubscribersInfo() == [] and not extractor.isProcessing()


def test_signals_of_a_service_become_events(robot, memory, listener):
    memory.addMapping("Listener", "touched", "Test/Touched")
    memory.addMapping("Listener", {"moved": "Test/Moved"})
    heard = [robot.heard(event) for event in ("Test/Touched", "Test/Moved")]
    listener.touched(3)
    listener.moved(4, 5)
    assert [values.get(timeout=PATIENCE) for values in heard] == [3, [4, 5]]
    with pytest.raises(RuntimeError, match="ALMemory::addMapping service 'Listener' has no signal 'tuched'"):
        memory.addMapping("Listener", "tuched", "Test/Touched")


def test_an_event_keeps_nothing_of_its_values_and_of_those_who_asked_for_it(robot, memory):
    told, values = robot.heard("Test/Kept"), [f"value {n}" for n in range(2 * HISTORY_LENGTH)]
    references = lambda: [sys.getrefcount(value) for value in values[:HISTORY_LENGTH]]  # noqa: E731
    before, blocks = references(), sys.getallocatedblocks()
    for _ in range(1000):
        memory.subscriber("Test/Kept")
    assert sys.getallocatedblocks() - blocks < 1000  # three blocks are kept of each object that qi makes of one
    for value in values:
        robot.server.memory.raise_event("Test/Kept", value)
    assert sorted(told.get(timeout=PATIENCE) for _ in values) == sorted(values)
    assert references() == before
