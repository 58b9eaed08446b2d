"""Which keys are watched: the last word counts."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.memory_rules import Rule, Rules, read_rules
from nao_library_modules.errors import BadGoal
from naoqi.errors import NaoError

KNOWN = ["Battery/Charge", "Battery/Current", "Head/Front", "Head/Rear"]


def rules_of(*rules):
    rules_ = Rules()
    for rule in rules:
        rules_.add(rule)
    return rules_


def test_the_last_rule_for_a_key_counts():
    rules = rules_of(Rule("*", 1.0), Rule("Head/*", 5.0), Rule("Head/Rear", on=False))
    wanted = rules.wanted_of(KNOWN)
    assert {key: rule.rate for key, rule in wanted.items()} == {
        "Battery/Charge": 1.0,
        "Battery/Current": 1.0,
        "Head/Front": 5.0,
    }


def test_a_key_by_name_is_wanted_before_it_is_there():
    rules = rules_of(Rule("New/Key"), Rule("New/*"))
    assert list(rules.wanted_of(KNOWN)) == ["New/Key"]
    assert rules.has_patterns


def test_what_is_ended_leaves_nothing_behind():
    rules = rules_of(Rule("Head/Front"), Rule("Battery/*"), Rule("*", on=False))
    assert not rules and rules.wanted_of(KNOWN) == {}
    for _ in range(50):
        rules.add(Rule("Head/*"))
        rules.add(Rule("Head/*", on=False))
    assert not rules


def test_a_copy_does_not_change():
    rules = rules_of(Rule("Head/*"))
    former = rules.copy()
    rules.add(Rule("Battery/*"))
    assert former.rule_for("Battery/Charge") is None and rules.rule_for("Battery/Charge") is not None


@pytest.mark.parametrize(
    "rule, words",
    [
        (Rule(" "), "pattern: it is empty"),
        (Rule("a", -1.0), "0 to 100 Hz"),
        (Rule("a", float("nan")), "0 to 100 Hz"),
        (Rule("a", kind="double"), "one of bool, int"),
    ],
)
def test_what_makes_no_sense_is_told(rule, words):
    with pytest.raises(BadGoal, match=words):
        rule.check()


def test_rules_are_read_from_a_parameter():
    entries = ["FrontTactilTouched", {"key": "Battery/*", "rate": 2, "type": "float"}]
    assert read_rules(entries, "~keys") == [Rule("FrontTactilTouched"), Rule("Battery/*", 2.0, "float")]
    assert read_rules("a, b c", "~keys") == [Rule("a"), Rule("b"), Rule("c")]
    assert read_rules("", "~keys") == []


@pytest.mark.parametrize(
    "entries, words",
    [
        (7, r"~keys is 7"),
        (["a", 7], r"~keys\[1\] is 7"),
        ([{"rate": 2}], r"~keys\[0\]"),
        ([{"key": "a", "hz": 2}], r"~keys\[0\]"),
        ([{"key": "a", "rate": "fast"}], "rate 'fast'"),
        ([{"key": "a", "rate": 1000}], r"~keys\[0\].*0 to 100 Hz"),
    ],
)
def test_a_wrong_parameter_is_told(entries, words):
    with pytest.raises(NaoError, match=words):
        read_rules(entries, "~keys")
