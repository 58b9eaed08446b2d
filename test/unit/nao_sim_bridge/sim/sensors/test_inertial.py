"""The inertial unit feels what holds it up, how it is moved, and how it turns."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.readings import BodyReadings, Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.sensors.inertial import InertialUnit

DT = 0.01
UPRIGHT = Pose((0.0, 0.0, 0.3), (0.0, 0.0, 0.0, 1.0))
STILL = (0.0, 0.0, 0.0)


@pytest.fixture
def unit():
    return InertialUnit((0.1, 0.0, 0.0), 9.81)


def body(pose=UPRIGHT, velocity=STILL, turning=STILL):
    return BodyReadings(pose, velocity, turning)


def test_at_rest_it_feels_gravity_upwards_from_the_first_reading_on(unit):
    for _ in range(2):
        reading = unit.read(body(), DT)
        assert reading.accelerometer == pytest.approx((0.0, 0.0, 9.81))
        assert reading.gyroscope == reading.angles == STILL


@pytest.mark.parametrize(
    "angles, felt",
    [
        ((math.pi / 2, 0.0, 0.0), (0.0, 9.81, 0.0)),
        ((0.0, math.pi / 2, 0.0), (-9.81, 0.0, 0.0)),
        ((0.0, 0.0, 1.0), (0.0, 0.0, 9.81)),
        ((math.pi, 0.0, 0.0), (0.0, 0.0, -9.81)),
    ],
)
def test_leaning_turns_gravity_into_other_axes(unit, angles, felt):
    reading = unit.read(body(Pose(STILL, from_roll_pitch_yaw(*angles))), DT)
    assert reading.accelerometer == pytest.approx(felt, abs=1e-9)
    assert reading.angles == pytest.approx(angles, abs=1e-9)


def test_falling_freely_it_feels_nothing(unit):
    unit.read(body(velocity=(0.0, 0.0, -1.0)), DT)
    reading = unit.read(body(velocity=(0.0, 0.0, -1.0 - 9.81 * DT)), DT)
    assert reading.accelerometer == pytest.approx(STILL, abs=1e-9)


def test_speeding_up_forwards_is_felt_forwards(unit):
    unit.read(body(), DT)
    assert unit.read(body(velocity=(0.02, 0.0, 0.0)), DT).accelerometer == pytest.approx((2.0, 0.0, 9.81))


def test_it_feels_the_swing_of_its_own_place(unit):
    """10 cm in front of the centre, a turn to the left that begins moves it to the left."""
    unit.read(body(), DT)
    reading = unit.read(body(turning=(0.0, 0.0, 0.5)), DT)
    assert reading.accelerometer == pytest.approx((0.0, 0.1 * 0.5 / DT, 9.81))


def test_the_gyroscope_turns_with_the_body(unit):
    pose = Pose(STILL, from_roll_pitch_yaw(0.0, 0.0, math.pi / 2))
    assert unit.read(body(pose, turning=(1.0, 0.0, 2.0)), DT).gyroscope == pytest.approx((0.0, -1.0, 2.0))


def test_after_a_reset_the_old_velocity_is_forgotten(unit):
    unit.read(body(velocity=(3.0, 0.0, 0.0)), DT)
    unit.reset()
    assert unit.read(body(), DT).accelerometer == pytest.approx((0.0, 0.0, 9.81))
