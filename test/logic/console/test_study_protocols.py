"""Protocols: what is read, what is refused and where, which conditions a participant meets, which step is next."""

from __future__ import annotations

import time
from collections import Counter

import pytest
from played_study import PROTOCOL

from nao_library_modules.core.files import config_file
from nao_library_modules.studies.commands import ConsoleFileError
from nao_library_modules.studies.protocol import StudyCondition
from nao_library_modules.studies.protocol_reader import read_protocol, read_protocol_file
from nao_library_modules.studies.schedule import balanced_rows, following, order_of, rounds_of, step_at

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
        ("- {call: NaoLights.on, lights: [Eyes]}", 4, "fields of the function stand in with: {lights: ...}"),
        ("- {run: hello, text: Hi}", 4, "parameters of the behaviour stand in with: {text: ...}"),
        ("- {say: Hi, speed: 80}", 4, "call: nao_audio_out.say takes further fields, in with: {str_param: TEXT, speed"),
        ("- {wait: touch, sensors: [hed]}", 4, "did you mean 'head'?"),
        ("- {wait: word}", 4, "needs words"),
        ("- {wait: -1}", 4, "0..3600"),
        ("- {wizard: Well, choices: []}", 4, "a list of words"),
        ("- {wizard: 'Is {partcipant} there?'}", 4, "did you mean 'participant'?"),
        ("- wait: 1\n    - when: answer == yes\n      then: [{wait: 1}]", 5, "there is no value 'answer'"),
        ("- wait: 1\n    - {wait: touch, label: trial}", 5, "is no label"),
        ("- {repeat: 0, steps: [{wait: 1}]}", 4, "1..1000"),
        ("- wait: [", 5, "no YAML"),
        ("- {wait: tuch}", 4, "did you mean 'touch'?"),
        ("- {wait: touch, since: befor}", 4, "now or the label of an earlier step"),
        (f"- {{wait: touch, since: head}}\n    {TOUCH}", 4, "head has not been done here: it is the step in line 5"),
        (f"{TOUCH}\n    {TOUCH}", 5, "'head' is the label of the step in line 4, too"),
        ("- wait: word\n      words: yes, no", 5, "words are a list: [yes, no]"),
        ("- {wait: face, names: [ann, bob]}", 4, "looks for one of them"),
        ("- {while: {do: [{run: nod}], until: tuch}}", 4, "did you mean 'touch'?"),
        ("- {while: {do: [{wait: touch}], until: word, words: [yes]}}", 4, "waits for somebody, as the while does"),
        ("- {while: {do: [{stop: true}], until: touch}}", 4, "would end the wait of the while as well"),
        (
            "- {while: {do: [{call: NaoTactile.getTouched}], until: touch}}",
            4,
            "needs NaoTactile, which waits in until",
        ),
        ("- {while: {do: [{run: nod}], until: time}}", 4, "until: time needs seconds"),
        ("- {while: {run: nod, until: touch}}", 4, "a mapping with do and until"),
        ("- {when: number = 1, then: [{wait: 1}]}", 4, "did you mean number == 1?"),
        ("- {when: number == 1 and trial == 1, then: [{wait: 1}]}", 4, "a list has several that all have to hold"),
        ("- {when: number == 1 or trial == 1, then: [{wait: 1}]}", 4, "`choose` has a branch for each answer"),
        (f"{TOUCH}\n    - {{when: rear head == head, then: [{{wait: 1}}]}}", 5, "cannot be read"),
        (f"{TOUCH}\n    - {{when: chest == head, then: [{{wait: 1}}]}}", 5, "stands on the left: head == chest"),
        ("- {when: touches >= 3, then: [{wait: 1}]}", 4, "{wait: until, until: touches >= 3}"),
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


FACTORS = "factors: {voice: {levels: [low, high]}, side: {levels: {l: {target: left}, r: {target: right}}}}\n"
LIKERT = "- {wizard: How, choices: ['1', '2', '3'], label: how}"


@pytest.mark.parametrize(
    "before, condition, told",
    [
        (TOUCH, "head >= 1", "is never true: head, the answer of 'wait for a touch: head', is front head, middle head"),
        (TOUCH, "head >= 1", "head != none is true where there was one; {wait: until, until: touches >= 1} counts"),
        (
            TOUCH,
            "head_seconds == fast",
            "is never true: head_seconds, the reaction time of head, s, is a number or none",
        ),
        ("- {wait: 1}", "voice > 1", "> compares numbers"),
        ("- {wait: 1}", "voice != medium", "voice is never 'medium'"),
        ("- {wait: 1}", "target == up", "target is never 'up'"),
        ("- {wait: 1}", "trial == 5", "is a whole number from 1 to 4"),
        ("- {wait: 1}", "trials == 4", "is always true"),
        (LIKERT, "how > 3", "is never true"),
        (LIKERT, "[how == 1, how == 2]", "are never true together"),
        ("- {call: NaoTactile.getTouched, label: x}", "x == done", "it is what the function answers, or none"),
        ("- {repeat: 2, as: i, steps: [{wait: 1}]}", "i == 2", "outside of its repeat, is none"),
        (f"- when: number > 2\n      then: [{TOUCH[2:]}]", "head == chest", "head is never 'chest'"),
    ],
)
def test_a_condition_that_is_never_or_always_true_is_refused(before, condition, told):
    with pytest.raises(ConsoleFileError) as error:
        read_protocol(f"{FACTORS}{HEAD}    {before}\n    - {{when: {condition}, then: [{{wait: 1}}]}}\n", "x.yaml")
    assert told in str(error.value)


