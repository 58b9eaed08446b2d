"""Sonars: what echoes, and how strong."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.body.sensors import sonar
from nao_sim_bridge.body.sensors.sonar import FARTHEST, NEAREST, NO_ECHO, Sonars, Surface
from nao_sim_bridge.model.model_reader import load_model

MODEL = load_model()
HEIGHT = 0.33
STANDING = Pose((0.0, 0.0, HEIGHT), (0.0, 0.0, 0.0, 1.0))
LEFT, RIGHT = (tuple(s.position + (0.0, 0.0, HEIGHT)) for s in MODEL.sonars)
SILENCE = (NO_ECHO, NO_ECHO)
# A zone that echoes in phase is never larger than this, m.
LARGE = (1.0, 1.0)


class Points:
    """Surfaces at places in world, all as large as a wall unless told otherwise."""

    def __init__(self, *places, extents=LARGE, hidden=()):
        self.places, self.size, self.hidden = list(places), extents, set(hidden)

    def surfaces(self, place, ahead, reach):
        return [Surface(point, body) for body, point in enumerate(self.places)]

    def extents(self, surface, sight):
        return self.size

    def visible(self, places, surfaces):
        return [surface.body not in self.hidden for surface in surfaces]


def off_axis(side, distance, degrees):
    """A place to the side of the axis of a sonar."""
    (x, y, z), yaw = (LEFT, RIGHT)[side], MODEL.sonars[side].rpy[2] + math.radians(degrees)
    down = distance * math.sin(MODEL.sonars[side].rpy[1])
    return x + distance * math.cos(yaw), y + distance * math.sin(yaw), z - down


def heard(*places, at=STANDING, **world):
    return Sonars(MODEL, Points(*places, **world)).read(0.0, at)


@pytest.mark.parametrize("distance", [0.1, 0.3, 1.0, 2.0, 2.5])
def test_the_distance_is_that_of_the_surface(distance):
    side = math.hypot(distance, LEFT[1])
    assert heard((LEFT[0] + distance, 0.0, LEFT[2])) == pytest.approx((side, side))


def test_what_is_out_of_reach_hidden_or_on_the_floor_is_not_heard():
    near, far = (0.5, 0.0, 0.39), (1.5, 0.0, 0.39)
    assert heard(near, far, hidden=[0]) == pytest.approx((1.495, 1.495), abs=0.001)
    assert heard() == heard((FARTHEST + 0.1, 0.0, 0.39)) == heard((0.0, 0.0, 0.0)) == SILENCE
    assert heard(LEFT)[0] == NEAREST, "right at the sensor is not zero"


def test_the_nearest_of_several_echoes_counts_and_the_others_are_kept():
    sonars = Sonars(MODEL, Points((1.5, 0.0, 0.39), (0.8, 0.0, 0.39), (0.81, 0.0, 0.39)))
    assert sonars.read(0.0, STANDING) == pytest.approx((0.795, 0.795), abs=0.001)
    # The third comes within one pulse of the first.
    assert sonars.echoes[0] == pytest.approx((0.795, 1.495), abs=0.001)


@pytest.mark.parametrize("side, away", [(0, 10), (1, -10)])
def test_the_beam_is_widest_near_by_and_the_sides_are_told_apart(side, away):
    def widest(distance):
        return max((a for a in range(60) if heard(off_axis(side, distance, a))[side] < NO_ECHO), default=-1)

    near, closer, middle, far = (widest(distance) for distance in (0.3, 0.6, 1.2, 2.5))
    # The cone that is stated holds for what is a metre and a half away.
    assert near > closer > middle >= math.degrees(sonar.HALF_CONE) > far > 20
    assert heard(off_axis(side, 0.6, away))[1 - side] == NO_ECHO


def test_a_wall_is_heard_as_far_as_they_reach_and_small_things_near_by_only():
    spread, pole = sonar.spread, (0.02, 0.8)
    assert spread(FARTHEST, math.radians(22.6)) < sonar.BUDGET < spread(FARTHEST, math.radians(25.0))
    assert heard((0.6, 0.0, 0.39), extents=pole) != SILENCE == heard((1.5, 0.0, 0.39), extents=pole)
    assert sonar.smallness(1.0, LARGE) == 0.0 < sonar.smallness(1.0, pole) < sonar.smallness(2.0, pole)


def test_they_measure_ten_times_a_second_and_keep_the_reading_in_between():
    around = Points((0.5, 0.0, 0.39))
    sonars = Sonars(MODEL, around)
    first = sonars.read(0.0, STANDING)
    around.places = [(1.0, 0.0, 0.39)]
    assert sonars.read(0.05, STANDING) == first
    assert sonars.read(0.1, STANDING) == pytest.approx((0.995, 0.995), abs=0.001)
