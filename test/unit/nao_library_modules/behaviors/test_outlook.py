"""What is told of a behaviour before it runs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nao_library_modules.behaviors.outlook import MOST_STEPS, outlook_of, waits_of
from nao_library_modules.behaviors.program import InOrder


@pytest.fixture
def waits(program):
    return lambda steps, **values: waits_of(program(steps, **values))


@pytest.mark.parametrize(
    ("steps", "seconds"),
    [
        ("- {wait: 1}\n- {wait: 0.5}", 1.5),
        ("- {NaoLights.on: {lights: [FaceLeds], time: 2}}\n- {wait: 0.5}", 2.5),
        ("- parallel: [{wait: 1}, [{wait: 1}, {wait: 2}]]", 3.0),
        ("- {repeat: 4, do: [{wait: 0.5}]}", 2.0),
        ("- {repeat: 0, do: [{wait: 0.5}]}", 0.0),
        ("- {wait: 10, for: 3}", 3.0),
        ("- timeline: [{wait: 1, at: 0.5, label: a}, {wait: 1, at: a.end + 0.25}, {wait: 0.5, at: a}]", 2.75),
        ("- timeline: [{wait: 1, at: b}, {wait: 2, at: 3, label: b}]", 5.0),
        ("- timeline: [{wait: 1, at: 2}, {barrier: all}, {wait: 0.5, at: all + 1}]", 4.5),
    ],
)
def test_how_long_the_waits_are(waits, steps, seconds):
    assert waits(steps) == pytest.approx(seconds)


def test_a_long_timeline_is_no_problem(waits):
    steps = [f"{{wait: 0.5, at: s{i}.end, label: s{i + 1}}}" for i in range(2000)]
    assert waits(f"- timeline: [{{wait: 1, at: 0, label: s0}}, {', '.join(steps)}]") == pytest.approx(1001.0)


def test_steps_and_boxes_are_told_with_their_paths(program, tables, texts):
    texts["inner"] = "help: x\ndo: [{wait: 1}, {behavior: innermost}]"
    texts["innermost"] = "help: x\ndo: [{nao_audio_out.say: {str_param: hi}}]"
    outlook = outlook_of(program("- {behavior: inner}\n- {repeat: 2, do: [{wait: 0.5}]}"), tables)
    assert outlook.steps == (
        "1 behavior inner",
        "1/1 wait 1 s",
        "1/2 behavior innermost",
        "1/2/1 nao_audio_out.say: str_param hi",
        "2 repeat 2 times",
        "2#1.1 wait 0.5 s",
    )
    assert outlook.boxes == ("inner", "innermost")


def test_a_box_is_known_by_what_it_is_and_not_by_its_text(program, tables, texts):
    texts["inner"] = "help: x\ndo: [{wait: 1}]"
    (box,) = program("- {behavior: inner}").parts
    assert box.box == "inner"
    told = replace(box, what="the box inner")
    other = replace(box, what="behavior of another kind", box="")
    assert outlook_of(InOrder((), "test", "", "test", nodes=(told, other)), tables).boxes == ("inner",)


def test_what_only_the_robot_knows_is_told_and_what_is_known_is_not(program, tables):
    steps = "- chain: {NaoLights: [{function: listLEDs}, {function: on, lights: [Nose], time: 1}]}\n- {wait: 1}"
    assert outlook_of(program(steps), tables).unchecked == ("1 NaoLights.on: lights [Nose]",)


def test_of_many_steps_the_first_are_told(program, tables):
    steps = outlook_of(program("- {wait: 1}\n" * (MOST_STEPS + 5)), tables).steps
    assert (len(steps), steps[-1]) == (MOST_STEPS + 1, "... and 5 more")
