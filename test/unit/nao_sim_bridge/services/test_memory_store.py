"""Keys, events and their subscribers, without a network."""

from __future__ import annotations

import threading

import pytest

from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.memory_store import HISTORY_LENGTH, KEY_ADDED, KEY_REMOVED, MemoryStore
from nao_sim_bridge.sim.errors import UnknownName


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def store(clock):
    return MemoryStore(clock)


@pytest.fixture
def heard():
    """Arguments of every call of a subscriber."""
    return []


# --- data -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [0, 1.5, "text", True, [1, [2.0, "three"]], None, {}])
def test_what_is_written_is_read(store, value):
    store.insert("key", value)
    assert store.get("key") == value
    assert store.kind("key") == "Data"
    assert store.names() == ["key"]


def test_a_key_that_is_not_there_offers_the_closest(store):
    store.insert("Robot/Name", "nao")
    with pytest.raises(UnknownName, match="unknown key 'Robot/Nam'.*'Robot/Name'"):
        store.get("Robot/Nam")


def test_an_event_without_a_value_cannot_be_read_yet(store):
    store.declare_event("Happened")
    with pytest.raises(UnknownName):
        store.get("Happened")
    assert store.get_many(["Happened", "nothing"]) == [None, None]
    store.raise_event("Happened", 0)
    assert store.get("Happened") == 0


def test_many_are_read_in_the_order_asked_for(store):
    for key in "abc":
        store.insert(key, key.upper())
    assert store.get_many(["c", "x", "a"]) == ["C", None, "A"]


def test_names_are_sorted_and_can_be_searched(store):
    for key in ("b/Sensor", "a/Sensor", "c/Actuator"):
        store.insert(key, 0)
    assert store.names() == ["a/Sensor", "b/Sensor", "c/Actuator"]
    assert store.names(containing="Sensor") == ["a/Sensor", "b/Sensor"]


def test_a_removed_key_is_gone_with_its_description(store):
    store.insert("key", 1)
    store.set_description("key", "a number")
    store.remove("key")
    assert store.names() == []
    store.insert("key", 2)
    assert store.describe(["key"]) == [["key", "Data", ""]]


def test_removing_asks_for_the_right_kind(store):
    store.insert("key", 1)
    with pytest.raises(UnknownName, match="unknown Event 'key'"):
        store.remove("key", "Event")
    assert store.get("key") == 1


def test_descriptions_of_some_or_all(store):
    store.insert("b", 1)
    store.declare_event("a", "Extractor")
    store.set_description("b", "a number")
    assert store.describe(["b"]) == [["b", "Data", "a number"]]
    assert store.describe([]) == [["a", "Event", ""], ["b", "Data", "a number"]]
    with pytest.raises(UnknownName):
        store.set_description("c", "nothing")


def test_the_time_of_writing_is_kept(store, clock):
    store.insert("key", 1)
    clock.now = 105.5
    assert store.timestamp("key") == (1, 100.0)
    store.insert("key", 2)
    assert store.timestamp("key") == (2, 105.5)


def test_who_waits_for_a_change_hears_of_the_next_one_only(store, heard):
    store.insert("key", 1)
    store.on_next_change("key", heard.append)
    store.insert("other", 5)
    assert heard == []
    store.insert("key", 2)
    store.insert("key", 3)
    assert heard == [2]


# --- live keys --------------------------------------------------------------------------------------------------------


def test_a_live_key_is_computed_when_it_is_read(store, clock):
    values = iter(range(10))
    store.add_live({"sensor": lambda: next(values)})
    assert [store.get("sensor"), store.get_many(["sensor"]), store.get("sensor")] == [0, [1], 2]
    assert store.kind("sensor") == "Data"
    assert "sensor" in store.names()
    clock.now = 107.0
    assert store.timestamp("sensor") == (3, 107.0)


def test_a_sensor_cannot_be_written_or_removed(store):
    store.add_live({"sensor": lambda: 1.0})
    with pytest.raises(NaoqiError, match="sensor is a sensor of the robot and cannot be written"):
        store.insert("sensor", 2.0)
    with pytest.raises(NaoqiError, match="cannot be removed"):
        store.remove("sensor")
    assert store.get("sensor") == 1.0


def test_a_live_key_with_a_writer_takes_values(store, heard):
    store.add_live({"led": lambda: 0.0}, {"led": heard.append})
    store.insert("led", 0.5)
    assert heard == [0.5]


# --- events -----------------------------------------------------------------------------------------------------------


def subscribe(store, heard, name="Happened", module="Listener", **options):
    store.subscribe(name, module, lambda *arguments: heard.append((module, *arguments)), **options)


