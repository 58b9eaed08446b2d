"""Places on the floor, and head angles for looking at points."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_library_modules.core.geometry import ORIGIN, Place, wrapped, yaw_of_quaternion
from nao_library_modules.core.nao_facts import load_head, look_at

HEAD = load_head()
QUARTER = math.pi / 2
lengths = st.floats(-5.0, 5.0)
places = st.builds(Place, lengths, lengths, st.floats(-3.0, 3.0))


def test_a_way_is_told_in_the_frame_of_where_it_begins():
    assert Place(1.0, 2.0, QUARTER).then(Place(0.5, 0.0, 0.1)) == pytest.approx((1.0, 2.5, QUARTER + 0.1))


@given(places, places)
@settings(max_examples=50)
def test_the_way_from_here_to_there_leads_there_and_back(here, there):
    x, y, yaw = here.then(there.seen_from(here))
    assert (x, y) == pytest.approx(there[:2], abs=1e-9) and wrapped(yaw - there[2]) == pytest.approx(0.0, abs=1e-9)
    assert here.then(here.inverse()) == pytest.approx(ORIGIN, abs=1e-9)


def test_angles_are_wrapped_to_half_a_turn_and_headings_read_from_quaternions():
    for angle, same in ((0.0, 0.0), (math.pi, math.pi), (-math.pi, math.pi), (4.0, 4.0 - 2 * math.pi)):
        assert wrapped(angle) == pytest.approx(same)
    assert wrapped(-7.0) == pytest.approx(-7.0 + 2 * math.pi)
    for length in (1.0, 2.0):
        assert yaw_of_quaternion(0.0, 0.0, length * math.sin(0.4), length * math.cos(0.4)) == pytest.approx(0.8)
    assert yaw_of_quaternion(0.0, math.sin(0.1), 0.0, math.cos(0.1)) == pytest.approx(0.0)
    assert yaw_of_quaternion(0.0, 0.0, 0.0, 0.0) is yaw_of_quaternion(0.0, 0.0, math.nan, 1.0) is None


def test_left_is_positive_yaw_down_is_positive_pitch_and_a_point_in_the_head_is_refused():
    camera = HEAD.cameras["CameraTop"]
    assert look_at(HEAD, camera, (1000.0, 0.0, HEAD.height)) == pytest.approx((0.0, -camera.down), abs=1e-3)
    assert look_at(HEAD, camera, (1.0, 1.0, 0.0))[0] == pytest.approx(math.pi / 4)
    assert look_at(HEAD, camera, (1.0, 0.0, -0.5))[1] > look_at(HEAD, camera, (1.0, 0.0, 0.5))[1]
    with pytest.raises(ValueError, match="inside the head"):
        look_at(HEAD, camera, (0.01, 0.0, HEAD.height))
