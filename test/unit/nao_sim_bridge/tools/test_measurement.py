"""What the programs that measure the robot's sight have in common."""

from __future__ import annotations

import importlib
import sys
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest

TOOLS = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools"


@pytest.fixture(scope="module")
def tool():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield importlib.import_module("measurement")
    for name in ("camera_stage", "measurement"):
        sys.modules.pop(name, None)


@pytest.mark.parametrize(
    "good, mark, status",
    [
        (True, "  ok", 0),
        (np.bool_(True), "  ok", 0),
        (None, "", 0),
        (False, "  MISSED", 1),
        (np.bool_(False), "  MISSED", 1),
    ],
)
def test_a_figure_that_misses_its_bound_is_told_and_makes_the_status(tool, capsys, good, mark, status):
    class Checks(tool.StageChecks):
        def found(self):
            self._tell("faces", "found 0.90", good)

    assert tool.measure(nullcontext(None), lambda stage: Checks(stage, 1, 1, seed=1), ["found"]) == status
    first, *misses = capsys.readouterr().out.splitlines()
    assert first.endswith(f"found 0.90{mark}")
    assert misses == ["misses its bound: faces"] * status


def test_looks_go_from_the_middle_of_the_room_in_all_directions(tool):
    checks = tool.StageChecks(None, 1, 1, seed=1)
    views = [checks._anywhere() for _ in range(200)]
    places = np.array([view.position for view in views])
    assert (places > (-1.2, -1.6, 0.25)).all() and (places < (0.4, 1.6, 0.5)).all()
    assert np.ptp([view.heading for view in views]) > 6.0
