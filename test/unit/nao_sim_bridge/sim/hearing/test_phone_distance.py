"""How different rows of phones sound."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.hearing.phone_distance import difference, distance


@pytest.mark.parametrize(
    "one, other, wanted",
    [
        ("Y EH S", "Y EH S", 0.0),
        ("R EH D", "B R EH D", 1.0),
        ("B R EH D", "R EH D", 1.0),
        ("P L IY Z", "P L EY Z", 0.6),
        ("F AY V", "F AY F", 0.5),
        ("N OW", "S T AA P", 3.6),
        ("", "HH EH L P", 4.0),
        ("", "", 0.0),
    ],
)
def test_the_cheapest_changes_count(one, other, wanted):
    assert distance(one.split(), other.split()) == pytest.approx(wanted)
    assert distance(other.split(), one.split()) == pytest.approx(wanted)


@pytest.mark.parametrize("one, other, wanted", [("S", "S", 0.0), ("S", "Z", 0.5), ("AA", "IY", 0.6), ("S", "AA", 1.0)])
def test_phones_that_are_alike_differ_less(one, other, wanted):
    assert difference(one, other) == difference(other, one) == wanted
