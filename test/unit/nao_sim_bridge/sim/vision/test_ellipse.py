"""Ellipses from outlines, and where perspective puts the points of a slanted circle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.optics import Intrinsics
from nao_sim_bridge.sim.vision.ellipse import Ellipse, distance_from, ellipse_of

TURNS = np.linspace(0.0, 2.0 * math.pi, 40, endpoint=False)
EDGE = np.array((1.0,))


def outline(center, long, short, turn):
    around = np.stack([long * np.cos(TURNS), short * np.sin(TURNS)], axis=1)
    c, s = math.cos(turn), math.sin(turn)
    return np.asarray(center) + around @ np.array(((c, s), (-s, c)))


@pytest.mark.parametrize("turn", [0.0, 0.4, 1.5, -0.8])
def test_an_outline_gives_its_ellipse(turn):
    points = outline((60.0, 40.0), 20.0, 12.0, turn)
    ellipse = ellipse_of(points.astype(np.float32))
    assert ellipse.center == pytest.approx((60.0, 40.0), abs=1e-3)
    assert ellipse.radii == pytest.approx((20.0, 12.0), abs=0.01)
    assert ellipse.half_extent == pytest.approx(np.ptp(points, axis=0) / 2.0, rel=0.02)
    assert np.abs(distance_from(ellipse, points)).max() < 0.01
    assert np.abs(distance_from(ellipse, ellipse.points(TURNS, EDGE)[:, 0])).max() < 1e-6


def test_distances_are_positive_outside():
    ellipse = Ellipse(np.zeros(2), np.diag((20.0, 10.0)))
    assert distance_from(ellipse, np.array(((23.0, 0.0), (0.0, 8.0)))) == pytest.approx((3.0, -2.0))


def test_too_few_points_make_no_ellipse():
    assert ellipse_of(np.float32([[0, 0], [1, 0], [0, 1]])) is None


def test_angles_run_clockwise_from_the_top():
    circle = Ellipse(np.array((10.0, 10.0)), np.diag((5.0, 5.0)))
    top, right = circle.points(np.array((0.0, math.pi / 2.0)), EDGE)[:, 0]
    assert top == pytest.approx((10.0, 5.0))
    assert right == pytest.approx((15.0, 10.0))


@pytest.mark.parametrize("yaw", [0.0, 0.5, -0.8])
@pytest.mark.parametrize("aside", [-0.15, 0.0, 0.2])
def test_a_slant_moves_the_inside_of_a_near_circle_as_perspective_does(yaw, aside):
    # A circle of 5 cm radius, 40 cm ahead, turned about the vertical.
    lens, radius, distance = Intrinsics(300.0, 300.0, 160.0, 120.0), 0.05, 0.4
    circle = np.stack([radius * np.sin(TURNS), -radius * np.cos(TURNS)], axis=1)

    def seen(points):
        x, depth = aside + points[:, 0] * math.cos(yaw), distance + points[:, 0] * math.sin(yaw)
        places = np.stack([lens.fx * x, lens.fy * (points[:, 1] + 0.5 * aside)], axis=1) / depth[:, None]
        return places + (lens.cx, lens.cy)

    ellipse = ellipse_of(seen(circle).astype(np.float32))
    middle = seen(np.zeros((1, 2)))[0]
    off, slant = min(
        ((np.linalg.norm(ellipse.center + ellipse.shape @ side - middle), tuple(side)) for side in ellipse.slants(lens))
    )
    assert off < 0.1
    # Half way out: on the picture of the circle of half the radius.
    inner = ellipse.points(TURNS, np.array((0.5,)), np.array(slant))[:, 0]
    fine = np.linspace(0.0, 2.0 * math.pi, 2000)
    wanted = seen(0.5 * radius * np.stack([np.sin(fine), -np.cos(fine)], axis=1))
    assert np.linalg.norm(inner[:, None] - wanted[None], axis=2).min(axis=1).max() < 0.15
