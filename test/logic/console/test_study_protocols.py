"""Protocols: what is read, what is refused and where, which conditions a participant meets, which step is next."""

from __future__ import annotations

from collections import Counter

import pytest
from played_study import PROTOCOL

from nao_library_modules.base.paths import config_file
from nao_library_modules.console.files.yaml_file import ConsoleFileError
from nao_library_modules.console.study.conditions import StudyCondition
from nao_library_modules.console.study.course import following, step_at
from nao_library_modules.console.study.order import balanced_rows, order_of
from nao_library_modules.console.study.reader import read_protocol, read_protocol_file

SHIPPED = sorted(config_file("console/protocols").glob("*.yaml"))
TOUCH = "- {wait: touch, sensors: [head], label: head}"
HEAD = "name: x\nphases:\n  - steps:\n"


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_protocols_that_come_along_can_be_run(path):
    assert read_protocol_file(path).name == path.stem


@pytest.mark.parametrize(
    "step, line, told",
    [
        ("- sai: hello", 4, "did you mean 'say'?"),
        ("- {wait: touch, sensors: [hed]}", 4, "did you mean 'head'?"),
        ("- {wait: word}", 4, "needs words"),
        ("- {wait: -1}", 4, "0..3600"),
        ("- {wizard: Well, choices: []}", 4, "a list of words"),
        ("- {wizard: 'Is {partcipant} there?'}", 4, "did you mean 'participant'?"),
        ("- wait: 1\n    - when: answer == yes\n      then: [{wait: 1}]", 5, "there is no value 'answer'"),
        ("- wait: 1\n    - {wait: touch, label: trial}", 5, "is no label"),
        ("- {repeat: 0, steps: [{wait: 1}]}", 4, "1..1000"),
        ("- wait: [", 5, "no YAML"),
        (f"{TOUCH}\n    - {{when: head == frnt, then: [{{wait: 1}}]}}", 5, "head is never 'frnt'"),
        (f"{TOUCH}\n    - choose: head\n      cases:\n        chest: [{{wait: 1}}]", 7, "head is never 'chest'"),
        (
            "- {wizard: Well, choices: [good], label: mood}\n    - {when: mood != god, then: [{wait: 1}]}",
            5,
            "mean 'good'",
        ),
        ("- {say: Hi, label: hi}\n    - {when: hi == yes, then: [{wait: 1}]}", 5, "there are done, none"),
    ],
)
def test_a_mistake_is_told_with_its_line(step, line, told):
    with pytest.raises(ConsoleFileError) as error:
        read_protocol(f"{HEAD}    {step}\n", "x.yaml")
    assert [(line, True)] == [(each.line, told in each.text) for each in error.value.problems]


def test_answers_of_several_sensors_at_once_can_be_asked_for():
    step = "{choose: head, cases: {'rear head, front head': [{wait: 1}], none: [{wait: 1}]}}"
    assert read_protocol(f"{HEAD}    {TOUCH}\n    - {step}\n", "x").name == "x"


@pytest.mark.parametrize("count", [2, 3, 4, 5, 8])
def test_each_condition_is_at_each_place_and_behind_each_other_one_equally_often(count):
    rows = balanced_rows(count)
    for place in range(count):
        assert len({*Counter(row[place] for row in rows).values()}) == 1
    behind = Counter(pair for row in rows for pair in zip(row, row[1:]))
    assert len(behind) == count * (count - 1)
    assert len({*behind.values()}) == 1


def test_four_participants_meet_the_four_conditions_in_orders_of_their_own():
    protocol = read_protocol(PROTOCOL, "two.yaml")
    orders = [[tuple(each.values()) for each in order_of(protocol, number)] for number in range(1, 5)]
    assert {len({*order}) for order in orders} == {4}
    assert len({tuple(order) for order in orders}) == 4
    assert order_of(protocol, 5) == order_of(protocol, 1)


def test_a_factor_between_participants_has_one_level_for_each_in_turn():
    protocol = read_protocol(PROTOCOL.replace("voice: {", "voice: {assigned: between, "), "two.yaml")
    levels = [{each["voice"] for each in order_of(protocol, number)} for number in range(1, 5)]
    assert levels == [{"low"}, {"high"}, {"low"}, {"high"}]
    assert len(order_of(protocol, 1)) == 2


def test_a_random_order_is_that_of_its_seed():
    one, other = (read_protocol(f"{PROTOCOL}order: random\nseed: {seed}\n", "x") for seed in (1, 2))
    assert [order_of(one, n) for n in range(9)] == [order_of(one, n) for n in range(9)]
    assert [order_of(one, n) for n in range(9)] != [order_of(other, n) for n in range(9)]


def course(protocol, **values):
    path, steps = "", []
    while True:
        path = following(protocol, path, {"trial": 1, "trials": 4, **values})
        if not path:
            return steps
        steps.append(path)


@pytest.mark.parametrize(
    "values, steps",
    [
        ({"fast": "yes"}, ["1.1", "2.1", "2.2", "2.4"]),
        ({"fast": "no"}, ["1.1", "2.1", "2.2", "2.3.b1.1", "2.4"]),
        ({"fast": "no", "trial": 2}, ["2.1", "2.2", "2.3.b1.1", "2.4"]),
    ],
)
def test_branches_and_phases_follow_the_values(values, steps):
    assert course(read_protocol(PROTOCOL, "two.yaml"), **values) == steps


def test_rounds_know_their_number():
    text = f"{HEAD}    - repeat: 3\n      as: i\n      steps:\n        - when: i != 2\n          then: [{{wait: 1}}]\n"
    protocol = read_protocol(text, "x")
    assert course(protocol) == ["1.1.r1.1.b1.1", "1.1.r3.1.b1.1"]
    assert step_at(protocol, "1.1.r3.1.b1.1").seconds == 1


@pytest.mark.parametrize(
    "text, values, holds",
    [
        ("answer == yes", {"answer": "yes"}, True),
        ("answer != yes", {"answer": "yes"}, False),
        ("touches + 1 >= 3", {"touches": 2}, True),
        ("head_seconds > 2", {"head_seconds": None}, False),
        ("head_seconds < 2.5", {"head_seconds": 2.0}, True),
    ],
)
def test_conditions_compare_values_of_the_trial(text, values, holds):
    assert StudyCondition.read(text).holds(values) is holds
