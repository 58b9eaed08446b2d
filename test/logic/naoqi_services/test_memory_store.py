"""Keys, events and their subscribers, without a network."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from set_clock import CalledClock

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.sizes import MemorySizes
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory import room as memory_room
from nao_sim_bridge.naoqi.memory.memory import ALMemory
from nao_sim_bridge.naoqi.memory.store import KEY_ADDED, KEY_REMOVED, MOST_WAITING, SIGNAL, MemoryStore


@pytest.fixture
def clock():
    return CalledClock(100.0)


@pytest.fixture
def store(clock):
    return MemoryStore(clock)


@pytest.fixture
def heard():
    """Module, event, value and message of every call of a subscriber."""
    return []


def subscribe(store, heard, name="Happened", module="Listener", message="", kind="Event"):
    store.subscribe(name, module, lambda *call: heard.append((module, *call)), message, kind)


def kilobytes(count):
    return b"x" * 1000 * count


@pytest.fixture
def small(clock, monkeypatch):
    monkeypatch.setattr(memory_room, "load_sizes", lambda: SimpleNamespace(memory=MemorySizes(100_000, 20)))
    return MemoryStore(clock)


def test_clients_fill_the_memory_up_to_a_bound_and_what_they_remove_makes_room(small):
    small.insert("A", kilobytes(50), by_client=True)
    for _ in range(40):
        small.raise_event("B", [kilobytes(10), 1.5], by_client=True)
    assert 3 <= len(small.history("B")) < 5, "the history of the key goes first"
    with pytest.raises(NaoqiError, match="this is .* more: 100000 at most"):
        small.insert("C", kilobytes(60), by_client=True)
    assert small.names() == ["A", "B"] and small.get("A") == kilobytes(50) and len(small.history("B")) >= 3
    for key in ("A", "B"):
        small.remove(key)
    for _ in range(100):  # none of it is left behind
        small.insert("C", kilobytes(60), by_client=True)
        small.raise_event("D", kilobytes(30), by_client=True)
        small.remove("D")
    assert len(small.history("C")) == 1


def test_what_the_robot_writes_is_free_and_takes_the_place_of_what_clients_wrote(small):
    small.raise_event("E", kilobytes(90), by_client=True)
    for _ in range(32):
        small.raise_event("E", kilobytes(90))
    small.insert("F", kilobytes(90), by_client=True)


@pytest.mark.parametrize(
    "make",
    [
        lambda store, n: store.insert(f"key {n}", n, by_client=True),
        lambda store, n: store.declare_event(f"event {n}", by_client=True),
        lambda store, n: store.subscribe("Happened", f"module {n}", print, by_client=True),
        lambda store, n: store.hold(f"signal {n}"),
    ],
    ids=range(4),
)
def test_keys_and_subscriptions_of_clients_have_a_bound(small, make):
    small.declare_event("Happened")
    for n in range(20):
        make(small, n)
        make(small, n)
    with pytest.raises(NaoqiError, match="clients have 20 keys and subscriptions: 20 at most"):
        make(small, 20)
    small.declare_event("of the robot")
    for n in range(20):
        small.forget_module(f"module {n}")
    for name in small.names():
        small.remove(name)
    small.release("signal 0", SIGNAL)
    make(small, 21)


@pytest.mark.parametrize(
    "write",
    [
        lambda memory, n: memory.insertData(f"key {n}", kilobytes(60)),
        lambda memory, n: memory.insertListData([[f"key {n}", kilobytes(60)]]),
        lambda memory, n: memory.raiseEvent(f"key {n}", kilobytes(60)),
        lambda memory, n: memory.raiseMicroEvent(f"key {n}", kilobytes(60)),
        lambda memory, n: memory.declareEvent(f"key {n}", "x" * 60_000),
        lambda memory, n: memory.setDescription("old", "x" * 60_000 * (n + 1)),
        lambda memory, n: memory.subscribeToEvent("old", f"module {n}", "x" * 60_000, "method"),
    ],
    ids=range(7),
)
def test_whatever_clients_write_counts(small, write):
    small.declare_event("old")
    memory = ALMemory(small, None)
    write(memory, 0)
    with pytest.raises(NaoqiError, match="100000 at most"):
        write(memory, 1)


def test_data_is_read_in_the_order_asked_for_with_its_time_and_removed_with_its_description(store, clock):
    for key in ("b/Sensor", "a/Sensor", "c/Actuator"):
        store.insert(key, key)
    assert store.get_many(["c/Actuator", "x", "a/Sensor"]) == ["c/Actuator", None, "a/Sensor"]
    assert store.names() == ["a/Sensor", "b/Sensor", "c/Actuator"]
    assert store.names(containing="Sensor") == ["a/Sensor", "b/Sensor"]
    clock.now = 105.5
    assert store.timestamp("a/Sensor") == ("a/Sensor", 100.0)
    store.insert("a/Sensor", 2)
    assert store.timestamp("a/Sensor") == (2, 105.5)
    store.set_description("a/Sensor", "a number")
    assert store.describe(["a/Sensor"]) == [["a/Sensor", "Data", "a number"]]
    with pytest.raises(UnknownName, match="unknown Event 'a/Sensor'"):
        store.remove("a/Sensor", "Event")
    store.remove("a/Sensor")
    store.insert("a/Sensor", 3)
    assert store.describe([])[0] == ["a/Sensor", "Data", ""]
    for call in (lambda: store.set_description("no", "x"), lambda: store.kind("no"), lambda: store.get("no")):
        with pytest.raises(UnknownName, match="unknown key 'no'"):
            call()


def test_an_event_without_a_value_cannot_be_read_yet_and_one_put_quietly_tells_nobody(store, heard, clock):
    store.declare_event("Happened", "Extractor")
    store.declare_event("Happened")
    store.declare_event("Other", "Another")
    assert store.events_of("Extractor") == ["Happened"] and store.get_many(["Happened", "nothing"]) == [None, None]
    with pytest.raises(UnknownName):
        store.get("Happened")
    subscribe(store, heard)
    store.put_quietly("Happened", 0)
    assert (store.get("Happened"), store.kind("Happened"), heard) == (0, "Event", [])
    store.raise_event("Happened", 2)
    assert heard == [("Listener", "Happened", 2, "")]


def test_a_live_key_is_computed_when_it_is_read_and_written_by_its_writer_only(store, clock, heard):
    values = iter(range(10))
    store.add_live({"sensor": lambda: next(values), "led": lambda: 0.0}, {"led": heard.append})
    assert [store.get("sensor"), store.get_many(["sensor"]), store.get("sensor")] == [0, [1], 2]
    assert store.kind("sensor") == "Data" and "sensor" in store.names()
    clock.now = 107.0
    assert store.timestamp("sensor") == (3, 107.0)
    with pytest.raises(NaoqiError, match="sensor is a sensor of the robot and cannot be written"):
        store.insert("sensor", 2.0)
    with pytest.raises(NaoqiError, match="cannot be removed"):
        store.remove("led")
    store.insert("led", 0.5)
    assert heard == [0.5]


def test_all_subscribers_hear_until_they_leave_also_when_one_fails(store, heard):
    store.subscribe("Happened", "Deaf", lambda *_: 1 / 0)
    subscribe(store, heard, message="old")
    subscribe(store, heard, message="new")
    store.raise_event("Happened", 1)
    assert heard == [("Listener", "Happened", 1, "new")] and store.subscribers("Happened") == ["Deaf", "Listener"]
    subscribe(store, heard, "Other")
    store.forget_module("Listener")
    assert store.subscribers("Happened") == ["Deaf"] and store.subscribers("Other") == []
    with pytest.raises(NaoqiError, match="'Listener' is not subscribed to 'Happened'; subscribed is Deaf"):
        store.unsubscribe("Happened", "Listener")
    store.unsubscribe("Happened", "Deaf")
    with pytest.raises(NaoqiError, match="subscribed is nobody"):
        store.unsubscribe("Happened", "Deaf")


def test_plain_data_notifies_nobody_until_it_becomes_an_event_and_a_removed_one_takes_its_listeners_along(store, heard):
    store.insert("key", 1)
    listener = heard.append
    for _ in range(2):  # one listener, however often it is named
        store.listen("key", listener)
    store.insert("key", 2)
    assert heard == []
    store.raise_event("key", 3)
    assert heard == [3]
    subscribe(store, heard, "key")
    store.remove("key", "Event")
    store.raise_event("key", 4)
    assert heard == [3] and store.subscribers("key") == []


def test_who_wants_to_know_is_told_of_keys_that_come_and_go_and_of_subscribers(store, heard):
    seen = []
    store.watch_subscribers("Watched", lambda name, modules: seen.append((name, modules)))
    subscribe(store, heard, "Watched")
    store.unsubscribe("Watched", "Listener")
    subscribe(store, heard, "Watched")
    store.forget_module("Listener")
    assert seen == [("Watched", ["Listener"]), ("Watched", [])] * 2
    for event in (KEY_ADDED, KEY_REMOVED):
        subscribe(store, heard, event)
    store.insert("key", 1)
    store.insert("key", 2)
    store.remove("key")
    assert [entry[1:3] for entry in heard] == [(KEY_ADDED, "key"), (KEY_REMOVED, "key")]


def test_who_waits_for_a_change_gets_the_next_value_and_who_gives_up_leaves_nothing(store):
    store.insert("Waited", 1)
    kept, left = store.next_change("Waited"), store.next_change("Waited")
    left.request_kill()
    store.insert("Waited", 2)
    assert kept.result(0) == 2 and left.killed
    assert store._changes == {}


@pytest.mark.parametrize(
    "ask",
    [
        lambda store: store.next_change("Sensor"),
        lambda store: subscribe(store, [], "Sensor", kind="MicroEvent"),
        lambda store: store.hold("Sensor"),
        lambda store: store.listen("Sensor", print),
        lambda store: store.declare_event("Sensor"),
        lambda store: store.raise_event("Sensor", 2.0),
    ],
)
def test_who_waits_for_what_is_only_ever_read_is_refused_and_it_stays_what_it_is(store, ask):
    store.add_live({"Sensor": lambda: 1.0})
    with pytest.raises(NaoqiError, match="Sensor is measured when it is read and never written; read it with getData"):
        ask(store)
    assert store.kind("Sensor") == "Data" and store.subscribers("Sensor") == []


def test_of_too_many_that_wait_for_changes_the_oldest_is_given_up(store):
    store.insert("Waited", 1)
    waiting = [store.next_change("Waited") for _ in range(MOST_WAITING + 1)]
    assert [change.finished for change in waiting] == [True] + [False] * MOST_WAITING
    with pytest.raises(NaoqiError, match=f"more than {MOST_WAITING} calls wait for changes"):
        waiting[0].result(0)
