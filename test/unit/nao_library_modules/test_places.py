"""Places on the floor: known values and round trips."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.places import Place

QUARTER = math.pi / 2


@pytest.mark.parametrize(
    "start, way, end",
    [
        (Place(0, 0, 0), Place(1, 2, 0.5), Place(1, 2, 0.5)),
        (Place(1, 1, QUARTER), Place(1, 0, 0), Place(1, 2, QUARTER)),
        (Place(1, 1, QUARTER), Place(0, 1, QUARTER), Place(0, 1, math.pi)),
        (Place(0, 0, 3.0), Place(0, 0, 1.0), Place(0, 0, 4.0 - 2 * math.pi)),
    ],
)
def test_a_way_leads_on_and_is_seen_from_where_it_began(start, way, end):
    reached = start.then(way)
    assert reached[:2] == pytest.approx(end[:2])
    assert math.cos(reached.yaw - end.yaw) == pytest.approx(1.0)
    assert reached.seen_from(start) == pytest.approx(way)


def test_the_way_back_leads_back():
    a, b = Place(0.3, -0.7, 2.0), Place(-1.0, 0.4, -2.5)
    assert a.then(b.seen_from(a)) == pytest.approx(b)
    assert Place(0, 0, 0).seen_from(a).then(a) == pytest.approx((0, 0, 0))
