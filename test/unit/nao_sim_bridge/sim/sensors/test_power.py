"""Motor heat and battery charge follow the currents."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.sensors.power import PowerSystem
from nao_sim_bridge.sim.settings import load_settings

SETTINGS = load_settings()
AMBIENT = SETTINGS.motor.ambient_c


@pytest.fixture
def power():
    return PowerSystem(2, SETTINGS)


def let_pass(power, seconds, currents, dt=0.1):
    for _ in range(round(seconds / dt)):
        power.advance(lambda: currents, dt)


def test_it_starts_cold_and_full(power):
    assert power.temperatures == (AMBIENT, AMBIENT)
    assert (power.charge, power.current) == (1.0, SETTINGS.battery.idle_current_a)


def test_a_motor_at_work_warms_up_and_an_idle_one_stays_cold(power):
    let_pass(power, 60.0, (1.0, 0.0))
    assert power.temperatures[0] > AMBIENT + 5.0
    assert power.temperatures[1] == pytest.approx(AMBIENT)


def test_twice_the_current_makes_four_times_the_heat(power):
    power.advance(lambda: (1.0, 2.0), 0.1)
    warm, hot = (temperature - AMBIENT for temperature in power.temperatures)
    assert hot == pytest.approx(4.0 * warm)


def test_heat_settles_where_cooling_equals_it(power):
    let_pass(power, 3000.0, (1.0, 0.0), dt=1.0)
    expected = AMBIENT + SETTINGS.motor.heating_k_per_a2_s / SETTINGS.motor.cooling_per_s
    assert power.temperatures[0] == pytest.approx(expected, rel=0.01)


def test_a_hot_motor_cools_down(power):
    let_pass(power, 60.0, (1.0, 0.0))
    hot = power.temperatures[0]
    let_pass(power, 60.0, (0.0, 0.0))
    assert AMBIENT < power.temperatures[0] < hot


def test_an_hour_of_a_current_takes_that_many_ampere_hours(power):
    let_pass(power, 3600.0, (0.5, 0.3), dt=1.0)
    drawn = SETTINGS.battery.idle_current_a + 0.8
    assert power.current == pytest.approx(drawn)
    assert power.charge == pytest.approx(1.0 - drawn / SETTINGS.battery.capacity_ah)


def test_an_empty_battery_stays_empty(power):
    let_pass(power, 36000.0, (5.0, 5.0), dt=10.0)
    assert power.charge == 0.0


def test_currents_are_asked_for_ten_times_a_second_whatever_the_tick(power):
    asked = []
    for _ in range(400):
        power.advance(lambda: asked.append(1) or (0.0, 0.0), 0.01)
    assert len(asked) == pytest.approx(40, abs=4)
