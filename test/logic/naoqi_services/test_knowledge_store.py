"""Triples, data about them, and dates: what ALKnowledge knows."""

from __future__ import annotations

import json
from datetime import datetime, timedelta, timezone

import pytest
from set_clock import CalledClock

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.system.knowledge_store import ANY, LEARNING, TripleStore

PIZZA = ("bob", "eat", "pizza")
START = datetime(2030, 1, 1, 12, tzinfo=timezone.utc)


@pytest.fixture
def clock():
    return CalledClock(START)


@pytest.fixture
def store(clock):
    return TripleStore(clock)


def test_what_was_added_is_found_by_patterns_in_its_domain_alone(store):
    for triple in (("sky", "colour", "blue"), ("smurf", "colour", "blue"), ("smurf", "size", "small")):
        store.add("things", triple)
    assert store.find("things", (ANY, "colour", "blue")) == [("sky", "colour", "blue"), ("smurf", "colour", "blue")]
    assert store.find("things", ("smurf", ANY, ANY)) == [("smurf", "colour", "blue"), ("smurf", "size", "small")]
    assert store.find("other", (ANY, ANY, ANY)) == []
    store.replace("things", ("smurf", "colour", "white"))
    store.remove("things", (ANY, "size", ANY))
    assert store.find("things", ("smurf", ANY, ANY)) == [("smurf", "colour", "white")]


def test_how_often_a_triple_was_added_outlasts_it(store):
    for _ in range(3):
        store.add(LEARNING, PIZZA)
        store.remove(LEARNING, PIZZA)
    assert store.find(LEARNING, PIZZA) == []
    assert [entry[1:] for entry in store.find_data(LEARNING, (ANY, ANY, "pizza"), ANY, ANY)] == [
        ("addedDate", "2030-01-01T12:00:00Z"),
        ("addingCount", "3"),
    ]


def test_data_are_triples_of_an_id_that_wildcards_do_not_find(store):
    store.add(LEARNING, PIZZA)
    key = store.id_of(LEARNING, PIZZA)
    store.add(LEARNING, (key, "with", "eve"))
    assert store.find_data(LEARNING, PIZZA, "with", ANY) == [(PIZZA, "with", "eve")]
    assert store.find(LEARNING, (key, "with", ANY)) == [(key, "with", "eve")]
    assert store.find(LEARNING, (ANY, ANY, ANY)) == [PIZZA]
    assert store.of_id(LEARNING, key) == PIZZA and store.of_id(LEARNING, "10") is None
    store.remove_data(LEARNING, (ANY, ANY, ANY), "with", ANY)
    assert store.find_data(LEARNING, PIZZA, "with", ANY) == []


def test_a_triple_goes_and_another_comes_at_their_dates(store, clock):
    store.add(LEARNING, PIZZA)
    store.add_data(LEARNING, PIZZA, "expirationDate", "2030-01-01T12:00:10Z")
    salad = ("bob", "eat", "salad")
    store.add_data(LEARNING, salad, "happeningDate", store.date("date", "PT1M", durations=True))
    assert store.settle() is False
    clock.now = START + timedelta(seconds=10)
    assert store.settle() is True and store.find(LEARNING, (ANY, ANY, ANY)) == []
    clock.now = START + timedelta(seconds=60)
    assert store.settle() is True and store.find(LEARNING, (ANY, ANY, ANY)) == [salad]
    assert store.find_data(LEARNING, (ANY, ANY, ANY), "expirationDate", ANY) == []
    store.add(LEARNING, PIZZA)  # its date is over
    assert store.settle() is False and store.find(LEARNING, PIZZA) == [PIZZA]


def test_a_count_that_is_none_begins_anew(store):
    for text in ("\N{SUPERSCRIPT TWO}", 5000 * "9"):
        store.add_data(LEARNING, PIZZA, "addingCount", text)
        store.add(LEARNING, PIZZA)
        assert store.find_data(LEARNING, PIZZA, "addingCount", ANY) == [(PIZZA, "addingCount", "1")]
        store.clear(LEARNING)


def test_a_triple_comes_at_its_date_also_when_there_are_too_many_by_then(store, clock):
    store.add_data(LEARNING, PIZZA, "happeningDate", "2030-01-01T12:00:10Z")
    for number in range(load_sizes().kept.triples - 1):
        store.add("numbers", (str(number), "is", "a number"))
    clock.now = START + timedelta(seconds=10)
    assert store.settle() is True and store.find(LEARNING, PIZZA) == [PIZZA]
    assert store.find_data(LEARNING, PIZZA, "addingCount", ANY) == [(PIZZA, "addingCount", "1")]
    with pytest.raises(NaoqiError, match="known at most"):
        store.add("numbers", ("pi", "is", "a number"))


@pytest.mark.parametrize("text, durations", [("tomorrow", True), ("2030-1-1", False), ("P", True), ("PT1M", False)])
def test_what_is_no_date_is_refused(store, text, durations):
    with pytest.raises(BadValue, match="allowed is a date such as 2030-12-31T23:59:59Z"):
        store.date("date", text, durations)


def test_a_duration_that_nobody_can_read_is_refused(store):
    with pytest.raises(BadValue, match="or a duration such as P1DT2H30M15S"):
        store.date("date", f"P{5000 * '9'}D", durations=True)


def test_all_of_it_comes_back_from_a_file(store, clock):
    store.add(LEARNING, PIZZA)
    store.add_data(LEARNING, PIZZA, "expirationDate", "2030-01-01T12:00:10Z")
    store.add("things", ("sky", "colour", "blue"))
    again = TripleStore(clock)
    again.restore(json.loads(json.dumps(store.content())))
    assert again.content() == store.content()
    clock.now = START + timedelta(hours=1)
    assert again.settle() and again.find(LEARNING, PIZZA) == []


def test_wildcards_data_of_other_domains_and_too_much_are_refused(store):
    with pytest.raises(BadValue, match="object is '\\*', allowed is something else"):
        store.add("things", ("sky", "colour", ANY))
    with pytest.raises(NaoqiError, match="only com.aldebaran.learning has metadata"):
        store.add_data("things", PIZZA, "with", "eve")
    for number in range(load_sizes().kept.triples):
        store.add("numbers", (str(number), "is", "a number"))
    with pytest.raises(NaoqiError, match="10000 triples with metadata are known at most"):
        store.add("things", PIZZA)
    store.add("numbers", ("0", "is", "a number"))  # it is there already
    store.remove("numbers", ("0", ANY, ANY))
    store.add("things", PIZZA)
