"""Programs from behaviours: values, boxes, goals, and what is refused."""

from __future__ import annotations

import pytest

from nao_library_modules.behaviors import BehaviorError, check, read
from nao_library_modules.behaviors.program import Goal, Pause, servers_in, walk
from nao_library_modules.behaviors.servers import NAMES, FunctionTables, server_of
from nao_library_modules.errors import BadGoal

BOW = """
help: Bows.
parameters: {depth: {default: 0.2, help: how deep, min: 0, max: 1}}
do: [{NaoMotion.setAngles: {names: [HeadPitch], angles: ["${depth}"]}}]
"""


@pytest.fixture(autouse=True)
def bow(texts):
    texts["bow"] = BOW


def goals(program):
    return [node for node in walk(program) if isinstance(node, Goal)]


def test_values_take_the_place_of_parameters(program):
    made = program(
        """
        - NaoLights.fade: {lights: "${names}", i_values: ["${n / 2}"], duration: "${n}", str_param: "say ${n}"}
        - {wait: "${n * 2}", for: "${n}"}
        """,
        "{n: {default: 1, help: x}, names: {default: [A], help: x}}",
        n=0.5,
    )
    (function,) = goals(made)[0].goal.functions
    assert (function.lights, function.i_values, function.duration) == (["A"], [0.25], 0.5)
    assert function.str_param == "say 0.5"
    (pause,) = [node for node in walk(made) if isinstance(node, Pause)]
    assert (pause.duration, pause.limit) == (1.0, 0.5)


def test_boxes_are_unfolded_with_their_own_values(program):
    made = program("- {behavior: bow}\n- {behavior: bow, parameters: {depth: '${d}'}}", "{d: {default: 0.7, help: x}}")
    assert [goal.goal.functions[0].angles for goal in goals(made)] == [[0.2], [0.7]]
    assert [goal.where for goal in goals(made)] == ["1/1", "2/1"]
    assert {goal.behavior for goal in goals(made)} == {"bow"}


def test_rounds_have_numbers(program):
    made = program("- {repeat: 3, as: i, do: [{wait: '${i}'}, {behavior: bow, parameters: {depth: '${i / 10}'}}]}")
    (rounds,) = made.nodes
    third = rounds.round(3)
    assert (third.nodes[0].where, third.nodes[0].duration) == ("1#3.1", 3.0)
    assert (third.nodes[1].nodes[0].where, goals(third)[0].goal.functions[0].angles) == ("1#3.2/1", [0.3])


@pytest.mark.parametrize(
    ("steps", "told"),
    [
        ("- {NaoLight.on: {}}", "did you mean 'NaoLights'"),
        ("- {NaoBehavior.runBehavior: {}}", "would end itself"),
        ("- {NaoLights.on: {light: []}}", "did you mean 'lights'"),
        ("- {NaoLights.on: {time: -1}}", "0 s or more"),
        ("- {NaoLights.onn: {}}", "did you mean 'on'"),
        ("- {NaoLights.on: {on_error: mabye}}", "on_error"),
        ("- {nao_audio_out.say: {}}", "the text to say"),
        ("- chain: {NaoLights: [{function: listLEDs}, {function: onn}]}", "function 2 (onn)"),
        ("- chain: {NaoLights: [{function: listLEDs}, {function: 'on', light: a}]}", "function 2.light"),
        ("- {behavior: boww}", "did you mean 'bow'"),
        ("- {behavior: bow, parameters: {deepth: 1}}", "did you mean 'depth'"),
        ("- {behavior: bow, parameters: {depth: 2}}", "0 to 1"),
        ("- {behavior: bow, parameters: {depth: deep}}", "is no number"),
        ("- {repeat: 1.5, do: [{wait: 1}]}", "whole number"),
        ("- {repeat: 100000, do: [{wait: 1}]}", "whole number"),
        ("- {repeat: 3, as: i, do: [{wait: '${2 - i}'}]}", "${2 - i} is -1"),
        ("- {repeat: 2000, do: [{repeat: 2000, do: [{nothing.x: {}}]}]}", "there is no server 'nothing'"),
        ("- {parallel: [{NaoLights.on: {lights: [A]}}, [{wait: 1}, {NaoLights.off: {lights: [A]}}]]}", "both need"),
        ("- {parallel: [{behavior: bow}, {behavior: bow}]}", "1.1 and 1.2 both need NaoMotion"),
    ],
)
def test_what_cannot_run_is_refused(steps, told, library, tables):
    with pytest.raises(BehaviorError) as caught:
        check(read(f"help: x\ndo:\n{steps}\n", "test"), library, None, tables)
    assert told in str(caught.value)


def test_circles_of_boxes_are_refused(texts, library, tables):
    texts["a"] = "help: x\ndo: [{behavior: b}]"
    texts["b"] = "help: x\ndo: [{wait: 1}, {behavior: a}]"
    with pytest.raises(BehaviorError, match="a -> b -> a"):
        check(library("a"), library, None, tables)


def test_boxes_that_unfold_without_end_are_refused(texts, library, tables):
    texts["b0"] = "help: x\ndo: [{wait: 1}]"
    for i in range(1, 30):
        texts[f"b{i}"] = f"help: x\ndo: [{{behavior: b{i - 1}}}, {{behavior: b{i - 1}}}]"
    with pytest.raises(BehaviorError, match="more than 10000 steps"):
        check(library("b29"), library, None, tables)


def test_what_is_wrong_in_a_box_is_told_with_its_path(texts, library, tables):
    texts["outer"] = "help: x\ndo: [{behavior: inner}, {behavior: broken}]"
    texts["inner"] = "help: x\ndo: [{wait: 1}, {NaoLights.onn: {}}]"
    texts["broken"] = "help: x\ndo: [{wat: 1}]"
    with pytest.raises(BehaviorError) as caught:
        check(library("outer"), library, None, tables)
    assert [each.where for each in caught.value.problems] == ["step 1/2 in inner", "step 2"]
    assert "behavior broken: step 1" in str(caught.value)


def test_values_that_a_parameter_cannot_have_are_refused(library, tables):
    with pytest.raises(BadGoal, match="0 to 1"):
        check(library("bow"), library, {"depth": 3}, tables)


def test_servers_are_known(program):
    assert list(servers_in(program("- {behavior: bow}\n- {repeat: 2, do: [{NaoLights.listLEDs: {}}]}"))) == [
        "NaoMotion",
        "NaoLights",
    ]


@pytest.mark.parametrize("name", NAMES)
def test_steps_of_all_servers_are_checked_without_a_master(monkeypatch, name):
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:9")  # the port of the discard service: nobody listens
    assert "getData" in FunctionTables().functions(server_of(name))
