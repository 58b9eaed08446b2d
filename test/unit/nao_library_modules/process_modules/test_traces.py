"""Traces that are drawn, kept, compared; plans that are projected."""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest

from nao_library_modules.process_modules.control import do, par, seq, top_level
from nao_library_modules.process_modules.failures import PlanFailure, fail
from nao_library_modules.process_modules.projection import ProjectionFailed, compare, run_program
from nao_library_modules.process_modules.trace import Trace, trace_of
from nao_library_modules.process_modules.trace_picture import COLORS, draw, main
from naoqi.errors import NaoError


@pytest.fixture
def trace():
    roots = []
    with pytest.raises(PlanFailure):
        top_level(
            lambda: seq(do(int, "1", name="count"), lambda: par(do(int, "2", name="two"), do(fail, "no", name="bad"))),
            name="plan",
            observers=[roots.append],
        )
    return trace_of(roots[0])


def test_the_picture_has_a_bar_for_each_state(trace):
    colors = set(draw(trace).getdata())
    assert COLORS["failed"] in colors and COLORS["succeeded"] in colors
    assert draw(trace).size[1] == (len(trace.records) + 2) * 22 + 28


def test_a_trace_in_a_file_is_drawn_by_the_command(trace, tmp_path, capsys):
    (tmp_path / "trace.json").write_text(trace.to_json())
    assert main([str(tmp_path / "trace.json"), str(tmp_path / "trace.png")]) == 0
    assert (tmp_path / "trace.png").stat().st_size > 1000
    (tmp_path / "trace.json").write_text("{}")
    assert main([str(tmp_path / "trace.json"), str(tmp_path / "trace.png")]) == 1
    assert "trace.json: 'tasks'" in capsys.readouterr().err


def test_an_empty_trace_cannot_be_drawn():
    with pytest.raises(NaoError, match="without a task"):
        draw(Trace(()))


def test_the_same_plan_comes_out_alike(trace):
    assert compare(trace, trace).alike


def test_what_came_out_otherwise_is_told_with_its_path(trace):
    changed = [
        replace(record, state="succeeded", failure="") if record.name == "bad" else record for record in trace.records
    ]
    extra = replace(trace.records[-1], number=99, name="extra")
    differences = compare(trace, Trace((*changed, extra))).differences
    assert [str(each) for each in differences] == [
        "plan/seq/step/par/bad: failed (SimplePlanFailure) -> succeeded",
        "plan/seq/step/par/extra: not there -> failed (SimplePlanFailure)",
    ]


def test_a_program_of_a_plan_runs_with_another_master(trace, tmp_path):
    program = tmp_path / "plan.py"
    program.write_text(
        "import os, sys\n"
        "assert os.environ['ROS_MASTER_URI'] == 'http://127.0.0.1:1'\n"
        f"open(sys.argv[-1], 'w').write({trace.to_json()!r} if sys.argv[1] == 'good' else '')\n"
        "sys.exit('it is dark')\n"
    )
    assert run_program(program, ["good"], "http://127.0.0.1:1", tmp_path) == trace
    with pytest.raises(ProjectionFailed, match="plan.py kept no trace: it is dark"):
        run_program(program, ["bad"], "http://127.0.0.1:1", tmp_path)
    assert sys.executable
