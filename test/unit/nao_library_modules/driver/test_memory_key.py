"""The pace of one key, and its topic."""

from __future__ import annotations

import fake_memory
import pytest

from nao_library_modules.driver.memory_key import WatchedKey
from nao_library_modules.driver.memory_rules import Rule


@pytest.fixture
def topics():
    return fake_memory.Topics()


def watched(topics, rate=0.0, kind="", event=False):
    key = WatchedKey("Some/Key", "topic", Rule("Some/Key", rate, kind), topics.make)
    key.is_event = event
    return key


def test_data_is_due_at_even_times_that_all_keys_of_a_rate_share(topics):
    key, other = watched(topics, 5.0), watched(topics, 5.0)
    assert key.wait(10.07) == 0.0 and other.wait(10.13) == 0.0
    key.was_read(10.07)
    other.was_read(10.13)
    assert 10.07 + key.wait(10.07) == pytest.approx(10.2)
    assert 10.13 + other.wait(10.13) == pytest.approx(10.2)


def test_a_clock_that_is_set_back_delays_nothing(topics):
    key = watched(topics, 5.0)
    key.wait(500.0)
    key.was_read(500.0)
    assert key.wait(3.0) == 0.0


def test_of_events_that_come_too_fast_the_newest_follows(topics):
    key = watched(topics, 2.0, event=True)
    assert key.hold("first", 10.0) == 0.0
    assert key.hold("second", 10.1) == pytest.approx(0.4)
    assert key.hold("third", 10.2) == pytest.approx(0.3)
    assert key.release(10.2) == (pytest.approx(0.3), None)
    assert key.release(10.5) == (0.0, "third")
    assert key.release(10.6) == (None, None)
    assert key.hold("fourth", 10.6) == pytest.approx(0.4)


def test_without_a_rate_no_event_is_held(topics):
    key = watched(topics, event=True)
    assert [key.hold(i, 10.0) for i in range(3)] == [0.0] * 3


def test_the_first_value_tells_the_type(topics):
    key = watched(topics)
    key.open(None, lambda: None)
    assert not key.kind and not key.deliver(1.5)
    key.open(1.5, lambda: None)
    assert key.kind == "float" and key.deliver(2) and key.deliver(None)
    assert topics["topic"].messages == [2.0]


def test_another_type_needs_another_topic_and_old_listeners_mean_nothing(topics):
    key = watched(topics)
    key.open(3, lambda: None)
    first = topics["topic"]
    first.tell(True)
    assert key.wanted and not key.deliver(0.5)
    key.open(0.5, lambda: None)
    assert topics.opened == [("topic", "int"), ("topic", "float")] and not first.open
    topics["topic"].tell(True)
    first.tell(False)
    assert key.wanted


def test_a_type_that_was_asked_for_stays(topics):
    key = watched(topics, kind="float", event=True)
    key.open(None, lambda: None)
    assert key.deliver("text") and key.deliver(1) and topics["topic"].messages == [1.0]


def test_an_event_without_a_value_is_told_in_a_text(topics):
    key = watched(topics, event=True, kind="string")
    key.open(None, lambda: None)
    assert key.deliver(None) and topics["topic"].messages == ["null"]
