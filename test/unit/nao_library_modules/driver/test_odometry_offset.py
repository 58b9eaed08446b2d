"""Odometry that is paused, moved and set."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.odometry_offset import OdometryOffset
from nao_library_modules.places import Place
from naoqi.errors import NaoError

QUARTER = math.pi / 2
TORSO = (1.0, 2.0, 0.33, 0.02, -0.03, QUARTER)


class Odometry(OdometryOffset):
    """Tells the torso alone, and the jumps apart.

    Attributes:
        jumps: How many there were.
    """

    def correct(self, torso):
        corrected, self.jumps = super().correct(torso)
        return corrected


@pytest.fixture
def offset():
    return Odometry()


def moved(torso, way):
    """The torso of the robot's own odometry after a way in its own frame."""
    place = Place(torso[0], torso[1], torso[5]).then(way)
    return (place.x, place.y, *torso[2:5], place.yaw)


def test_without_an_offset_odometry_is_that_of_the_robot(offset):
    assert offset.correct(TORSO) == pytest.approx(TORSO)
    assert offset.jumps == 0


def test_a_set_pose_holds_at_once_and_ways_go_on_from_there(offset):
    offset.correct(TORSO)
    offset.set(Place(5.0, -1.0, 0.0))
    assert offset.correct(TORSO) == pytest.approx((5.0, -1.0, 0.33, 0.02, -0.03, 0.0))
    after = offset.correct(moved(TORSO, Place(0.5, 0.1, 0.2)))
    assert after == pytest.approx((5.5, -0.9, 0.33, 0.02, -0.03, 0.2))


def test_an_offset_is_told_in_the_frame_of_the_torso_and_adds_up(offset):
    offset.correct(TORSO)
    offset.move_by(Place(0.5, 0.0, QUARTER))  # it looks along Y
    assert offset.correct(TORSO) == pytest.approx((1.0, 2.5, 0.33, 0.02, -0.03, math.pi))
    offset.move_by(Place(0.5, 0.0, 0.0))
    assert offset.correct(TORSO)[:2] == pytest.approx((0.5, 2.5))
    assert offset.jumps == 2


def test_while_paused_it_stands_still_but_for_height_and_tilt(offset):
    offset.correct(TORSO)
    offset.pause()
    carried = list(moved(TORSO, Place(3.0, 1.0, 1.0)))
    carried[2:5] = 0.6, 0.5, 0.4
    assert offset.correct(carried) == pytest.approx((1.0, 2.0, 0.6, 0.5, 0.4, QUARTER))
    offset.resume()
    assert offset.correct(carried) == pytest.approx((1.0, 2.0, 0.6, 0.5, 0.4, QUARTER))
    assert offset.correct(moved(carried, Place(0.1, 0.0, 0.0)))[:2] == pytest.approx((1.0, 2.1))
    assert offset.jumps == 0


def test_it_may_be_set_while_paused_and_paused_twice(offset):
    offset.correct(TORSO)
    offset.pause()
    offset.pause()
    offset.set(Place(0.0, 0.0, 0.0))
    assert offset.correct(moved(TORSO, Place(9.0, 9.0, 1.0)))[:2] == pytest.approx((0.0, 0.0))
    assert offset.paused
    offset.resume()
    assert not offset.paused


@pytest.mark.parametrize(
    "change", [lambda o: o.set(Place(0, 0, 0)), lambda o: o.move_by(Place(0, 0, 0)), lambda o: o.pause()]
)
def test_before_the_first_reading_there_is_nothing_to_change(offset, change):
    with pytest.raises(NaoError, match="no odometry"):
        change(offset)
