"""Sonars: what echoes, how strong, and when they measure."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.sensors.sonar import (
    BUDGET,
    FARTHEST,
    HALF_CONE,
    NEAREST,
    NO_ECHO,
    PERIOD,
    Sonars,
    Surface,
    smallness,
    spread,
)
from nao_sim_bridge.sim.settings import load_settings

MODEL = load_model()
HEIGHT = 0.33
STANDING = Pose((0.0, 0.0, HEIGHT), (0.0, 0.0, 0.0, 1.0))
LEFT, RIGHT = (tuple(s.position + (0.0, 0.0, HEIGHT)) for s in MODEL.sonars)
# A zone that echoes in phase is never larger than this, m.
LARGE = (1.0, 1.0)


class Points:
    """Surfaces at places in world, all as large as a wall."""

    def __init__(self, *places, extents=LARGE, hidden=()):
        self.places, self.size, self.hidden = list(places), extents, set(hidden)
        self.asked = 0

    def surfaces(self, place, ahead, reach):
        self.asked += 1
        return [Surface(point, body) for body, point in enumerate(self.places)]

    def extents(self, surface, sight):
        return self.size

    def visible(self, places, surfaces):
        return [surface.body not in self.hidden for surface in surfaces]


def off_axis(sonar, distance, degrees):
    """A place to the side of the axis of a sonar."""
    origin, yaw = (LEFT, RIGHT)[sonar], MODEL.sonars[sonar].rpy[2] + math.radians(degrees)
    pitch = MODEL.sonars[sonar].rpy[1]
    return (
        origin[0] + distance * math.cos(yaw),
        origin[1] + distance * math.sin(yaw),
        origin[2] - distance * math.sin(pitch),
    )


def heard(*places, **world):
    return Sonars(MODEL, Points(*places, **world)).read(0.0, STANDING)


def test_nothing_around_reads_as_no_echo():
    assert heard() == (NO_ECHO, NO_ECHO)


@pytest.mark.parametrize("distance", [0.1, 0.3, 1.0, 2.0, 2.5])
def test_the_distance_is_that_of_the_surface(distance):
    left, right = heard((LEFT[0] + distance, 0.0, LEFT[2]))
    side = math.hypot(distance, LEFT[1])
    assert (left, right) == pytest.approx((side, side))


def test_the_nearest_of_several_echoes_counts_and_the_others_are_kept():
    sonars = Sonars(MODEL, Points((1.5, 0.0, 0.39), (0.8, 0.0, 0.39), (0.81, 0.0, 0.39)))
    first = sonars.read(0.0, STANDING)
    assert first == pytest.approx((0.795, 0.795), abs=0.001)
    # The third comes within one pulse of the first.
    assert sonars.echoes[0] == pytest.approx((0.795, 1.495), abs=0.001)


def test_what_something_else_hides_is_not_heard():
    assert heard((0.5, 0.0, 0.39), (1.5, 0.0, 0.39), hidden=[0]) == pytest.approx((1.495, 1.495), abs=0.001)


def test_something_right_at_the_sensor_is_not_zero():
    assert heard(LEFT)[0] == NEAREST


def test_beyond_their_reach_they_hear_nothing():
    assert heard((FARTHEST + 0.1, 0.0, 0.39)) == (NO_ECHO, NO_ECHO)


def test_the_floor_below_is_not_heard():
    assert heard((0.0, 0.0, 0.0)) == (NO_ECHO, NO_ECHO)


@pytest.mark.parametrize("sonar", [0, 1])
def test_the_beam_is_widest_near_by(sonar):
    def widest(distance):
        angles = range(60)
        return max((a for a in angles if heard(off_axis(sonar, distance, a))[sonar] < NO_ECHO), default=-1)

    at = {distance: widest(distance) for distance in (0.3, 0.6, 1.2, 2.5)}
    assert at[0.3] > at[0.6] > at[1.2] > at[2.5]
    # The cone that is stated holds for what is a metre and a half away.
    assert at[1.2] >= math.degrees(HALF_CONE) > at[2.5] > 20


def test_left_and_right_are_told_apart():
    assert heard(off_axis(0, 0.6, 10))[1] == NO_ECHO
    assert heard(off_axis(1, 0.6, -10))[0] == NO_ECHO


def test_a_wall_ahead_is_heard_by_both_as_far_as_they_reach():
    assert spread(FARTHEST, math.radians(22.6)) < BUDGET < spread(FARTHEST, math.radians(25.0))


def test_small_things_are_heard_near_by_only():
    pole = (0.02, 0.8)
    assert heard((0.6, 0.0, 0.39), extents=pole) != (NO_ECHO, NO_ECHO)
    assert heard((1.5, 0.0, 0.39), extents=pole) == (NO_ECHO, NO_ECHO)
    assert smallness(1.0, LARGE) == 0.0 < smallness(1.0, pole) < smallness(2.0, pole)


def test_they_turn_with_the_robot():
    turned = Pose((1.0, 2.0, HEIGHT), from_roll_pitch_yaw(0.0, 0.0, math.pi / 2))
    sonars = Sonars(MODEL, Points((1.0, 3.0, LEFT[2])))
    assert sonars.read(0.0, turned) == pytest.approx((0.995, 0.995), abs=0.001)
    assert Sonars(MODEL, Points((2.0, 2.0, LEFT[2]))).read(0.0, turned) == (NO_ECHO, NO_ECHO)


def test_it_measures_ten_times_a_second_of_simulated_time():
    tick, around = load_settings().tick_s, Points()
    sonars, measured = Sonars(MODEL, around), []
    for n in range(round(20.0 / tick)):
        before = around.asked
        sonars.read(n * tick, STANDING)
        if around.asked > before:
            measured.append(n)
    assert {later - earlier for earlier, later in zip(measured, measured[1:])} == {round(PERIOD / tick)}


def test_between_measurements_the_last_reading_stays():
    around = Points((0.5, 0.0, 0.39))
    sonars = Sonars(MODEL, around)
    first = sonars.read(0.0, STANDING)
    around.places = [(1.0, 0.0, 0.39)]
    assert sonars.read(0.05, STANDING) == first
    assert sonars.read(0.1, STANDING) == pytest.approx((0.995, 0.995), abs=0.001)


def test_after_a_reset_it_measures_at_once():
    around = Points((0.5, 0.0, 0.39))
    sonars = Sonars(MODEL, around)
    sonars.read(0.0, STANDING)
    sonars.reset()
    around.places = [(1.0, 0.0, 0.39)]
    assert sonars.read(0.01, STANDING) == pytest.approx((0.995, 0.995), abs=0.001)


def test_each_measurement_has_echoes_of_its_own_also_when_they_are_equal():
    for around in (Points(), Points((0.5, 0.0, 0.39))):
        sonars, echoes = Sonars(MODEL, around), []
        for now in (0.0, 0.05, 0.1):
            sonars.read(now, STANDING)
            echoes.append(sonars.echoes)
        first, between, second = echoes
        assert between is first and second is not first and second == first
