"""Cones through directions: exact ones, parts of them, and what is none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.vision.cone import fit_cone


def rim(axis, angle, turns):
    """Directions at `angle` around an axis."""
    axis = np.array(axis) / np.linalg.norm(axis)
    left = np.cross((0.0, 0.0, 1.0), axis)
    left /= np.linalg.norm(left)
    up = np.cross(axis, left)
    around = np.cos(turns)[:, None] * left + np.sin(turns)[:, None] * up
    return math.cos(angle) * axis + math.sin(angle) * around


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (1.0, 0.5, 0.0), (1.0, -0.4, 0.35)])
@pytest.mark.parametrize("angle", [0.01, 0.1, 0.35])
def test_a_whole_rim_gives_its_cone(axis, angle):
    cone = fit_cone(rim(axis, angle, np.linspace(0.0, 2.0 * math.pi, 40, endpoint=False)))
    assert cone.angle == pytest.approx(angle, rel=1e-6)
    assert cone.alpha == pytest.approx(math.atan(axis[1]), abs=1e-6)
    assert cone.beta == pytest.approx(-math.atan(axis[2]), abs=1e-6)
    assert cone.residual < 1e-7


def test_a_third_of_a_rim_is_enough():
    cone = fit_cone(rim((1.0, 0.3, 0.1), 0.15, np.linspace(1.0, 3.1, 25)))
    assert cone.angle == pytest.approx(0.15, rel=1e-4)
    assert cone.alpha == pytest.approx(math.atan(0.3), abs=1e-4)


def test_the_residual_is_how_far_directions_are_off():
    turns = np.linspace(0.0, 2.0 * math.pi, 60, endpoint=False)
    angles = 0.1 + 0.004 * np.where(np.arange(60) % 2 == 0, 1.0, -1.0)
    directions = np.concatenate([rim((1.0, 0.0, 0.0), angle, turns[i : i + 1]) for i, angle in enumerate(angles)])
    cone = fit_cone(directions)
    assert cone.angle == pytest.approx(0.1, abs=1e-4)
    assert cone.residual == pytest.approx(0.004, rel=0.01)


def test_few_directions_or_all_the_same_make_no_cone():
    directions = rim((1.0, 0.0, 0.0), 0.1, np.linspace(0.0, 1.0, 4))
    assert fit_cone(directions) is None
    assert fit_cone(np.tile((1.0, 0.0, 0.0), (9, 1))) is None
