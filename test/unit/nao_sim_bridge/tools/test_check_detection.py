"""The tool that measures detection: its options, its bounds, and a few drawn pictures."""

from __future__ import annotations

import importlib
import math
import sys
from pathlib import Path

import numpy as np
import pytest

TOOLS = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools"
NAMES = ("camera_stage", "check_detection", "detection_tally", "measurement")


@pytest.fixture(scope="module")
def tool():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield importlib.import_module("check_detection")
    for name in NAMES:
        sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def stage(tool):
    with tool.Stage("lab") as stage:
        yield stage


@pytest.fixture
def checks(tool, stage):
    return tool.Checks(stage, 2, 4, 5)


@pytest.mark.parametrize(
    "arguments, problem",
    [
        (["balls"], "no part balls"),
        (["--count", "0"], "--count is 0"),
        (["--frames", "-1"], "--frames is -1"),
        (["--keep", "/no/such/folder"], "which is no folder"),
    ],
)
def test_wrong_options_are_refused(tool, capsys, arguments, problem):
    with pytest.raises(SystemExit):
        tool.options(arguments)
    assert problem in capsys.readouterr().err


def test_every_part_can_be_chosen(tool):
    assert tool.options(list(tool.PARTS)).parts == list(tool.PARTS)
    assert all(callable(getattr(tool.Checks, part)) for part in tool.PARTS)


def test_points_are_where_the_viewpoint_says(tool):
    view = tool.Viewpoint((1.0, 2.0, 0.5), heading=math.pi / 2.0, pitch=0.3)
    place = view.at(1.5, 0.2, -0.1)
    assert np.linalg.norm(place - (1.0, 2.0, 0.5)) == pytest.approx(1.5)
    assert view.direction_of(place) == pytest.approx((0.2, -0.1))
    assert place[1] > 3.0 and place[0] < 1.0  # ahead is Y, and left of it is -X


@pytest.mark.parametrize(
    "tally, good",
    [
        (dict(wanted=10, found=10, bearings=[1.9], times=[0.0]), True),
        (dict(wanted=10, found=9, bearings=[0.1], times=[0.0]), False),
        (dict(wanted=10, found=10, wrong=1, bearings=[0.1], times=[0.0]), False),
        (dict(wanted=10, found=10, bearings=[0.1, 2.1], times=[0.0]), False),
    ],
)
def test_figures_are_judged_by_their_bounds(tool, checks, capsys, tally, good):
    checks._judge("things", tool.Tally(**tally))
    assert ("ok" in capsys.readouterr().out) == good
    assert checks.misses == ([] if good else ["things"])


@pytest.mark.parametrize("radius, distance", [(0.03, 0.3), (0.03, 2.0), (0.05, 1.0)])
def test_drawn_balls_are_found(tool, checks, radius, distance):
    tally = tool.Tally()
    checks._one_ball(tally, radius, distance, {})
    checks._one_ball(tally, radius, min(distance, 1.5), {}, cut=True)
    assert (tally.wanted, tally.found, tally.wrong) == (2, 2, 0)
    assert max(tally.bearings) < 0.5
    assert max(tally.distances) < 0.12


@pytest.mark.parametrize("distance, tilt", [(0.4, 0.0), (1.0, 40.0), (1.5, 40.0)])
def test_drawn_marks_are_read(tool, checks, distance, tilt):
    tally = tool.Tally()
    checks._one_mark(tally, distance, tilt, {})
    assert (tally.wanted, tally.found, tally.wrong) == (1, 1, 0)
    assert tally.bearings[0] < 0.5
    assert tally.distances[0] < 0.05


def test_drawn_codes_are_read(tool, checks):
    tally = tool.Tally()
    checks._one_code(tally, "qr", "nao_library", 0.5, tool.VGA)
    checks._one_code(tally, "barcode", "4006381333931", 0.4, tool.VGA)
    assert (tally.found, tally.wrong) == (2, 0)


def test_nothing_is_seen_in_the_lab_that_is_not_there(checks, capsys):
    checks.lab()
    assert capsys.readouterr().out.count("  ok") == 3
    assert checks.misses == []
