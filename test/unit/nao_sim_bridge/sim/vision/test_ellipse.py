"""Ellipses from outlines, and where perspective puts the points of a slanted circle."""

from __future__ import annotations

import math

import numpy as np
import pytest

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


@pytest.mark.parametrize("yaw", [0.5, -0.8])
def test_a_slant_moves_the_middle_of_a_near_circle_as_perspective_does(yaw):
    # A circle of 5 cm radius, 40 cm ahead, turned about the vertical: focal length 300 pixels.
    focal, radius, distance = 300.0, 0.05, 0.4
    circle = np.stack([radius * np.sin(TURNS), -radius * np.cos(TURNS)], axis=1)

    def seen(points):
        x, depth = points[:, 0] * math.cos(yaw), distance + points[:, 0] * math.sin(yaw)
        return focal * np.stack([x, points[:, 1]], axis=1) / depth[:, None]

    ellipse = ellipse_of(seen(circle).astype(np.float32))
    slant = ellipse.slant(focal)
    nearest = min(
        (ellipse.points(TURNS, np.array((0.6,)), side)[:, 0] for side in (slant, -slant)),
        key=lambda places: np.abs(places - seen(0.6 * circle)).max(),
    )
    flat = ellipse.points(TURNS, np.array((0.6,)))[:, 0]
    assert np.abs(nearest - seen(0.6 * circle)).max() < 0.15
    assert np.abs(flat - seen(0.6 * circle)).max() > 1.0
