"""Programs from behaviours: values, boxes, goals, what is refused, and what is told before they run."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nao_library_modules.behaviors import BehaviorError, check, read
from nao_library_modules.behaviors.checking import preview_of, waits_of
from nao_library_modules.behaviors.model import GoalNode, Pause, SequenceNode, servers_in, walk
from nao_library_modules.behaviors.server_functions import FunctionTables, NotDescribed
from nao_library_modules.core.errors import BadGoal
from nao_library_msgs.msg import ArgumentDescription, FunctionDescription
from nao_library_msgs.srv import DescribeFunctionsResponse

BOW = """
help: Bows.
parameters: {depth: {default: 0.2, help: how deep, min: 0, max: 1}}
do: [{NaoMotion.setAngles: {names: [HeadPitch], angles: ["${depth}"]}}]
"""


@pytest.fixture(autouse=True)
def bow(texts):
    texts["bow"] = BOW


def goals(program):
    return [node for node in walk(program) if isinstance(node, GoalNode)]


def test_values_take_the_place_of_parameters(program):
    fade = 'NaoLights.fade: {lights: "${names}", i_values: ["${n / 2}"], duration: "${n}", str_param: "say ${n}"}'
    steps = f"- {{{fade}}}\n- {{wait: '${{n * 2}}', for: '${{n}}'}}"
    made = program(steps, "{n: {default: 1, help: x}, names: {default: [A], help: x}}", n=0.5)
    (function,) = goals(made)[0].goal.functions
    assert (function.lights, function.i_values, function.duration) == (["A"], [0.25], 0.5)
    assert function.str_param == "say 0.5"
    (pause,) = [node for node in walk(made) if isinstance(node, Pause)]
    assert (pause.duration, pause.limit) == (1.0, 0.5)


def test_boxes_are_unfolded_with_their_own_values_and_rounds_have_numbers(program):
    steps = "- {behavior: bow}\n- {behavior: bow, parameters: {depth: '${d}'}}"
    made = program(steps, "{d: {default: 0.7, help: x}}")
    assert [goal.goal.functions[0].angles for goal in goals(made)] == [[0.2], [0.7]]
    assert [goal.where for goal in goals(made)] == ["1/1", "2/1"] and {goal.behavior for goal in goals(made)} == {"bow"}
    rounds = "- {repeat: 3, as: i, do: [{wait: '${i}'}, {behavior: bow, parameters: {depth: '${i / 10}'}}]}"
    made = program(f"{rounds}\n- {{NaoLights.listLEDs: {{}}}}")
    third = made.nodes[0].round(3)
    assert (third.nodes[0].where, third.nodes[0].duration) == ("1#3.1", 3.0)
    assert (third.nodes[1].nodes[0].where, goals(third)[0].goal.functions[0].angles) == ("1#3.2/1", [0.3])
    assert list(servers_in(made)) == ["NaoMotion", "NaoLights"]


@pytest.mark.parametrize(
    "step, told",
    [
        ("{NaoLight.on: {}}", "did you mean 'NaoLights'"), ("{NaoBehavior.runBehavior: {}}", "would end itself"),
        ("{NaoLights.on: {light: []}}", "did you mean 'lights'"), ("{NaoLights.on: {time: -1}}", "0..86400 s"),
        ("{NaoLights.onn: {}}", "did you mean 'on'"), ("{NaoLights.on: {on_error: mabye}}", "on_error"),
        ("{nao_audio_out.say: {}}", "the text to say"),
        ("{chain: {NaoLights: [{function: listLEDs}, {function: onn}]}}", "function 2 (onn)"),
        ("{behavior: boww}", "did you mean 'bow'"),
        ("{behavior: bow, parameters: {deepth: 1}}", "did you mean 'depth'"),
        ("{behavior: bow, parameters: {depth: 2}}", "0 to 1"),
        ("{repeat: 1.5, do: [{wait: 1}]}", "whole number"),
        ("{repeat: 3, as: i, do: [{wait: '${2 - i}'}]}", "${2 - i} is -1"),
        ("{repeat: 2000, do: [{repeat: 2000, do: [{nothing.x: {}}]}]}", "there is no server 'nothing'"),
        ("{parallel: [{NaoLights.on: {lights: [A]}}, [{wait: 1}, {NaoLights.off: {lights: [A]}}]]}", "both need"),
        ("{parallel: [{behavior: bow}, {behavior: bow}]}", "1.1 and 1.2 both need NaoMotion"),
    ],
)  # fmt: skip
def test_what_cannot_run_is_refused(step, told, library, tables):
    with pytest.raises(BehaviorError) as caught:
        check(read(f"help: x\ndo: [{step}]\n", "test"), library, None, tables)
    assert told in str(caught.value)


def test_boxes_in_circles_or_without_end_or_with_wrong_values_are_refused(texts, library, tables):
    texts["a"] = "help: x\ndo: [{behavior: b}]"
    texts["b"] = "help: x\ndo: [{wait: 1}, {behavior: a}]"
    with pytest.raises(BehaviorError, match="a -> b -> a"):
        check(library("a"), library, None, tables)
    texts["b0"] = "help: x\ndo: [{wait: 1}]"
    texts.update({f"b{i}": f"help: x\ndo: [{{behavior: b{i - 1}}}, {{behavior: b{i - 1}}}]" for i in range(1, 30)})
    with pytest.raises(BehaviorError, match="more than 10000 steps"):
        check(library("b29"), library, None, tables)
    with pytest.raises(BadGoal, match="0 to 1"):
        check(library("bow"), library, {"depth": 3}, tables)
    texts["outer"] = "help: x\ndo: [{behavior: inner}]"
    texts["inner"] = "help: x\ndo: [{wait: 1}, {NaoLights.onn: {}}]"
    with pytest.raises(BehaviorError) as caught:
        check(library("outer"), library, None, tables)
    assert [each.where for each in caught.value.problems] == ["step 1/2 in inner"]


CHAIN = ", ".join(f"{{wait: 0.5, at: s{i}.end, label: s{i + 1}}}" for i in range(1000))


@pytest.mark.parametrize(
    "steps, seconds",
    [
        ("- {wait: 1}\n- {wait: 0.5}", 1.5), ("- {NaoLights.on: {lights: [FaceLeds], time: 2}}\n- {wait: 0.5}", 2.5),
        ("- parallel: [{wait: 1}, [{wait: 1}, {wait: 2}]]", 3.0), ("- race: [{wait: 1}, [{wait: 2}]]", 1.0),
        ("- {repeat: 4, do: [{wait: 0.5}]}", 2.0),
        ("- {repeat: 0, do: [{wait: 0.5}]}", 0.0), ("- {wait: 10, for: 3}", 3.0),
        ("- timeline: [{wait: 1, at: 0.5, label: a}, {wait: 1, at: a.end + 0.25}, {wait: 0.5, at: a}]", 2.75),
        ("- timeline: [{wait: 1, at: 2}, {barrier: all}, {wait: 0.5, at: all + 1}]", 4.5),
        (f"- timeline: [{{wait: 1, at: 0, label: s0}}, {CHAIN}]", 501.0),
    ],
    ids=lambda value: str(value)[:40],
)  # fmt: skip
def test_how_long_the_waits_are(program, steps, seconds):
    assert waits_of(program(steps)) == pytest.approx(seconds)


def test_steps_and_boxes_are_told_with_their_paths(program, tables, texts):
    texts["inner"] = "help: x\ndo: [{wait: 1}, {behavior: innermost}]"
    texts["innermost"] = "help: x\ndo: [{nao_audio_out.say: {str_param: hi}}]"
    made = program("- {behavior: inner}\n- {repeat: 2, do: [{wait: 0.5}]}")
    preview = preview_of(made, tables)
    assert preview.steps == (
        "1 behavior inner", "1/1 wait 1 s", "1/2 behavior innermost", "1/2/1 nao_audio_out.say: str_param hi",
        "2 repeat 2 times", "2#1.1 wait 0.5 s",
    )  # fmt: skip
    assert preview.boxes == ("inner", "innermost")
    # A box is known by what it is and not by its text.
    told, other = replace(made.parts[0], what="the inner"), replace(made.parts[0], what="behavior of a kind", box="")
    assert preview_of(SequenceNode((), "test", "", "test", nodes=(told, other)), tables).boxes == ("inner", "innermost")


def others(server, functions):
    """Servers that run: one that is none of ours, and one of ours with a function more."""
    if server not in ("NaoMood", "NaoLights"):
        raise NotDescribed("it does not run")
    blink = FunctionDescription(name="blink", arguments=[ArgumentDescription(name="lights")])
    types = {"action": "nao_library_actions/NaoLed", "message": "nao_library_msgs/LedFunction"}
    asked = [] if functions is None or functions not in ([], ["blink"]) else [blink]
    return DescribeFunctionsResponse(**types, functions=asked)


def test_servers_and_functions_of_ones_own_may_be_used_where_they_run(library):
    running = FunctionTables(others)
    for name in ("NaoMood", "NaoLights"):
        made = check(
            read(f"help: x\ndo: [{{{name}.blink: {{lights: [FaceLeds], time: 1}}}}]", "t"), library, None, running
        )
        (goal,) = goals(made)
        assert (goal.server, goal.goal.functions[0].lights) == (name, ["FaceLeds"])
        assert preview_of(made, running).unchecked == (f"1 {name}.blink: lights [FaceLeds]",)


@pytest.mark.parametrize(
    "step, told",
    [
        ("{NaoMood.blnk: {}}", "unknown function 'blnk': did you mean 'blink'"),
        ("{NaoMood.blink: {light: []}}", "did you mean 'lights'"),
        ("{NaoLights.blnk: {}}", "unknown function 'blnk'"),
        ("{NaoSmell.blink: {}}", "there is no server 'NaoSmell'"),
    ],
)
def test_what_those_do_not_have_is_refused(step, told, library):
    with pytest.raises(BehaviorError) as caught:
        check(read(f"help: x\ndo: [{step}]\n", "test"), library, None, FunctionTables(others))
    assert told in str(caught.value)


@pytest.mark.parametrize(
    "step, told",
    [
        ("NaoMotion.moveTo: {values: [30, 0, 0]}", "field values: 30 is unusual: usual is -10..10 m"),
        ("NaoMotion.move: {values: [0.5, 0, 0]}", "usual is -0.2..0.2 m/s"),
        ("NaoLights.reset: {lights: [FaceLeds], time: 80000}", "field time: 80000 is unusual: usual is 0..3600 s"),
        ("NaoMotion.angleInterpolation: {names: [HeadYaw], angles: [0.1], times: [9000]}", "field times: 9000"),
        ("wait: 7200", "field wait: 7200 is unusual"),
        ("wait: 1, for: 7200", "field for: 7200 is unusual"),
    ],
)
def test_a_number_that_is_not_usual_is_refused_unless_the_step_says_that_it_is_meant(step, told, library, tables):
    with pytest.raises(BehaviorError) as caught:
        check(read(f"help: x\ndo: [{{{step}}}]\n", "test"), library, None, tables)
    assert told in str(caught.value)
    check(read(f"help: x\ndo: [{{{step}, unusual: true}}]\n", "test"), library, None, tables)


def test_what_no_robot_takes_is_refused_though_the_step_says_that_it_is_meant(library, tables):
    step = "{NaoMotion.setAngles: {names: [HeadYaw], angles: [5.0], speed: 0.2}, unusual: true}"
    with pytest.raises(BehaviorError, match="HeadYaw cannot go to 5.0000 rad: -2.0857 to 2.0857 rad"):
        check(read(f"help: x\ndo: [{step}]\n", "test"), library, None, tables)
