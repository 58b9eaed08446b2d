"""Texts to behaviours, and what is said about wrong ones."""

from __future__ import annotations

import pytest
from behavior_texts import EVERYTHING

from nao_library_modules.behaviors import BehaviorError, read
from nao_library_modules.behaviors.model import Barrier, Box, Functions, Parallel, Repeat, Sequence, Timeline, Wait
from nao_library_modules.behaviors.reader import require_name
from nao_library_modules.behaviors.times import At
from nao_library_modules.errors import BadGoal


def problems(text):
    with pytest.raises(BehaviorError) as caught:
        read(text, "test")
    return caught.value.problems


def test_everything_that_a_file_may_hold_is_read():
    behavior = read(EVERYTHING, "hello")
    assert (behavior.name, behavior.help, behavior.tags) == ("hello", "Waves and says hello.", ("greeting",))
    assert [p.kind for p in behavior.parameters.values()] == ["text", "number", "text"]
    steps = behavior.body.steps
    kinds = [Functions, Parallel, Timeline, Box, Functions, Repeat, Functions, Sequence]
    assert [type(step) for step in steps] == kinds
    assert steps[0].functions == ({"function": "goToPosture", "str_param": "Stand"},)
    assert isinstance(steps[1].steps[1], Sequence) and isinstance(steps[1].steps[1].steps[1], Wait)
    assert [each.at for each in steps[2].steps[:3]] == [At(0.5), At(0.5, "eyes", True), At("${count / 2}", "eyes")]
    assert isinstance(steps[2].steps[3], Barrier)
    assert (steps[3].name, steps[3].arguments) == ("bow", {"depth": 0.3})
    assert [each["function"] for each in steps[4].functions] == ["on", "off"]
    assert (steps[5].variable, steps[6].label, steps[6].limit) == ("round", "x", 3.0)
    assert (steps[6].policy.retries, steps[6].policy.skip) == (2, True)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "no mapping"),
        ("- a", "no mapping"),
        ("help: a\nhelp: b", "'help' comes twice"),
        ("help: [a", "no YAML"),
        ("help: x\nsteps: []", "unknown key 'steps'"),
        ("do: [{wait: 1}]", "help: a line is needed"),
        ("help: x", "do: a list of steps"),
        ("help: x\ndo: []", "at least one"),
        ("help: x\ntags: a\ndo: [{wait: 1}]", "tags"),
        ("help: x\nparameters: {a: 1}\ndo: [{wait: 1}]", "{default: ..., help: ...}"),
        ("help: x\nparameters: {a: {default: 1}}\ndo: [{wait: 1}]", "field help"),
        ("help: x\nparameters: {a: {default: 1, help: x, minn: 1}}\ndo: [{wait: 1}]", "did you mean 'min'"),
        (
            "help: x\nparameters: {a: {default: hi, help: x, min: 1}}\ndo: [{wait: 1}]",
            "field min: it is for numbers, and the default 'hi' makes this parameter a text: a text may have choices; "
            "for min, let the default be a number",
        ),
        ("help: x\nparameters: {a: {default: true, help: x, max: 1}}\ndo: [{wait: 1}]", "makes this parameter a truth"),
        ("help: x\nparameters: {a: {default: [1], help: x, max: 1}}\ndo: [{wait: 1}]", "makes this parameter a list"),
        (
            "help: x\nparameters: {a: {default: hi, help: x, unit: s}}\ndo: [{wait: 1}]",
            "let the default be a number, or",
        ),
        (
            "help: x\nparameters: {a: {default: 1, help: x, min: low}}\ndo: [{wait: 1}]",
            "'low' is not allowed: a number",
        ),
        ("help: x\nparameters: {a: {default: 1, help: x, unit: 3}}\ndo: [{wait: 1}]", "a text, as m, rad or s"),
        ("help: x\nparameters: {a: {default: 9, help: x, max: 5}}\ndo: [{wait: 1}]", "field a: 9 is not allowed"),
        ("help: x\nparameters: {a: {default: a, help: x, max: 5}}\ndo: [{wait: 1}]", "field max"),
        ("help: x\nparameters: {a: {default: {}, help: x}}\ndo: [{wait: 1}]", "a text, a number"),
        ("help: x\nparameters: {1a: {default: 1, help: x}}\ndo: [{wait: 1}]", "no digit in front"),
        ("help: x\nparameters: {a: {default: b, help: x, choices: [c]}}\ndo: [{wait: 1}]", "'b' is not allowed"),
        ("help: x\ndo: [{wait: -1}]", "0 or more"),
        ("help: x\ndo: [{wait: .nan}]", "0 or more"),
        ("help: x\ndo: [{wait: true}]", "0 or more"),
        ("help: x\ndo: [{wait: '${n}'}]", "no parameter 'n'"),
        ("help: x\ndo: [{wait: 1, at: 2}]", "for entries of a timeline"),
        ("help: x\ndo: [{wait: 1, on_eror: skip}]", "did you mean 'on_error'"),
        ("help: x\ndo: [{wait: 1, on_error: maybe}]", "field on_error"),
        ("help: x\ndo: [{wait: 1, NaoLights.on: {}}]", "several things at once"),
        ("help: x\ndo: [{label: x}]", "does not say what to do"),
        ("help: x\ndo: [{paralel: []}]", "did you mean 'parallel'"),
        ("help: x\ndo: [4]", "a mapping with one of"),
        ("help: x\ndo: [[]]", "the sequence is empty"),
        ("help: x\ndo: [{parallel: []}]", "at least one"),
        ("help: x\ndo: [{A.b.c: {}}]", "SERVER.FUNCTION"),
        ("help: x\ndo: [{NaoLights.on: [1]}]", "{FIELD: VALUE, ...}"),
        ("help: x\ndo: [{NaoLights.on: {function: off}}]", "the key names it already"),
        ("help: x\ndo: [{chain: {A: [], B: []}}]", "field chain"),
        ("help: x\ndo: [{chain: {A: [{lights: []}]}}]", "function 1 has no name"),
        ("help: x\ndo: [{behavior: 3}]", "name of a behavior"),
        ("help: x\ndo: [{repeat: 3}]", "field do"),
        ("help: x\ndo: [{repeat: 2, as: i, do: [{repeat: 2, as: i, do: [{wait: 1}]}]}]", "there is a 'i' already"),
        ("help: x\ndo: [{repeat: 2, as: i, do: [{wait: 1}]}, {wait: '${i}'}]", "no parameter 'i'"),
        ("help: x\ndo: [{repeat: 2, as: [], do: [{wait: 1}]}]", "field as"),
        ("help: x\ndo: [{repeat: 2, as: 0, do: [{wait: 1}]}]", "field as"),
        ("help: x\ndo: [{repeat: 2, as: null, do: [{wait: 1}]}]", "field as"),
        ("help: x\ndo: [{wait: 1, label: a}, {wait: 1, label: a}]", "the label 'a' is taken by step 1"),
        ("help: x\ndo: [{timeline: [{wait: 1, at: b}]}]", "no label 'b'"),
        ("help: x\ndo: [{timeline: [{wait: 1, at: a - 1, label: a}]}]", "field at"),
        ("help: x\ndo: [{timeline: [{wait: 1, at: a, label: a}]}]", "wait for each other"),
        ("help: x\ndo: [{timeline: [{barrier: a}, {wait: 1}]}]", "nothing is above"),
        ("help: x\ndo: [{timeline: [{wait: 1, at: b}, {barrier: b}]}]", "wait for each other"),
        ("help: x\ndo: [{barrier: b}]", "stands on a timeline"),
        ("help: x\ndo: [{parallel: [[{barrier: b}], [{wait: 1}]]}]", "only one branch"),
        ("help: x\ndo: [{parallel: [[{repeat: 2, do: [{barrier: b}]}], [{barrier: b}]]}]", "in no repetition"),
        (
            "help: x\ndo: [{parallel: [[{barrier: a}, {barrier: b}], [{barrier: b}, {barrier: a}]]}]",
            "in circles",
        ),
    ],
)
def test_what_is_wrong_is_told(text, told):
    assert told in "; ".join(map(str, problems(text)))


def test_all_that_is_wrong_is_told_with_path_and_line():
    found = problems("help: x\ndo:\n  - {wait: -1}\n  - parallel:\n      - {wait: 1}\n      - {waitt: 2}\n")
    assert [(each.where, each.line) for each in found] == [("step 1", 3), ("step 2.2", 6)]


def test_a_few_lines_cannot_stand_for_endless_values():
    bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n"
    for i in range(1, 9):
        bomb += f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n"
    assert "values" in str(problems(bomb)[0])
    assert "levels" in str(problems("[" * 5000 + "]" * 5000)[0]) or "no YAML" in str(problems("[" * 5000)[0])


@pytest.mark.parametrize("name", ["", "../x", "a/b", ".hidden", "a b", "-a", "a.yaml", "ä", "a" * 101, "a\n"])
def test_names_stay_in_their_folder(name):
    with pytest.raises(BadGoal):
        require_name(name)
