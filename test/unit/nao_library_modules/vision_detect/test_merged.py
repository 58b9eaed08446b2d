"""Several pictures show a thing, and it is told once."""

from __future__ import annotations

import pytest

from nao_library_modules.vision_detect_events import FACE, Region, Sight
from nao_library_modules.vision_detect_space import Sighting, merged


def seen(key, name="", x=1.0, y=0.0):
    """A face: its number, what it is called, and where it is, m from the feet."""
    sight = Sight(FACE, name, key, 0.9, 0.0, 0.0, 0.1, 0.1)
    where = (x, y, 1.0)
    return Sighting(sight, 0, 1.0, Region(0.5, 0.5, 0.1, 0.1), 1.0, where, where, where, (0.0, 0.0, 0.5))


def told(pictures):
    return [(each.sight.name, each.looks) for each in merged(pictures)]


def test_a_face_that_is_counted_anew_is_still_one():
    pictures = [[seen("1")], [seen("1")], [seen("2", "anna", y=0.1)], [seen("2", "anna", y=0.12)]]
    assert told(pictures) == [("anna", 4)]


def test_two_people_in_one_picture_are_two_however_near_they_are():
    assert told([[seen("1", "anna"), seen("2", "ben", y=0.2)]] * 2) == [("anna", 2), ("ben", 2)]
    assert told([[seen("1"), seen("2", y=0.2)]]) == [("", 1), ("", 1)]


@pytest.mark.parametrize("name, y", [("ben", 0.1), ("anna", 1.0)])
def test_another_name_or_another_place_is_somebody_else(name, y):
    assert len(merged([[seen("1", "anna")], [seen("2", name, y=y)]])) == 2


def test_who_is_known_comes_first_then_who_was_seen_most_often():
    pictures = [[seen("1", x=3.0)], [seen("2", x=2.0)], [seen("2", x=2.0)], [seen("3", "anna")]]
    assert told(pictures) == [("anna", 1), ("", 2), ("", 1)]
