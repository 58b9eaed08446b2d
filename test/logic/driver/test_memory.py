"""The robot's memory as topics: names, patterns, rules, types, and the pace of a key."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosgraph.names import is_legal_name

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.memory_functions import parse_assignment, parse_pairs
from nao_library_modules.driver.memory.memory_rules import (
    MemoryRule,
    MemoryRules,
    converted,
    is_pattern,
    kind_of,
    matches,
    matching,
    parse_value,
    read_rules,
    topic_of,
    topics_of,
    type_of,
)
from nao_library_modules.driver.memory.memory_watch import WatchedKey
from naoqi.errors import NaoError

KNOWN = ["Battery/Charge", "Battery/Current", "Head/Front", "Head/Rear"]


def test_patterns_match_keys():
    key, index = "Device/SubDeviceList/US/Left/Sensor/Value", "*/US/*/Sensor/Value?"
    for found in ("Device/*/US/*", "*Value", key, "Device/SubDeviceList/??/Left*"):
        assert matches(key, found)
    for other in (key.lower(), index, "US/*"):
        assert not matches(key, other)
    assert matches(f"{key}1", index) and not matches("ab", "a[b]")
    assert matching(["b", "a"], "") == ["a", "b"] and matching(["b", "a"], "b*") == ["b"]
    assert not is_pattern("a[b]") and is_pattern("a?")


def test_topics_look_like_their_keys():
    topics = {"Face/Led/0Deg/Value": "Face/Led/0Deg/Value", "my-key.2 of:all": "my_key_2_of_all", "größe": "gr__e"}
    topics.update({"/leading//twice/": "leading/twice", "3rd": "key_3rd", "_x": "key__x", "/": "key__"})
    assert {key: topic_of(key) for key in topics} == topics


@settings(max_examples=50)
@given(st.lists(st.text("aB1_-./ é", min_size=1, max_size=6), max_size=6, unique=True))
def test_topics_are_legal_and_no_two_keys_have_the_same(keys):
    topics = topics_of(keys, ["c"])
    assert set(topics) == set(keys) and len({*topics.values(), "c"}) == len(keys) + 1
    assert all(is_legal_name(topic) for topic in topics.values())
    assert topics_of(["a-b", "a_b", "c"], ["c"]) == {"a-b": "a_b", "a_b": "a_b_2", "c": "c_2"}


def rules_of(*rules):
    rules_ = MemoryRules()
    for rule in rules:
        rules_.add(rule)
    return rules_


def test_the_last_rule_for_a_key_counts():
    wanted = rules_of(MemoryRule("*", 1.0), MemoryRule("Head/*", 5.0), MemoryRule("Head/Rear", on=False)).wanted_of(
        KNOWN
    )
    rates = {key: rule.rate for key, rule in wanted.items()}
    assert rates == {"Battery/Charge": 1.0, "Battery/Current": 1.0, "Head/Front": 5.0}
    by_name = rules_of(MemoryRule("New/Key"), MemoryRule("New/*"))
    assert not rules_of(
        MemoryRule("Head/Front"), MemoryRule("Battery/*"), MemoryRule("*", on=False)
    )  # nothing is left behind
    assert list(by_name.wanted_of(KNOWN)) == ["New/Key"] and by_name.has_patterns  # before it is there


def test_rules_are_read_from_a_parameter_and_what_is_wrong_is_told():
    entries = ["FrontTactilTouched", {"key": "Battery/*", "rate": 2, "type": "float"}]
    assert read_rules(entries, "~keys") == [MemoryRule("FrontTactilTouched"), MemoryRule("Battery/*", 2.0, "float")]
    assert read_rules("a, b c", "~keys") == [MemoryRule("a"), MemoryRule("b"), MemoryRule("c")]
    for entries, words in ((7, "~keys is 7"), (["b", {"key": "a", "hz": 2}], r"~keys\[1\]")):
        with pytest.raises(NaoError, match=words):
            read_rules(entries, "~keys")
    wrong = {
        MemoryRule(" "): "pattern: it is empty",
        MemoryRule("a", -1.0): "0.001..100 Hz",
        MemoryRule("a", kind="double"): "one of bool",
    }
    for rule, words in wrong.items():
        with pytest.raises(BadGoal, match=words):
            rule.check()


def test_types_of_values_and_kinds_of_messages():
    for value, type_, kind in (
        (3, "int", "int"),
        (2**31, "int", "string"),
        (0.5, "float", "float"),
        ([1, 2**40], "int[]", "string"),
        ([1, 2.5], "float[]", "float[]"),
        ([True, 1.0], "list", "string"),
        (None, "null", "string"),
    ):
        assert (type_of(value), kind_of(value)) == (type_, kind)


def test_values_widen_and_lose_nothing_and_what_is_no_json_is_text():
    for value, kind, message in (
        (True, "float", 1.0),
        (1.5, "int", None),
        (2**31, "int", None),
        ("a", "float", None),
        ([1, "b"], "string", '[1, "b"]'),
        ([1, 2], "float[]", [1.0, 2.0]),
        ([1, "b"], "int[]", None),
    ):
        result = converted(value, kind)
        assert result == message and type(result) is type(message)
    values = {"[1, 2]": [1, 2], "hello there": "hello there", '"3"': "3"}
    assert {text: parse_value(text) for text in values} == values
    for text in ("[" * 100_000, "[" * 100_000 + "]" * 100_000, "1" * 5000):  # no value of a robot
        assert parse_value(text) == text and parse_assignment(f"key={text}") == ("key", text)
        with pytest.raises(BadGoal, match="JSON"):
            parse_pairs(text)


@pytest.fixture
def opened():
    return []


@pytest.fixture
def watched(opened):
    def make_topic(name, kind, tell):
        """Publishes to a list; `tell` says whether somebody listens."""
        topic = SimpleNamespace(kind=kind, tell=tell, messages=[], open=True)
        topic.publish, topic.close = topic.messages.append, lambda: setattr(topic, "open", False)
        opened.append(topic)
        return topic

    def make(rate=0.0, kind="", event=False):
        key = WatchedKey("Some/Key", "topic", MemoryRule("Some/Key", rate, kind), make_topic)
        key.is_event = event
        return key

    return make


def test_data_is_due_at_even_times_that_all_keys_of_a_rate_share(watched):
    key, other = watched(5.0), watched(5.0)
    assert key.due_in(10.07) == 0.0 and other.due_in(10.13) == 0.0
    key.was_read(10.07)
    other.was_read(10.13)
    assert (10.07 + key.due_in(10.07), 10.13 + other.due_in(10.13)) == pytest.approx((10.2, 10.2))
    assert key.due_in(3.0) == 0.0  # a clock that is set back delays nothing


def test_of_events_that_come_too_fast_the_newest_follows(watched):
    key = watched(2.0, event=True)
    assert key.hold("first", 10.0) == 0.0
    assert key.hold("second", 10.1) == pytest.approx(0.4)
    assert key.hold("third", 10.2) == pytest.approx(0.3)
    assert key.release(10.2) == (pytest.approx(0.3), None)
    assert key.release(10.5) == (0.0, "third")
    assert key.release(10.6) == (None, None)
    assert key.hold("fourth", 10.6) == pytest.approx(0.4)
    unlimited = watched(event=True)
    assert [unlimited.hold(i, 10.0) for i in range(3)] == [0.0] * 3


def test_another_type_needs_another_topic_and_old_listeners_mean_nothing(watched, opened):
    key = watched()
    key.open(3, lambda: None)
    first = opened[0]
    first.tell(True)
    assert key.wanted and not key.deliver(0.5)
    key.open(0.5, lambda: None)
    assert [topic.kind for topic in opened] == ["int", "float"] and not first.open
    opened[1].tell(True)
    first.tell(False)
    assert key.wanted
    typed = watched(kind="float", event=True)
    typed.open(None, lambda: None)
    assert typed.deliver("text") and typed.deliver(1) and opened[-1].messages == [1.0]
