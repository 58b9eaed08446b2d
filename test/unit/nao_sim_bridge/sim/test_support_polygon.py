"""How far points are outside a convex polygon."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.support_polygon import outside

SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
DIAGONAL = math.sqrt(0.5)


@pytest.mark.parametrize(
    "point, distance, way",
    [
        ((1.5, 1.0), -0.5, (1, 0)),
        ((1.0, 0.1), -0.1, (0, -1)),
        ((3.0, 1.0), 1.0, (1, 0)),
        ((1.0, -0.5), 0.5, (0, -1)),
        ((3.0, 3.0), math.sqrt(2.0), (DIAGONAL, DIAGONAL)),
        ((-1.0, 3.0), math.sqrt(2.0), (-DIAGONAL, DIAGONAL)),
    ],
)
def test_distance_and_the_shortest_way_out(point, distance, way):
    found, direction = outside(SQUARE, point)
    assert found == pytest.approx(distance)
    assert direction == pytest.approx(way)


def test_the_edge_itself_is_not_outside():
    assert outside(SQUARE, (2.0, 0.5)) == (pytest.approx(0.0), pytest.approx((1.0, 0.0)))
