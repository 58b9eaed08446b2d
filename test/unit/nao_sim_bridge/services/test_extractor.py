"""What all extractors have: subscribers with periods and precisions, and work between the first and the last."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.extractor import Extractor, Subscription
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.sim.errors import BadValue, SimulationError
from nao_sim_bridge.sim.tasks import TaskIds


@pytest.fixture
def memory():
    return MemoryStore(lambda: 0.0)


@pytest.fixture
def done():
    """What the extractor was told to do."""
    return []


@pytest.fixture
def extractor(memory, done):
    start, stop = (lambda word=word: done.append(word) for word in ("start", "stop"))
    return Extractor("ALTest", memory, start, stop, ["Heard", "Seen"], ["Key"], Subscription(170, 0.25))


def test_it_works_from_the_first_subscriber_to_the_last(extractor, done):
    extractor.subscribe("first")
    extractor.subscribe("second", 100, 0.5)
    assert done == ["start"]
    extractor.unsubscribe("first")
    assert done == ["start"]
    extractor.unsubscribe("second")
    assert done == ["start", "stop"]
    extractor.subscribe("third")
    assert done == ["start", "stop", "start"]


def test_every_change_of_subscriptions_is_told(memory):
    told = []
    extractor = Extractor(
        "ALTest", memory, lambda: told.append("start"), lambda: told.append("stop"), changed=told.append
    )
    one, two = Subscription(100, 0.5), Subscription(200, 0.25)
    extractor.subscribe("one", 100, 0.5)
    extractor.subscribe("two", 200, 0.25)
    extractor.updatePeriod("one", 50)
    extractor.updatePrecision("one", 1.0)
    extractor.unsubscribe("one")
    extractor.unsubscribe("two")
    assert told == [
        "start",
        {"one": one},
        {"one": one, "two": two},
        {"one": Subscription(50, 0.5), "two": two},
        {"one": Subscription(50, 1.0), "two": two},
        {"two": two},
        {},
        "stop",
    ]


def test_who_subscribes_twice_is_one_subscriber(extractor, done):
    extractor.subscribe("one", 100, 0.5)
    extractor.subscribe("one", 200, 0.75)
    assert extractor.getSubscribersInfo() == [["one", 200, 0.75]]
    extractor.unsubscribe("one")
    assert done == ["start", "stop"]


def test_the_shortest_period_and_the_highest_precision_count(extractor):
    assert (extractor.getCurrentPeriod(), extractor.getCurrentPrecision()) == (170, 0.25)
    extractor.subscribe("slow", 500, 0.1)
    extractor.subscribe("quick", 50, 0.0)
    assert (extractor.getCurrentPeriod(), extractor.getCurrentPrecision()) == (50, 0.1)
    extractor.updatePeriod("quick", 600)
    extractor.updatePrecision("quick", 1.0)
    assert (extractor.getCurrentPeriod(), extractor.getCurrentPrecision()) == (500, 1.0)
    assert (extractor.getMyPeriod("quick"), extractor.getMyPrecision("quick")) == (600, 1.0)
    assert extractor.getSubscribersInfo() == [["slow", 500, 0.1], ["quick", 600, 1.0]]


def test_who_asks_for_nothing_gets_what_the_module_does(extractor):
    extractor.subscribe("one")
    assert extractor.getSubscribersInfo() == [["one", 170, 0.25]]


def test_events_are_declared(extractor, memory):
    assert memory.events_of("ALTest") == ["Heard", "Seen"]
    assert extractor.getEventList() == ["Heard", "Seen"]
    assert extractor.getMemoryKeyList() == ["Key"]
    assert extractor.getOutputNames() == ["Heard", "Seen", "Key"]


@pytest.mark.parametrize(
    "method, more",
    [
        ("unsubscribe", ()),
        ("getMyPeriod", ()),
        ("getMyPrecision", ()),
        ("updatePeriod", (1,)),
        ("updatePrecision", (1.0,)),
    ],
)
def test_a_stranger_is_told_who_is_subscribed(extractor, method, more):
    with pytest.raises(RuntimeError, match="'stranger' is not subscribed; subscribed is nobody"):
        getattr(extractor, method)("stranger", *more)
    extractor.subscribe("friend")
    with pytest.raises(RuntimeError, match="'stranger' is not subscribed; subscribed is 'friend'"):
        getattr(extractor, method)("stranger", *more)


@pytest.mark.parametrize("period, precision", [(-1, 0.5), (100, -0.1), (100, 1.1), (100, float("nan"))])
def test_wrong_periods_and_precisions_are_refused(extractor, done, period, precision):
    with pytest.raises(BadValue):
        extractor.subscribe("one", period, precision)
    assert done == [] and extractor.getSubscribersInfo() == []


def test_nobody_is_nameless(extractor):
    with pytest.raises(BadValue, match="name is ''"):
        extractor.subscribe("")


def test_who_cannot_be_served_is_not_subscribed(memory):
    def start():
        raise SimulationError("no ears")

    extractor = Extractor("ALTest", memory, start, lambda: None)
    with pytest.raises(SimulationError, match="no ears"):
        extractor.subscribe("one")
    assert extractor.getSubscribersInfo() == []


def test_all_who_subscribe_before_the_start_is_done_wait_for_it(memory):
    ids, tasks = TaskIds(), []

    def start():
        tasks.append(ids.make("start"))
        return tasks[-1]

    extractor = Extractor("ALTest", memory, start, lambda: None)
    assert [extractor.subscribe(name) for name in ("one", "two")] == [tasks[0], tasks[0]]
    tasks[0].finish()
    assert extractor.subscribe("late") is None
    for name in ("one", "two", "late"):
        extractor.unsubscribe(name)
    assert extractor.subscribe("again") is tasks[1] is not tasks[0]


def test_a_start_that_fails_later_is_told_to_those_who_wait_and_they_are_subscribed(memory):
    start = TaskIds().make("start")
    extractor = Extractor("ALTest", memory, lambda: start, lambda: None)
    waiting = [extractor.subscribe(name) for name in ("one", "two")]
    start.finish(error=SimulationError("no ears"))
    for task in waiting:
        with pytest.raises(SimulationError, match="no ears"):
            task.result(0.0)
    assert extractor.subscribe("late") is None
    assert [name for name, _, _ in extractor.getSubscribersInfo()] == ["one", "two", "late"]