def test_an_answer_that_comes_later_in_the_file_is_none_and_refused_but_in_a_loop():
    steps = f"- {{when: head == front head, then: [{{wait: 1}}]}}\n    {TOUCH}"
    with pytest.raises(ConsoleFileError, match="no answer here, as it is given by the step in line 5"):
        read_protocol(f"{HEAD}    {steps}\n", "x.yaml")
    inside = steps.replace("\n    ", "\n        ")
    assert read_protocol(f"{HEAD}    - repeat: 2\n      steps:\n        {inside}\n", "x.yaml")


@pytest.mark.parametrize(
    "until, told",
    [("touches >= 0", "is always true"), ("touches < 3", "it would not wait"), ("[touches >= 1, words >= 1]", "")],
)
def test_a_wait_that_would_be_over_at_once_is_refused(until, told):
    text = f"{HEAD}    - {{wait: until, until: {until}}}\n"
    if told:
        with pytest.raises(ConsoleFileError, match=told):
            read_protocol(text, "x")
    else:
        assert read_protocol(text, "x").name == "x"


def test_conditions_may_compare_two_values_and_branches_may_share_a_label():
    choose = (
        "- choose: voice\n      cases:\n        low: [{wait: touch, label: reply}]\n"
        "        high: [{wait: word, words: ['yes'], label: reply}]"
    )
    steps = f"{choose}\n    - {{when: reply == yes, then: [{{wait: 1}}]}}"
    wizard = "- {wizard: Which, choices: [left, right], label: chosen}"
    steps = f"{steps}\n    {wizard}\n    - {{when: 'chosen == {{target}}', then: [{{wait: 1}}]}}"
    assert read_protocol(f"{FACTORS}{HEAD}    {steps}\n", "x").name == "x"


def test_reading_a_protocol_takes_as_long_for_each_step_of_a_long_one():
    step = "      - {say: Please touch my head and wait, label: l%d}\n"

    def seconds(steps):
        text = "name: long\nphases:\n  - phase: Task\n    steps:\n" + "".join(step % i for i in range(steps))
        began = time.process_time()
        read_protocol(text, "long")
        return time.process_time() - began

    assert seconds(4000) < 20 * seconds(500)  # eight times the steps


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
        ("head_seconds < 2.5", {}, False),
        ("answer == none", {}, True),
        ("answer != yes", {}, True),
        ("answer != none", {"answer": "yes"}, True),
        ("likert + 1 > 3", {"likert": "3"}, True),
        ("answer + 1 > 3", {"answer": "yes"}, False),
        ("1 / i > 3", {"i": 0}, False),
        ("chosen == {target}", {"chosen": "left", "target": "left"}, True),
        ("angle > {limit}", {"angle": "0.5", "limit": 0.7}, False),
    ],
)
def test_conditions_compare_values_of_the_trial(text, values, holds):
    assert StudyCondition.read(text).holds(values) is holds


def test_a_wait_that_is_drawn_is_the_same_again_for_a_participant_and_evenly_spread():
    protocol = read_protocol(f"seed: 3\n{HEAD}    - wait: [2, 5]\n", "x")
    step = step_at(protocol, "1.1")
    drawn = [step.drawn("1.1", {"number": number, "trial": 1}).seconds for number in range(1, 201)]
    assert drawn == [step.drawn("1.1", {"number": number, "trial": 1}).seconds for number in range(1, 201)]
    assert (2 <= min(drawn), max(drawn) <= 5, len({*drawn}) > 150) == (True, True, True)
    assert 3.2 < sum(drawn) / len(drawn) < 3.8
    assert step.text == "wait 2 to 5 s"


@pytest.mark.parametrize("wait", ["[5, 2]", "[1]", "[1, 5000]", "[a, b]", "[-1, 2]"])
def test_bounds_of_a_wait_that_are_none_are_refused(wait):
    with pytest.raises(ConsoleFileError, match=r"two numbers 0\.\.3600, as wait: \[2, 5\]"):
        read_protocol(f"{HEAD}    - wait: {wait}\n", "x")


ROUNDS = HEAD + "    - repeat: 4\n      as: i\n      order: random\n      steps: [{when: i == 3, then: [{wait: 1}]}]\n"


def test_rounds_in_a_random_order_have_each_number_once_and_the_same_order_again():
    protocol = read_protocol(ROUNDS, "x")
    orders = []
    for number in range(1, 30):
        values = {"number": number, "trial": 1}
        orders.append(tuple(rounds_of(protocol, f"1.1.r{i}.1", values)["i"] for i in range(1, 5)))
        third = orders[-1].index(3) + 1
        assert course(protocol, **values) == [f"1.1.r{third}.1.b1.1"]
        assert orders[-1] == tuple(rounds_of(protocol, f"1.1.r{i}.1", values)["i"] for i in range(1, 5))
    assert {tuple(sorted(order)) for order in orders} == {(1, 2, 3, 4)} and len({*orders}) > 5


@pytest.mark.parametrize("wrong", ["order: mixed, as: i", "order: random"])
def test_an_order_of_rounds_that_there_is_not_is_refused(wrong):
    with pytest.raises(ConsoleFileError, match="order"):
        read_protocol(f"{HEAD}    - {{repeat: 2, {wrong}, steps: [{{wait: 1}}]}}\n", "x")