def test_subscribers_hear_name_value_and_their_message(store, heard):
    subscribe(store, heard, message="hello")
    store.raise_event("Happened", [1, 2])
    assert heard == [("Listener", "Happened", [1, 2], "hello")]
    assert store.get("Happened") == [1, 2]
    assert store.kind("Happened") == "Event"


def test_a_module_subscribes_once_to_an_event(store, heard):
    subscribe(store, heard, message="old")
    subscribe(store, heard, message="new")
    store.raise_event("Happened", 1)
    assert heard == [("Listener", "Happened", 1, "new")]


def test_all_subscribers_hear_even_when_one_fails(store, heard):
    def fail(*_):
        raise ValueError("deaf")

    store.subscribe("Happened", "Deaf", fail)
    subscribe(store, heard, module="Other")
    store.raise_event("Happened", 1)
    assert [entry[0] for entry in heard] == ["Other"]
    assert store.subscribers("Happened") == ["Deaf", "Other"]


def test_who_unsubscribes_hears_no_more(store, heard):
    subscribe(store, heard)
    store.unsubscribe("Happened", "Listener")
    store.raise_event("Happened", 1)
    assert heard == []
    with pytest.raises(NaoqiError, match="'Listener' is not subscribed to 'Happened'; subscribed is nobody"):
        store.unsubscribe("Happened", "Listener")


def test_a_module_that_is_gone_is_forgotten_everywhere(store, heard):
    for name in ("One", "Two"):
        subscribe(store, heard, name)
        subscribe(store, heard, name, module="Other")
    store.forget_module("Listener")
    assert store.subscribers("One") == store.subscribers("Two") == ["Other"]


def test_plain_data_notifies_nobody_until_it_becomes_an_event(store, heard):
    store.insert("key", 1)
    store.listen("key", heard.append)
    store.insert("key", 2)
    assert heard == []
    store.raise_event("key", 3)
    assert heard == [3]


def test_a_removed_event_takes_its_subscribers_along(store, heard):
    subscribe(store, heard)
    store.listen("Happened", heard.append)
    store.remove("Happened", "Event")
    store.raise_event("Happened", 1)
    assert heard == []
    assert store.subscribers("Happened") == []


def test_micro_events_are_a_kind_of_their_own(store, heard):
    subscribe(store, heard, "Light", kind="MicroEvent")
    store.raise_micro_event("Light", 1)
    assert store.kind("Light") == "MicroEvent"
    assert store.names("MicroEvent") == ["Light"]
    assert store.names("Event") == []
    assert len(heard) == 1


def test_events_of_an_extractor(store):
    store.declare_event("Face", "ALFaceDetection")
    store.declare_event("Mark", "ALLandMarkDetection")
    store.declare_event("Face")
    assert store.events_of("ALFaceDetection") == ["Face"]


def test_the_history_keeps_the_last_values_with_their_times(store, clock):
    for n in range(HISTORY_LENGTH + 3):
        clock.now = float(n)
        store.raise_event("Happened", n)
    history = store.history("Happened")
    assert len(history) == HISTORY_LENGTH
    assert history[0] == (3, 3.0)
    assert history[-1] == (HISTORY_LENGTH + 2, HISTORY_LENGTH + 2.0)
    with pytest.raises(UnknownName, match="unknown event"):
        store.history("nothing")


def test_keys_that_come_and_go_are_announced_to_who_wants_to_know(store, heard):
    store.insert("before", 1)
    for event in (KEY_ADDED, KEY_REMOVED):
        subscribe(store, heard, event)
    store.insert("key", 1)
    store.insert("key", 2)
    store.remove("key")
    assert [entry[1:3] for entry in heard] == [(KEY_ADDED, "key"), (KEY_REMOVED, "key")]


def test_a_subscriber_may_use_the_memory(store, heard):
    def pass_on(_name, value, _message):
        store.raise_event("Second", value + 1)
        store.unsubscribe("First", "Relay")

    store.subscribe("First", "Relay", pass_on)
    subscribe(store, heard, "Second")
    store.raise_event("First", 1)
    store.raise_event("First", 5)
    assert [entry[2] for entry in heard] == [2]


def test_no_event_is_lost_when_many_threads_raise(store, heard, patience):
    subscribe(store, heard)

    def raise_many(number):
        for n in range(200):
            store.raise_event("Happened", (number, n))

    threads = [threading.Thread(target=raise_many, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(patience)
    values = [entry[2] for entry in heard]
    assert sorted(values) == [(number, n) for number in range(4) for n in range(200)]
    for number in range(4):
        assert [n for of, n in values if of == number] == list(range(200))
