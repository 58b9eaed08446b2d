"""The tool that tries all changes of posture: its options, its table, and a few real changes."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools" / "check_posture_graph.py"


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("check_posture_graph", TOOL)
    module = importlib.util.module_from_spec(spec)
    # A dataclass looks for the module that it belongs to.
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, spec.name, module)
        spec.loader.exec_module(module)
        yield module


def test_it_explains_itself(tool, capsys):
    with pytest.raises(SystemExit) as end:
        tool.parse(["--help"])
    assert end.value.code == 0
    assert "--falls" in capsys.readouterr().out


def test_an_unknown_posture_is_refused(tool, capsys):
    with pytest.raises(SystemExit):
        tool.parse(["--start", "Handstand"])
    assert "Handstand" in capsys.readouterr().err


def test_the_table_has_a_cell_for_each_change(tool):
    one = tool.Outcome(True, 1.25, 0, "1.2", "")
    other = tool.Outcome(False, 9.0, 1, "FELL", "it fell on the way")
    lines = tool.table({("Stand", "Crouch"): one, ("Crouch", "Stand"): other}).splitlines()
    assert [line.split() for line in lines] == [
        ["from", "\\", "to", "Crouch", "Stand"],
        ["Stand", "1.2", "-"],
        ["Crouch", "-", "FELL"],
    ]


def test_changes_that_get_there_are_a_success(tool, capsys):
    assert tool.main(["--start", "Crouch", "--goal", "Stand", "StandInit", "--noise", "0.02"]) == 0
    assert "2 of 2 changes reached their posture" in capsys.readouterr().out


def test_a_robot_that_cannot_go_on_its_start_is_a_failure(tool, capsys):
    """So much noise in the legs that it falls before the change."""
    assert tool.main(["--start", "StandZero", "--goal", "Stand", "--noise", "0.6"]) == 1
    output = capsys.readouterr().out
    assert "BEGAN" in output and "0 of 1 changes" in output


def test_a_robot_that_was_pushed_over_stands_up(tool):
    lay, outcome = tool.stand_up(180.0, 1.0, 0)
    assert lay == "LyingBack"
    assert outcome.reached and outcome.time > 5.0
