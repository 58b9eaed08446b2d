"""`nao sweep`: how ranges are typed, and what is run for them."""

from __future__ import annotations

import click
import pytest

import nao_library_modules.sweeps
from nao_library_modules.cli.commands.behaviors_commands import Seeds, read_values
from nao_library_modules.sweeps import BehaviorGoal, PlanProgram
from nao_sim_bridge.sweep import Table

ROWS = [{"seed": 0, "fell": True, "outcome": "succeeded", "seconds": 1.0, "error": ""}]


@pytest.fixture
def swept(monkeypatch):
    """What is asked for, instead of being run."""
    asked = []

    def sweep_stack(subject, **options):
        asked.append((subject, options))
        return Table([], ROWS)

    monkeypatch.setattr(nao_library_modules.sweeps, "sweep_stack", sweep_stack)
    return asked


@pytest.mark.parametrize(
    "text, values",
    [
        ("0..2", [0, 1, 2]),
        ("0..2:0.5", [0, 0.5, 1, 1.5, 2]),
        ("0..1:0.4", [0, 0.4, 0.8]),
        ("0..0.3:0.1", [0, 0.1, 0.2, 0.3]),
        ("-1..0", [-1, 0]),
        ("3", [3]),
        ("0,2.5,4..6", [0, 2.5, 4, 5, 6]),
    ],
)
def test_values_are_lists_and_ranges_with_both_ends(text, values):
    assert read_values(text) == values


@pytest.mark.parametrize(
    "text, words",
    [
        ("2..0", "goes nowhere"),
        ("0..2:0", "STEP is above 0"),
        ("0..x", "is no range"),
        ("", "is no range"),
        ("1,,2", "is no range"),
        ("0..inf", "is no range"),
        ("0..2,1", "1 is there twice"),
        ("0..1e9", "more than 10000"),
    ],
)
def test_what_is_no_range_is_refused(text, words):
    with pytest.raises(ValueError, match=words):
        read_values(text)


def test_one_number_of_seeds_tells_how_many_a_range_which():
    seeds = Seeds()
    assert seeds.convert("3", None, None) == [0, 1, 2]
    assert seeds.convert("7..9", None, None) == [7, 8, 9]
    for text in ("0", "1.5,2", "-1..1"):
        with pytest.raises(click.BadParameter, match="whole numbers from 0 on"):
            seeds.convert(text, None, None)


def test_a_behaviour_is_swept_over_each_parameter_that_is_there_several_times(graph, run, swept):
    line = "sweep dance tempo=100 tempo=120 volume=0.5 --seeds 2 --push 0..1:0.5 --noise 1 --output x.csv --workers 2"
    assert run(*line.split()).stdout.splitlines()[1].split() == ["1", "1", "1", "0.2065", "to", "1"]
    ((subject, options),) = swept
    assert subject == BehaviorGoal("dance")
    assert options["parameters"] == {"tempo": ["100", "120"], "volume": ["0.5"]}
    assert (options["seeds"], options["push"], options["noise"]) == ([0, 1], [0, 0.5, 1], [1])
    assert (options["payload"], options["delay"], options["output"], options["workers"]) == ((), (), "x.csv", 2)


def test_a_file_is_sent_along_and_a_program_has_its_arguments(graph, run, swept, tmp_path):
    behavior, plan = tmp_path / "mine.yaml", tmp_path / "plan.py"
    behavior.write_text("help: Waits.\ndo: [{wait: 1}]\n")
    plan.write_text("")
    run("sweep", str(behavior))
    run("sweep", str(plan), "1.5", "-0.2", "--seeds", "4")
    assert swept[0][0] == BehaviorGoal(text=behavior.read_text(), file=str(behavior))
    assert swept[1][0] == PlanProgram(plan, ("1.5", "-0.2")) and swept[1][1]["seeds"] == [0, 1, 2, 3]


@pytest.mark.parametrize(
    "line, status, words",
    [
        ("sweep dnace", 1, "did you mean 'dance'"),
        ("sweep dance tempo=100 tempo=110", 1, "110 is not allowed: one of 100, 120"),
        ("sweep dance tempo", 2, "is no PARAMETER=VALUE"),
        ("sweep no_plan.py", 1, "there is no program no_plan.py"),
        ("sweep dance --push 2..0", 2, "goes nowhere"),
        ("sweep dance --plot x.txt", 2, "ends in .png or .pdf or .svg"),
    ],
)
def test_what_cannot_be_swept_is_refused_before_a_robot_starts(line, status, words, graph, run, swept):
    result = run(*line.split())
    assert (result.exit_code, swept) == (status, []) and words in result.stderr
