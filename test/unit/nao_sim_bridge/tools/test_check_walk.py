"""The tool that measures walks: its options, its bounds, and a few real runs."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools"
NAMES = ("walk_trial", "walk_runs", "check_walk")


@pytest.fixture(scope="module")
def tools():
    """The modules of the tool by name; they find each other as when one is started."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield {name: importlib.import_module(name) for name in NAMES}
    for name in NAMES:
        sys.modules.pop(name, None)


@pytest.mark.parametrize(
    "arguments, problem", [(["jumps"], "no part jumps"), (["--jobs", "0"], "--jobs is 0"), (["--runs", "-1"], "--runs")]
)
def test_wrong_options_are_refused(tools, capsys, arguments, problem):
    with pytest.raises(SystemExit):
        tools["check_walk"].options(arguments)
    assert problem in capsys.readouterr().err


@pytest.mark.parametrize("falls, missed", [(0, 0), (1, 0), (2, 0), (3, 4)])
def test_nine_of_ten_must_survive_a_push(tools, capsys, falls, missed):
    tool, runs = tools["check_walk"], tools["walk_runs"]
    made = [runs.Fall(index < falls, None, False, True) for index in range(20)]
    extent = tool.Extent(None, 60.0, 5.0, 1)
    assert tool.measure(["push"], extent, lambda run, jobs: made) == missed
    assert capsys.readouterr().out.count("MISSED") == missed


def test_a_fall_among_random_orders_is_told_with_its_seed(tools, capsys):
    tool = tools["check_walk"]
    extent = tool.Extent(2, 60.0, 5.0, 7)
    assert tool.measure(["wander"], extent, lambda run, jobs: [(True, 300.0, ""), (False, 12.0, "fell")]) == 1
    assert "seed 8: fell at 12 s" in capsys.readouterr().out


def test_a_stopped_walk_is_measured(tools):
    assert tools["walk_runs"].stop_somewhere(2) is True


def test_a_walk_has_the_speed_asked_for(tools):
    made = tools["walk_runs"].straight((0.08, 0.0, 0.0), {}, 4.2)
    assert made.up
    assert made.speed[0] == pytest.approx(0.08, rel=0.05)
    assert made.odometry < 0.05
    assert 0.3 < made.fastest[0] < 1.2


def test_a_push_that_nobody_survives_is_a_fall_that_was_foreseen(tools):
    made = tools["walk_runs"].push(1, 1, 8.0, get_up=False)
    assert made.fell and made.impact
    assert made.noticed_before is not None
    assert made.noticed_before > 0.0
