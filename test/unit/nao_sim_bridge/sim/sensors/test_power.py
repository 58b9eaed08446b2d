"""Motor heat, heat of the head and the load of the battery follow what the motors do."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.sensors.motors import Work
from nao_sim_bridge.sim.sensors.power import PowerSystem
from nao_sim_bridge.sim.settings import load_settings

SETTINGS = load_settings()
AMBIENT = SETTINGS.motor.ambient_c
CAPACITIES = (32.0, 16.0)
IDLE = Work((0.0, 0.0), 0.0, 0)


@pytest.fixture
def power():
    return PowerSystem(CAPACITIES, SETTINGS)


def let_pass(power, seconds, work, dt=0.1):
    for _ in range(round(seconds / dt)):
        power.advance(lambda: work, dt)


def test_it_starts_cold_and_full(power):
    assert power.temperatures == (AMBIENT, AMBIENT)
    assert (power.head, power.battery.reading.charge) == (AMBIENT, 1.0)


def test_a_motor_at_work_warms_up_and_an_idle_one_stays_cold(power):
    let_pass(power, 60.0, Work((4.0, 0.0), 4.0, 1))
    assert power.temperatures[0] > AMBIENT + 5.0
    assert power.temperatures[1] == pytest.approx(AMBIENT)


def test_a_small_motor_warms_up_faster(power):
    power.advance(lambda: Work((2.0, 2.0), 4.0, 2), 0.1)
    big, small = (temperature - AMBIENT for temperature in power.temperatures)
    assert small == pytest.approx(2.0 * big)


def test_heat_settles_where_cooling_equals_it(power):
    let_pass(power, 3000.0, Work((4.0, 0.0), 4.0, 1), dt=1.0)
    expected = AMBIENT + 4.0 / CAPACITIES[0] / SETTINGS.motor.cooling_per_s
    assert power.temperatures[0] == pytest.approx(expected, rel=0.01)


def test_a_hot_motor_cools_down(power):
    power.warm_up(0, 70.0)
    let_pass(power, 60.0, IDLE)
    assert AMBIENT < power.temperatures[0] < 70.0


def test_the_head_warms_up_to_where_it_stays(power):
    let_pass(power, 3600.0, IDLE, dt=1.0)
    assert power.head == pytest.approx(AMBIENT + SETTINGS.head.warmth_k, abs=0.5)
    power.head = 100.0
    let_pass(power, 600.0, IDLE, dt=1.0)
    assert power.head < 80.0


def test_the_battery_bears_computer_boards_and_motors(power):
    power.battery.put(0.5)

    def current(work):
        power.advance(lambda: work, 0.1)
        return power.battery.reading.current * power.battery.reading.voltage

    limp, stiff, busy = current(IDLE), current(Work((0.0, 0.0), 0.0, 26)), current(Work((9.0, 9.0), 30.0, 26))
    assert limp == pytest.approx(SETTINGS.battery.idle_w, rel=0.05)
    assert stiff - limp == pytest.approx(26 * SETTINGS.battery.driver_w, rel=0.05)
    assert busy - stiff == pytest.approx(30.0, rel=0.08)  # the voltage sags


def test_motors_are_asked_ten_times_a_second_whatever_the_tick(power):
    asked = []
    for _ in range(400):
        power.advance(lambda: asked.append(1) or IDLE, 0.01)
    assert len(asked) == pytest.approx(40, abs=4)
