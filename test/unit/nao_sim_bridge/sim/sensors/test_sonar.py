"""Sonars: a cone of rays each, at their own rate."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.sensors.sonar import HALF_CONE, NEAREST, NO_ECHO, PERIOD, Sonars
from nao_sim_bridge.sim.settings import load_settings

MODEL = load_model()
STANDING = Pose((0.0, 0.0, 0.33), (0.0, 0.0, 0.0, 1.0))


@pytest.fixture
def sonars():
    return Sonars(MODEL)


class Surroundings:
    """Answers rays with the nearest of some shares, and remembers them."""

    def __init__(self, *shares):
        self.shares = shares or (1.0,)
        self.rays = []

    def __call__(self, start, ends):
        self.rays.append((start, list(ends)))
        return [self.shares[i % len(self.shares)] for i in range(len(ends))]


def test_nothing_around_reads_as_no_echo(sonars):
    assert sonars.read(0.0, STANDING, Surroundings()) == (NO_ECHO, NO_ECHO)


def test_the_nearest_echo_counts(sonars):
    assert sonars.read(0.0, STANDING, Surroundings(1.0, 0.3, 0.1)) == pytest.approx((0.5, 0.5))


def test_something_right_at_the_sensor_is_not_zero(sonars):
    assert sonars.read(0.0, STANDING, Surroundings(0.0)) == (NEAREST, NEAREST)


def test_rays_fill_a_cone_round_the_axis_of_each_sensor(sonars):
    around = Surroundings()
    sonars.read(0.0, STANDING, around)
    for (start, ends), sensor in zip(around.rays, MODEL.sonars):
        assert start == pytest.approx(tuple(sensor.position + (0.0, 0.0, 0.33)))
        axis = [b - a for a, b in zip(start, ends[0])]
        assert math.atan2(axis[1], axis[0]) == pytest.approx(sensor.rpy[2], abs=0.01)
        angles = []
        for end in ends:
            ray = [b - a for a, b in zip(start, end)]
            assert math.hypot(*ray) == pytest.approx(NO_ECHO)
            cosine = sum(a * b for a, b in zip(axis, ray)) / NO_ECHO**2
            angles.append(math.acos(min(1.0, cosine)))
        assert max(angles) == pytest.approx(HALF_CONE)
        assert angles[0] == 0.0


def test_rays_turn_with_the_robot(sonars):
    around = Surroundings()
    sonars.read(0.0, Pose((1.0, 2.0, 0.33), from_roll_pitch_yaw(0.0, 0.0, math.pi / 2)), around)
    (start, ends), _ = around.rays
    position, yaw = MODEL.sonars[0].position, MODEL.sonars[0].rpy[2]
    assert start[:2] == pytest.approx((1.0 - position[1], 2.0 + position[0]))
    ray = [b - a for a, b in zip(start, ends[0])]
    assert math.atan2(ray[1], ray[0]) == pytest.approx(math.pi / 2 + yaw, abs=0.01)


def test_it_measures_ten_times_a_second_of_simulated_time(sonars):
    tick = load_settings().tick_s
    measured = []
    for n in range(round(20.0 / tick)):
        around = Surroundings()
        sonars.read(n * tick, STANDING, around)
        if around.rays:
            measured.append(n)
    assert {later - earlier for earlier, later in zip(measured, measured[1:])} == {round(PERIOD / tick)}


def test_between_measurements_the_last_reading_stays(sonars):
    sonars.read(0.0, STANDING, Surroundings(0.1))
    assert sonars.read(0.05, STANDING, Surroundings(0.2)) == pytest.approx((0.5, 0.5))
    assert sonars.read(0.1, STANDING, Surroundings(0.2)) == pytest.approx((1.0, 1.0))


def test_after_a_reset_it_measures_at_once(sonars):
    sonars.read(0.0, STANDING, Surroundings(0.1))
    sonars.reset()
    assert sonars.read(0.01, STANDING, Surroundings(0.2)) == pytest.approx((1.0, 1.0))
