"""Patterns of keys, and topics named after keys."""

from __future__ import annotations

import pytest
from rosgraph.names import is_legal_name

from nao_library_modules.driver.memory_names import is_pattern, matches, matching, topic_of, topics_of


@pytest.mark.parametrize(
    "key, pattern, same",
    [
        ("FrontTactilTouched", "FrontTactilTouched", True),
        ("FrontTactilTouched", "*TactilTouched", True),
        ("FrontTactilTouched", "fronttactiltouched", False),
        ("Device/SubDeviceList/Battery/Charge/Sensor/Value", "Device/*/Battery/*", True),
        ("Device/SubDeviceList/US/Left/Sensor/Value1", "*/US/*/Sensor/Value?", True),
        ("Device/SubDeviceList/US/Left/Sensor/Value", "*/US/*/Sensor/Value?", False),
        ("a[b]", "a[b]", True),
        ("ab", "a[b]", False),
    ],
)
def test_patterns_match_keys(key, pattern, same):
    assert matches(key, pattern) is same


def test_an_empty_pattern_lists_all():
    assert matching(["b", "a"], "") == ["a", "b"]
    assert matching(["b", "a"], "b*") == ["b"]
    assert not is_pattern("a[b]") and is_pattern("a?")


@pytest.mark.parametrize(
    "key, topic",
    [
        ("Face/Led/Blue/Left/0Deg/Actuator/Value", "Face/Led/Blue/Left/0Deg/Actuator/Value"),
        ("my-key.2 of:all", "my_key_2_of_all"),
        ("/leading//twice/", "leading/twice"),
        ("3rd", "key_3rd"),
        ("_x", "key__x"),
        ("größe", "gr__e"),
        ("éa", "key__a"),
        ("/", "key__"),
    ],
)
def test_topics_look_like_their_keys_and_are_legal(key, topic):
    assert topic_of(key) == topic
    assert is_legal_name(topic)


def test_no_two_keys_have_one_topic():
    topics = topics_of(["a-b", "a_b", "a.b", "c"], ["c"])
    assert len({*topics.values(), "c"}) == 5
    assert topics["a-b"] == "a_b" and topics["c"] == "c_2"
