"""Soft shapes lie where they should, and change nothing else."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.painting.canvas import Canvas, arch, grain

RED = (1.0, 0.0, 0.0)


@pytest.fixture
def canvas():
    return Canvas(80, 60, 20.0, (40.0, 30.0), (0.5, 0.5, 0.5))


def middle(canvas, mask):
    return (canvas.x * mask).sum() / mask.sum(), (canvas.y * mask).sum() / mask.sum()


def test_the_canvas_has_x_to_the_right_and_y_upwards(canvas):
    assert canvas.x[0, 0] == pytest.approx(-1.975) and canvas.x[0, -1] == pytest.approx(1.975)
    assert canvas.y[0, 0] == pytest.approx(1.475) and canvas.y[-1, 0] == pytest.approx(-1.475)


@pytest.mark.parametrize("soft", [0.0, 0.8])
def test_an_ellipse_has_its_place_and_its_area(canvas, soft):
    mask = canvas.ellipse(0.5, -0.3, 0.8, 0.4, 0.6, soft)
    assert middle(canvas, mask) == pytest.approx((0.5, -0.3), abs=0.01)
    assert mask.sum() / 400.0 == pytest.approx(math.pi * 0.8 * 0.4, rel=0.08)
    assert mask.min() >= 0.0 and mask.max() <= 1.0


def test_an_ellipse_is_tilted_against_the_clock(canvas):
    mask = canvas.ellipse(0.0, 0.0, 1.0, 0.2, math.pi / 4.0)
    assert mask[np.argmin(np.abs(canvas.y[:, 0] - 0.5)), np.argmin(np.abs(canvas.x[0] - 0.5))] == 1.0
    assert mask[np.argmin(np.abs(canvas.y[:, 0] + 0.5)), np.argmin(np.abs(canvas.x[0] - 0.5))] == 0.0


def test_a_stroke_goes_through_its_points_with_its_widths(canvas):
    mask = canvas.stroke([(-1.0, 0.0), (1.0, 0.0)], (0.1, 0.3))
    across = mask.sum(axis=0) / 20.0
    for x, width in ((-0.5, 0.3), (0.5, 0.5)):
        assert across[np.argmin(np.abs(canvas.x[0] - x))] == pytest.approx(width, abs=0.06)


def test_what_is_outside_of_the_canvas_leaves_no_trace(canvas):
    canvas.lay(canvas.ellipse(9.0, 9.0, 0.5, 0.5), RED)
    canvas.lay(canvas.stroke([(5.0, 5.0), (6.0, 5.0)], (0.1, 0.1)), RED)
    assert np.unique(canvas.pixels()).tolist() == [128]


def test_colours_are_laid_on_and_shades_change_what_is_there(canvas):
    canvas.lay(canvas.inside(canvas.x), RED, 0.5)
    assert canvas.rgb[30, -1].tolist() == pytest.approx([0.75, 0.25, 0.25])
    canvas.shade(canvas.inside(canvas.x), 0.5)
    assert canvas.rgb[30, -1].tolist() == pytest.approx([0.375, 0.125, 0.125])
    assert canvas.rgb[30, 0].tolist() == [0.5, 0.5, 0.5]


def test_an_arch_has_its_middle_and_its_ends():
    points = arch(2.0, 1.0, -1.0)
    assert points[0] == (-2.0, -1.0) and points[4] == (0.0, 1.0) and points[-1] == (2.0, -1.0)


def test_grain_is_repeatable_and_about_nothing_in_the_mean():
    first = grain((60, 80), 3, (4, 6))
    assert np.array_equal(first, grain((60, 80), 3, (4, 6)))
    assert first.shape == (60, 80) and abs(first.mean()) < 0.1 and 0.2 < first.std() < 0.6
    assert not np.array_equal(first, grain((60, 80), 4, (4, 6)))
