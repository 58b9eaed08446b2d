"""The tool that measures localisation: its options, its bounds, and a few real sounds."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools"
NAME = "check_localisation"


@pytest.fixture(scope="module")
def tool():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield importlib.import_module(NAME)
    sys.modules.pop(NAME, None)


@pytest.mark.parametrize(
    "arguments, problem",
    [(["up"], "no part up"), (["--sounds", "0"], "--sounds is 0"), (["--seconds", "nan"], "--seconds is nan")],
)
def test_wrong_options_are_refused(tool, capsys, arguments, problem):
    with pytest.raises(SystemExit):
        tool.options(arguments)
    assert problem in capsys.readouterr().err


@pytest.mark.parametrize("right, located, kept", [(10, 10, True), (9, 10, True), (8, 10, False), (8, 8, False)])
def test_nine_of_ten_have_to_be_located_and_right(tool, right, located, kept):
    blocks = [
        tool.Located(1.0 if n < right else 20.0, 0.0) if n < located else tool.Located(None, None) for n in range(10)
    ]
    assert tool.summary("some", blocks, bounded=True).kept is kept
    assert tool.summary("some", blocks, bounded=False).kept is True


def test_level_sources_are_found(tool):
    lines = list(tool.measure_places("level", 3, seed=1))
    assert len(lines) == 8
    assert all("located" in line.figure for line in lines)
    assert sum(line.kept for line in lines) >= 7


def test_noise_is_measured(tool, capsys):
    assert tool.measure(["quiet"], 1, 2.0, 1) == 0
    assert capsys.readouterr().out.count("0 beginnings and ends detected, 0 sounds located in 2 s") == 6
