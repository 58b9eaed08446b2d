"""The region of the centre of mass: the support polygon without its rim."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.balance_region import CORE, FRONT, MARGIN, balance_region, sole_corners

MODEL = load_model()
SQUARE = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.0, 0.2)]


def test_a_margin_is_kept_from_every_edge():
    region = balance_region(SQUARE)
    assert region.center == pytest.approx([0.2, 0.1])
    assert region.excess(region.center).max() == pytest.approx(MARGIN - 0.1)
    for corner in SQUARE:
        assert region.excess(np.array(corner)).max() == pytest.approx(MARGIN)


def test_points_inside_the_hull_do_not_matter():
    region = balance_region([*SQUARE, (0.1, 0.1), (0.2, 0.05)])
    assert region.center == pytest.approx([0.2, 0.1])
    assert len(region.limits) == 4


def test_of_a_narrow_support_a_core_is_left():
    region = balance_region([(0.0, 0.0), (0.4, 0.0), (0.4, 0.04), (0.0, 0.04)])
    assert -region.excess(region.center).max() == pytest.approx(CORE * 0.02)


@pytest.mark.parametrize("foot, side", [("LLeg", 1.0), ("RLeg", -1.0)])
def test_a_sole_is_where_its_foot_is(foot, side):
    pose = np.eye(4)
    pose[:2, 3] = (1.0, 2.0)
    corners = sole_corners(MODEL, foot, pose)
    expected = np.minimum(MODEL.sole_contour, (FRONT, 1.0)) * (1.0, side) + (1.0, 2.0)
    assert sorted(map(tuple, corners.round(6))) == sorted(map(tuple, expected.round(6)))
