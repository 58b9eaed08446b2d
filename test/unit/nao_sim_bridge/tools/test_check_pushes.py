"""The table of pushes counts what happens."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools" / "check_pushes.py"


@pytest.fixture
def check(monkeypatch, capsys):
    """Runs the program; its exit status and the lines it printed."""

    def run(*options):
        monkeypatch.setattr(sys, "argv", [str(PROGRAM), *options])
        with pytest.raises(SystemExit) as end:
            runpy.run_path(str(PROGRAM), run_name="__main__")
        return int(end.value.code), capsys.readouterr().out.splitlines()

    return run


def test_survived_pushes_are_counted_for_each_side(check):
    status, lines = check("--postures", "Stand", "--impulses", "1.0", "--runs", "1")
    assert status == 0
    assert [line.split()[:5] for line in lines[1:]] == [
        ["Stand", side, "1", "of", "1"] for side in ("front", "left", "back", "right")
    ]


def test_falls_fail_the_check(check):
    status, lines = check("--postures", "Stand", "--impulses", "6.0", "--runs", "1")
    assert status == 1
    assert all(line.split()[2:5] == ["0", "of", "1"] for line in lines[1:])


def test_the_lead_of_the_fall_manager_is_printed_for_eight_directions(check):
    status, lines = check("--postures", "Stand", "--impulses", "5.0", "--runs", "1", "--falls")
    assert status == 0
    leads = [float(line.split()[5]) for line in lines[1:]]
    assert len(leads) == 8
    assert min(leads) > 0.15
