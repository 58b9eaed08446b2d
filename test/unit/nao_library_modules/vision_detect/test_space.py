"""Where things are whose place and size in the picture are known, against what projection says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fake_seeing import HFOV, VFOV

from nao_library_modules.vision_detect_events import LANDMARK, Lens, Region, Sight
from nao_library_modules.vision_detect_space import located

LENS = Lens(HFOV, VFOV)
HERE = (0.0,) * 6


def drawn(points):
    """Region of points (n, 3) of the camera's frame in the picture: X along its axis, Y left, Z up."""
    x = 0.5 - points[:, 1] / points[:, 0] / math.tan(HFOV / 2) / 2
    y = 0.5 - points[:, 2] / points[:, 0] / math.tan(VFOV / 2) / 2
    return Region((x.max() + x.min()) / 2, (y.max() + y.min()) / 2, np.ptp(x), np.ptp(y))


def disc(centre, normal, radius):
    """Points of a circle around a point, (n, 3), m."""
    normal = np.asarray(normal, dtype=float) / np.linalg.norm(normal)
    left = np.cross([0.0, 0.0, 1.0], normal)
    left /= np.linalg.norm(left)
    up = np.cross(normal, left)
    turns = np.linspace(0.0, 2.0 * math.pi, 720)[:, None]
    return np.asarray(centre) + radius * (np.cos(turns) * left + np.sin(turns) * up)


@pytest.mark.parametrize("tilt", ["to the camera", "along the wall", "turned aside", "lying back"])
@pytest.mark.parametrize("centre", [(1.0, 0.0, 0.0), (1.0, 0.4, 0.0), (0.8, -0.35, 0.2), (1.4, 0.3, -0.4)])
def test_a_landmark_is_where_it_is_however_it_hangs(centre, tilt):
    normal = {
        "to the camera": [-value for value in centre],
        "along the wall": (-1.0, 0.0, 0.0),
        "turned aside": (-math.cos(0.5) * centre[0], math.sin(0.5) - centre[1], -centre[2]),
        "lying back": (-math.cos(0.5) * centre[0], -centre[1], math.sin(0.5) - centre[2]),
    }[tilt]
    region = drawn(disc(centre, normal, 0.046))
    sizes = [
        2 * math.atan(region.width * math.tan(HFOV / 2)),
        2 * math.atan(region.height * math.tan(VFOV / 2)),
    ]
    sight = Sight(LANDMARK, "64", "64", 1.0, 0.0, 0.0, *sizes)
    seen = located(sight, 0, 1.0, region, LENS, 0.092, HERE, HERE)
    assert seen.distance == pytest.approx(math.hypot(*centre), rel=0.035)
    assert seen.in_robot == pytest.approx(centre, abs=0.035 * math.hypot(*centre))
